// An RP2040 with four wheels: encoders on pins, counted by interrupts and by PIO, PWM slices, PI loops; and an image of the
// Raspberry Pi Pico's own SDK.
#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include "firmware_iface/mcu/board/board.h"
#include "firmware_iface/mcu/board/board_names.h"
#include "firmware_iface/mcu/board/mcu_firmware.h"
#include "firmware_iface/mcu/stm32/serial_port.h"
#include "tests/firmware_iface/mcu/image_bench.h"

namespace omnihil::mcu {
namespace {
constexpr double kBus_V = 24.0;

// Four motors without electric time constant: J omega' = k (V - k omega) / R.
struct Wheels {
  static constexpr double kConstant_Nm_per_A = 0.03, kResistance_ohm = 0.8, kInertia_kg_m2 = 3e-5;
  explicit Wheels(const std::vector<std::uint8_t>& file) {
    std::ifstream board_file(OMNIHIL_SOURCE_DIR "/boards/four_wheels_rp2040.toml");
    const std::string text((std::istreambuf_iterator<char>(board_file)), {});
    std::vector<BoardProblem> problems;
    const auto spec = read_board(text, "four_wheels_rp2040.toml", problems);
    for (const BoardProblem& p : problems) ADD_FAILURE() << p.text();
    std::vector<std::string> wrong;
    const bool read = read_elf(file, image, wrong);
    EXPECT_TRUE(read);
    if (!spec || !read) return;
    board = std::make_unique<McuBoard>(*spec, image);
    world.bus_voltage_V = kBus_V;
    board->chip().find<SerialPort>("UART0")->on_transmit(
        [this](std::uint8_t byte, Cycles) { said += static_cast<char>(byte); });
  }
  void run_ms(int ms) {
    constexpr std::int64_t kStep_ns = 500'000;
    constexpr double kStep_s = 0.5e-3;
    for (int i = 0; i < 2 * ms; ++i) {
      board->set_world(world);
      for (int w = 0; w < kWheels; ++w) board->wire(w)->begin(world.at_ns);
      board->run_until_ns(world.at_ns + kStep_ns);
      for (int w = 0; w < kWheels; ++w) {
        const BridgeDrive drive = board->wire(w)->end(world.at_ns + kStep_ns);
        double& omega = world.omega_rotor_rad_s[static_cast<std::size_t>(w)];
        world.theta_rotor_rad[static_cast<std::size_t>(w)] += omega * kStep_s;
        const double volts = drive.driven ? drive.duty_ratio * kBus_V : kConstant_Nm_per_A * omega;
        const double torque_Nm = kConstant_Nm_per_A * (volts - kConstant_Nm_per_A * omega) / kResistance_ohm;
        omega += torque_Nm / kInertia_kg_m2 * kStep_s;
      }
      world.at_ns += kStep_ns;
    }
  }
  ElfImage image;
  std::unique_ptr<McuBoard> board;
  WorldState world;
  std::string said;
};

TEST(Rp2040Board, WheelsReachTheirSpeedsWithinOnePercentAndNothingIsUnmodelled) {
  OMNIHIL_NEED_IMAGES();
  Wheels wheels(image_bytes("wheels_rp2040"));
  ASSERT_NE(wheels.board, nullptr);
  wheels.run_ms(1000);
  for (const double omega : wheels.world.omega_rotor_rad_s) EXPECT_NEAR(omega, 60.0, 0.6);
  for (const std::string& line : board_report(*wheels.board, wheels.image)) EXPECT_EQ(line, "");
}

TEST(Rp2040Board, ChannelsHaveLettersWhereTheChipNamesThemSo) {
  const BoardNames pico(*find_chip("rp2040")), stm32(*find_chip("stm32f405"));
  const auto has = [](const BoardNames& names, const char* word) {
    const auto channel = parse_channel(word);
    return channel && names.has_channel(*channel);
  };
  EXPECT_TRUE(has(pico, "PWM3.B"));
  EXPECT_FALSE(has(pico, "PWM3.1") || has(pico, "PWM8.A") || has(pico, "PWM3.AN") || has(pico, "PWM3.C"));
  EXPECT_TRUE(has(stm32, "TIM1.2") && has(stm32, "TIM1.2N"));
  EXPECT_FALSE(has(stm32, "TIM1.A"));
  EXPECT_EQ(pico.example_channels().substr(0, 31), "channels such as PWM0.A of PWM0");
  EXPECT_EQ(stm32.example_channels().substr(0, 31), "channels such as TIM1.1 of TIM1");
}

TEST(Rp2040Board, EncodersOnPinsAreCountedEdgeByEdge) {
  OMNIHIL_NEED_IMAGES();
  Wheels wheels(image_bytes("wheels_rp2040"));
  ASSERT_NE(wheels.board, nullptr);
  wheels.run_ms(500);
  const std::uint32_t at = *wheels.image.address_of("counts");
  for (int w = 0; w < kWheels; ++w) {
    const auto counted = static_cast<std::int32_t>(
        wheels.board->machine().bus_read(at + 4 * static_cast<std::uint32_t>(w), 4));
    EXPECT_NEAR(counted, static_cast<double>(wheels.world.encoder_counts(w, wheels.world.at_ns)), 3.0) << w;
  }
}

// docs/mcu-third-party.md says how it is built.
TEST(Rp2040Board, AnImageOfThePicoSdkBootsAndDrivesTheWheelsAsItsConsoleIsTold) {
  const char* folder = std::getenv("OMNIHIL_IMAGES");
  const std::vector<std::uint8_t> file =
      folder != nullptr ? file_bytes(std::string(folder) + "/pico-wheels.elf") : std::vector<std::uint8_t>{};
  if (file.empty()) GTEST_SKIP() << "no pico-wheels.elf in OMNIHIL_IMAGES";
  Wheels wheels(file);
  ASSERT_NE(wheels.board, nullptr);
  wheels.run_ms(20);
  EXPECT_EQ(wheels.said.substr(0, wheels.said.find(',')), "wheels on clk_sys 125000000 Hz");
  const std::string command = "S 40 -60 80 100\n";
  wheels.board->chip().find<SerialPort>("UART0")->feed(
      {reinterpret_cast<const std::uint8_t*>(command.data()), command.size()}, wheels.board->now_ns());
  wheels.run_ms(1500);
  const double wanted[] = {40, -60, 80, 100};
  for (std::size_t w = 0; w < kWheels; ++w)
    EXPECT_NEAR(wheels.world.omega_rotor_rad_s[w], wanted[w], 0.01 * std::abs(wanted[w])) << w;
  EXPECT_NE(wheels.said.find("1500 periods"), std::string::npos) << wheels.said;
  EXPECT_NE(wheels.said.find("24.0"), std::string::npos)
      << "its converter shows the battery: " << wheels.said;
  const std::vector<std::string> report = board_report(*wheels.board, wheels.image);
  ASSERT_EQ(report.size(), 1u);
  EXPECT_NE(report[0].find("not modelled: USB: used"), std::string::npos) << report[0];
}

}  // namespace
}  // namespace omnihil::mcu
