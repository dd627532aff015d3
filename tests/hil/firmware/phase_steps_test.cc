// When a robot's windings see what a board's timer does, and the board's converter what the windings do.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>

#include "hil/firmware/image_firmware.h"
#include "hil/recording/session_setup.h"
#include "sim/robot/electric_model.h"
#include "tests/hil/one_robot.h"

namespace omnihil {
namespace {

constexpr char kBoard[] =
    "format = \"omnihil-board/1\"\nname = \"phase steps\"\nchip = \"stm32f405\"\n"
    "[[motor]]\nwheel = 0\npwm = [\"TIM1.1\", \"TIM1.2\", \"TIM1.3\"]\n"
    "[[analog]]\nadc = \"ADC1\"\nchannel = 0\nsignal = \"phase_current\"\nwheel = 0\nphase = 0\n"
    "volts_per_unit = 0.05\noffset_V = 1.65\n";
constexpr double kStep = 160.0 / 403.0, kPeriod_s = 2 * 403 / 16e6;  // as the image has them
constexpr std::size_t kBlock = 8, kPeriods = 2048;

struct PhaseSteps : testing::TestWithParam<DriveKind> {
  void SetUp() override {
    const std::string image = OMNIHIL_BUILD_DIR "/images/phase_steps.elf";
    if (!std::ifstream(image)) GTEST_SKIP() << "no arm-none-eabi-gcc: the image was not built";
    const std::string board_file = testing::TempDir() + "phase_steps.toml";
    std::ofstream(board_file) << kBoard;
    SessionSetup setup = test::one_robot("omni_foc");
    SessionConfig config = session_config(setup);
    set_electrics(config.robots[0], [](ElectricModel& e) {
      e.kind = GetParam();
      e.inverter.dead_time_s = e.inverter.switch_resistance_ohm = 0.0;
      e.current_sensor = {.bits = 0};
      e.battery.cells = 0;
    });
    motor_ = phase_motor(config.robots[0]);
    bus_V_ = config.robots[0].bus_voltage_V;
    mcu::McuBoard* board = nullptr;
    const mcu::ElfImage* elf = nullptr;
    Session session(config, image_firmware(image, board_file, {}, {.on_board = [&](const MadeBoard& made) {
                                             board = &made.mcu;
                                             elf = &made.image;
                                           }}));
    ASSERT_NE(board, nullptr);
    std::vector<std::uint8_t> out;
    while (session.now_ns() < 110'000'000) session.step({}, out);
    std::vector<std::uint8_t> raw(2 * kPeriods);
    ASSERT_TRUE(board->machine().peek(elf->address_of("samples").value(), raw));
    for (std::size_t n = 0; n < kPeriods; ++n)
      current_A_.push_back(((raw[2 * n] | raw[2 * n + 1] << 8) * 3.3 / 4096.0 - 1.65) / 0.05);
  }
  PhaseMotor<double> motor_;
  double bus_V_ = 0.0;
  std::vector<double> current_A_;  // at the begin of each of the timer's periods
};

// Phase 1 against the star point has 2/3 of its leg's step. Of V for a time T a winding's current becomes
// i e^(-T R/L) + V/R (1 - e^(-T R/L)), of a voltage that turns round t late 2 V/R (e^((t-T) R/L) - e^(-T R/L)) less. The rotor
// stands with its d axis at phase 1, which makes no torque.
TEST_P(PhaseSteps, AnUpdateOfTheTimerActsAtItsInstantAndIsSampledThere) {
  const double R = motor_.resistance_ohm, L = motor_.inductance_d_H, V = 2.0 / 3.0 * kStep * bus_V_;
  const auto left = [&](double t_s) { return std::exp(-t_s * R / L); };
  constexpr std::size_t kSeen = 4;  // periods, from the update on
  const double T = kSeen * kPeriod_s;
  std::vector<double> late_s;
  for (std::size_t block = 3; (block + 1) * kBlock < kPeriods; ++block) {
    const double volt_V = block % 2 == 1 ? V : -V;
    const double from_A = current_A_[block * kBlock], to_A = current_A_[block * kBlock + kSeen];
    const double missing_A = from_A * left(T) + volt_V / R * (1.0 - left(T)) - to_A;
    late_s.push_back(T + L / R * std::log(left(T) + missing_A * R / (2.0 * volt_V)));
  }
  std::sort(late_s.begin(), late_s.end());
  double mean_s = 0.0;
  for (const double t : late_s) mean_s += t / static_cast<double>(late_s.size());
  std::printf("late by %.2f us on the mean, %.2f to %.2f us; largest current %.2f A\n", 1e6 * mean_s,
              1e6 * late_s.front(), 1e6 * late_s.back(),
              *std::max_element(current_A_.begin(), current_A_.end()));
  constexpr double kCode_A = 3.3 / 4096.0 / 0.05;
  const double code_s =
      kCode_A * L / (2.0 * V * left(T));  // what a code of each of the two samples is in time
  EXPECT_NEAR(mean_s, 0.0, 2.0 * code_s);
}

INSTANTIATE_TEST_SUITE_P(Drives, PhaseSteps, testing::Values(DriveKind::kDq, DriveKind::kSwitched),
                         [](const auto& named) { return named.param == DriveKind::kDq ? "Dq" : "Switched"; });

}  // namespace
}  // namespace omnihil
