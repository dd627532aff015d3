// What a board's converters see of a bridge.
#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "firmware_iface/mcu/board/board.h"

namespace omnihil::mcu {
namespace {

// A board whose program stands still; registers are poked.
struct BridgeBoard {
  BridgeBoard() {
    std::vector<BoardProblem> problems;
    const auto spec = read_board(R"(format = "omnihil-board/1"
name = "n"
chip = "stm32f405"
[[motor]]
wheel = 0
pwm = ["TIM1.1", "TIM1.2", "TIM1.3"]
pwm_low = ["TIM1.1N", "TIM1.2N", "TIM1.3N"]
[[analog]]
adc = "ADC1"
channel = 10
signal = "shunt_current"
phase = 0
volts_per_unit = 0.1
offset_V = 1.65
[[analog]]
adc = "ADC1"
channel = 11
signal = "phase_voltage"
phase = 0
volts_per_unit = 0.1
)",
                                 "b.toml", problems);
    for (const BoardProblem& p : problems) ADD_FAILURE() << p.text();
    const std::vector<std::uint8_t> code = {0x00, 0x80, 0x00, 0x20, 0x09, 0x00, 0x00, 0x08, 0xFE, 0xE7};
    ElfImage image;
    image.segments.push_back({0x08000000, code});
    board = std::make_unique<McuBoard>(*spec, image);
    board->run_until_ns(1000);
    set(kTimer + 0x2C, 999);
    set(kTimer + 0x18, 0x6060);
    set(kTimer + 0x34, 500);  // the upper switch in the first half of a period
    set(kTimer + 0x44, 1u << 15);
    set(kTimer + 0x14, 1);
    set(kConverter + 0x08, 1);
  }
  void set(std::uint32_t address, std::uint32_t value) {
    std::uint8_t bytes[4];
    for (unsigned i = 0; i < 4; ++i) bytes[i] = static_cast<std::uint8_t>(value >> 8 * i);
    ASSERT_TRUE(board->machine().poke(address, bytes));
  }
  // What the shunt is said to carry with the counter, which stands, at `count`.
  double shunt_A(double phase_A, std::uint32_t count) {
    WorldState world;
    world.phase_current_A[0][0] = phase_A;
    set(kTimer + 0x24, count);
    return (converted_V(10, world) - 1.65) / 0.1;
  }
  // What phase 0 is said to be against the bus's minus.
  double phase_V(const WorldState& world) { return converted_V(11, world) / 0.1; }
  double converted_V(std::uint32_t channel, const WorldState& world) {
    board->set_world(world);
    set(kConverter + 0x34, channel);
    set(kConverter + 0x08, 1 | 1u << 30);
    board->run_until_ns(board->now_ns() + 20'000);
    std::uint8_t code[4] = {};
    board->machine().peek(kConverter + 0x4C, code);
    return (code[0] | code[1] << 8) * 3.3 / 4096.0;
  }
  static constexpr std::uint32_t kTimer = 0x40010000, kConverter = 0x40012000;
  std::unique_ptr<McuBoard> board;
};

TEST(BoardAnalog, AShuntCarriesThePhasesCurrentWhileTheLowerSwitchDoes) {
  constexpr double kCode_A = 3.3 / 4096.0 / 0.1;
  BridgeBoard b;
  b.set(b.kTimer + 0x20, 0x5);
  for (const double phase_A : {4.0, -6.0}) {
    EXPECT_NEAR(b.shunt_A(phase_A, 100), 0.0, kCode_A) << "the upper switch is on";
    EXPECT_NEAR(b.shunt_A(phase_A, 700), phase_A, kCode_A);
  }
}

TEST(BoardAnalog, OfABridgeThatIsOffTheLowerDiodeIsBeforeTheShunt) {
  constexpr double kCode_A = 3.3 / 4096.0 / 0.1;
  BridgeBoard b;
  EXPECT_NEAR(b.shunt_A(4.0, 700), 4.0, kCode_A);
  EXPECT_NEAR(b.shunt_A(-6.0, 700), 0.0, kCode_A);
}

TEST(BoardAnalog, APhaseIsItsDutysShareOfTheBusOrWhatTheWindingsMakeOfIt) {
  constexpr double kCode_V = 3.3 / 4096.0 / 0.1;
  BridgeBoard b;
  WorldState world;
  world.bus_voltage_V = 24.0;
  world.leg_V[0][0] = 7.5;
  EXPECT_NEAR(b.phase_V(world), 7.5, kCode_V) << "both switches are open";
  b.set(b.kTimer + 0x20, 0x5);
  b.set(b.kTimer, 1);
  EXPECT_NEAR(b.phase_V(world), 12.0, kCode_V);
}

}  // namespace
}  // namespace omnihil::mcu
