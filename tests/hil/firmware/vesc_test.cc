// A VESC, unmodified, told by its own packets over its serial port and its CAN: it measures the motor, takes its settings
// and turns it without a sensor.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "firmware_iface/mcu/stm32/can.h"
#include "tests/hil/firmware/esc_image.h"
#include "tests/hil/firmware/vesc_line.h"

namespace omnihil {
namespace {

using namespace vesc;

struct Vesc : EscImage {
  // Its own bridge is switched at 12.5 kHz, and at 5 kHz while it measures, where it takes off the voltage of 0.12 us of
  // dead time: the same voltage as of 48 ns at this frequency, which does not follow it.
  Vesc()
      : EscImage("vesc-410-f405.elf", "vesc_410_f405.toml",
                 {.pwm_frequency_Hz = 25e3,
                  .dead_time_s = 48e-9,
                  .switch_resistance_ohm = kSwitch_ohm,
                  .diode_forward_V = 0.8},
                 {.extra_inertia_kg_m2 = 1e-4}) {}
  void SetUp() override {
    EscImage::SetUp();
    if (!bench_) return;
    line_ = std::make_unique<VescLine>(*board_, [this] { bench_->period(); });
  }
  Bytes ask(const Bytes& payload, double patience_s = 1.0) { return line_->ask(payload, patience_s); }
  // In what it calls ERPM: electrical turns a minute.
  double erpm(double omega_rotor_rad_s) const {
    return omega_rotor_rad_s * windings_.pole_pairs * 60.0 / (2 * std::numbers::pi);
  }

  static constexpr double kSwitch_ohm = 0.002;
  std::unique_ptr<VescLine> line_;
};

// It stores the sum of its own flash the first time, and starts again.
TEST_F(Vesc, SaysWhoItIsAndNamesWhatIsNotModelled) {
  const Bytes said = ask({kVersion});
  ASSERT_GT(said.size(), 6u);
  EXPECT_EQ(std::string(reinterpret_cast<const char*>(&said[3])), "410");
  const Bytes values = ask({kValues});
  EXPECT_NEAR(get_big(values, 27, 2) / 10.0, 24.0, 0.1);
  std::string all;
  for (const std::string& line : report(*board_)) all += line + "\n";
  for (const char* bad : {"fault", "reset by IWDG", "locked"})
    EXPECT_EQ(all.find(bad), std::string::npos) << all;
  EXPECT_NE(all.find("reset by software"), std::string::npos) << all;
  EXPECT_EQ(board_->machine().report().resets.size(), 2u) << all;
}

TEST_F(Vesc, SlowMeasuresTheMotorAsItIs) {
  const Bytes resistance = ask({kMeasureResistance}, 5.0);
  const double measured_ohm = 1e-6 * get_big(resistance, 1), ohm = windings_.resistance_ohm + kSwitch_ohm;
  Bytes question{kMeasureFlux};  // at 5 A, up to 30 % duty by 5000 ERPM/s, with what it has measured
  for (const int value : {5000, 5'000'000, 300}) put_big(question, value);
  put_big(question, get_big(resistance, 1));
  put_big(question, static_cast<std::int32_t>(std::lround(windings_.inductance_q_H * 1e8)));
  const double measured_Wb = 1e-7 * get_big(ask(question, 20.0), 1);
  std::printf("measured %.4f ohm (%.4f), %.4f mWb (%.4f)\n", measured_ohm, ohm, 1e3 * measured_Wb,
              1e3 * windings_.flux_linkage_Wb);
  EXPECT_NEAR(measured_ohm, ohm, 0.02 * ohm);
  EXPECT_NEAR(measured_Wb, windings_.flux_linkage_Wb, 0.01 * windings_.flux_linkage_Wb);
}

// Without a sensor, by the settings that fit the motor.
TEST_F(Vesc, SlowTurnsTheMotorAtTheSpeedThatItsPacketsSay) {
  line_->set_motor(windings_.resistance_ohm, windings_.inductance_q_H, windings_.flux_linkage_Wb, 8.0F);

  const auto id = static_cast<unsigned>(ask({kValues}).at(58));
  auto* can = board_->chip().find<mcu::CanPort>("CAN1");
  for (const double asked_rad_s : {200.0, -100.0, 300.0}) {
    const auto told = static_cast<std::int32_t>(std::lround(erpm(asked_rad_s)));
    Bytes number;
    put_big(number, told);
    mcu::CanFrame frame;
    frame.id = kCanSpeed << 8u | id;
    frame.extended = true;
    frame.bytes = 4;
    std::copy(number.begin(), number.end(), frame.data.begin());
    number.insert(number.begin(), kSpeed);
    double from_rad = 0.0;
    for (int tenth = 0; tenth < 40; ++tenth) {
      if (tenth == 30) from_rad = motor().theta_rad();
      if (asked_rad_s == 300.0) {
        can->receive(frame);
      } else {
        line_->say(number);
      }
      wait(0.1);
    }
    const double reached_rad_s = motor().theta_rad() - from_rad;  // in the last second
    const double said_erpm = get_big(ask({kValues}), 23);
    std::printf("told %d ERPM by %s: reached %.0f, it says %.0f\n", told,
                asked_rad_s == 300.0 ? "CAN" : "UART", erpm(reached_rad_s), said_erpm);
    EXPECT_NEAR(erpm(reached_rad_s), told, 0.015 * std::abs(told));
    EXPECT_NEAR(said_erpm, told, 0.015 * std::abs(told));
  }
}

}  // namespace
}  // namespace omnihil
