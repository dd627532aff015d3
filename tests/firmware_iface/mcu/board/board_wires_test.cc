// From registers to what a bridge does, and from the shaft to Hall edges.
#include <gtest/gtest.h>

#include <cmath>

#include "firmware_iface/mcu/board/hall_lines.h"
#include "firmware_iface/mcu/board/motor_wire.h"
#include "tests/firmware_iface/mcu/chip_bench.h"

namespace omnihil::mcu {
namespace {

struct WireBench : ChipBench {
  WireBench() : ChipBench("stm32f405") {
    set("TIM1", 0x2C, 999);
    set("TIM1", 0x18, 0x6060);
    set("TIM1", 0x1C, 0x0060);
    set("TIM1", 0x44, 1u << 15);
    set("TIM1", 0x14, 1);
    set("TIM1", 0x00, 1);
  }
  std::int64_t now_ns() { return system.to_ns(system.now()); }
  std::unique_ptr<MotorWire> wire(MotorEntry entry) {
    return std::make_unique<MotorWire>(entry, chip, [this] { return now_ns(); });
  }
};

TEST(MotorWire, MeanDutyWeighsEachDutyByItsTime) {
  WireBench b;
  MotorEntry entry;
  entry.pwm = {{"TIM1", 0, false}};
  entry.direction = PinName{'E', 0};
  const auto wire = b.wire(entry);
  b.set("GPIOE", 0x00, 1);
  b.set("GPIOE", 0x18, 1);
  b.set("TIM1", 0x20, 1);
  b.set("TIM1", 0x34, 200);
  const std::int64_t start = b.now_ns();
  wire->begin(start);
  b.system.run_for(16 * 100);
  b.set("TIM1", 0x34, 800);
  b.system.run_for(16 * 50);
  b.set("GPIOE", 0x18, 1u << 16);
  b.system.run_for(16 * 50);
  const BridgeDrive mean = wire->end(b.now_ns());
  EXPECT_TRUE(mean.driven);
  EXPECT_NEAR(mean.duty_ratio, (100 * 0.2 + 50 * 0.8 - 50 * 0.8) / 200, 1e-9);
}

TEST(MotorWire, HalvesOfABridgeSubtractAndSwitchedOffOnesCoast) {
  WireBench b;
  MotorEntry entry;
  entry.pwm = {{"TIM1", 0, false}, {"TIM1", 1, false}};
  entry.sign = -1.0;
  const auto wire = b.wire(entry);
  EXPECT_FALSE(wire->now().driven);
  b.set("TIM1", 0x20, 0x11);
  b.set("TIM1", 0x34, 700);
  b.set("TIM1", 0x38, 300);
  EXPECT_TRUE(wire->now().driven);
  EXPECT_DOUBLE_EQ(wire->now().duty_ratio, -0.4);
  b.set("TIM1", 0x44, 0);
  EXPECT_FALSE(wire->now().driven);
}

const std::vector<ChannelName> kPhases = {{"TIM1", 0, false}, {"TIM1", 1, false}, {"TIM1", 2, false}};
const std::vector<ChannelName> kLowGates = {{"TIM1", 0, true}, {"TIM1", 1, true}, {"TIM1", 2, true}};
MotorEntry three_half_bridges() {
  MotorEntry entry;
  entry.pwm = kPhases;
  entry.pwm_low = kLowGates;
  return entry;
}

TEST(MotorWire, LegsFollowTheGatesOfBothSwitches) {
  WireBench b;
  const auto wire = b.wire(three_half_bridges());
  b.set("TIM1", 0x34, 250);
  b.set("TIM1", 0x38, 1000);
  b.set("TIM1", 0x20, 0x5 | 0x4 << 4);  // pair; lower switch alone; off
  b.set("TIM1", 0x18, 0x5060);          // channel 2 forced high: its lower switch alone follows the reference
  std::uint32_t leg[kLegs];
  double duty[kLegs];
  wire->legs(leg, duty);
  EXPECT_EQ(leg[0], static_cast<std::uint32_t>(OMNIHIL_LEG_PWM));
  EXPECT_DOUBLE_EQ(duty[0], 0.25);
  EXPECT_EQ(leg[1], static_cast<std::uint32_t>(OMNIHIL_LEG_LOW));
  EXPECT_DOUBLE_EQ(duty[1], 1.0);
  EXPECT_EQ(leg[2], static_cast<std::uint32_t>(OMNIHIL_LEG_OFF));
}

// 168 MHz: 1000 counts a period, of which the upper switch is on for the first 250.
TEST(MotorWire, ItsLowerSwitchConductsWhileItsOwnGateIsHigh) {
  WireBench b;
  const auto wire = b.wire(three_half_bridges());
  b.set("TIM1", 0x34, 250);
  b.set("TIM1", 0x38, 1000);
  b.set("TIM1", 0x20, 0x5 | 0x4 << 4);
  b.set("TIM1", 0x18, 0x5060);
  b.set("TIM1", 0x24, 0);
  EXPECT_EQ(wire->path(0), CurrentPath::kUpper);
  EXPECT_EQ(wire->path(1), CurrentPath::kLower) << "its lower gate is forced high";
  EXPECT_EQ(wire->path(2), CurrentPath::kDiodes) << "both gates are off";
  b.system.run_for(600);
  EXPECT_EQ(wire->path(0), CurrentPath::kLower);
  b.set("TIM1", 0x44, 0);
  EXPECT_EQ(wire->path(0), CurrentPath::kDiodes);
}

TEST(MotorWire, ADriverOfOneInputALegClosesTheOtherSwitch) {
  WireBench b;
  MotorEntry entry;
  entry.pwm = kPhases;
  entry.brake = PinName{'E', 1};
  entry.inverted = true;
  const auto wire = b.wire(entry);
  b.set("GPIOE", 0x00, 4);
  b.set("TIM1", 0x34, 250);
  b.set("TIM1", 0x20, 0x1);
  b.set("TIM1", 0x24, 0);
  EXPECT_EQ(wire->path(0), CurrentPath::kLower) << "braked";
  b.set("GPIOE", 0x18, 2);
  b.set("TIM1", 0x24, 0);
  EXPECT_EQ(wire->path(0), CurrentPath::kLower) << "its input is active low";
  EXPECT_EQ(wire->path(1), CurrentPath::kDiodes);
  b.system.run_for(600);
  EXPECT_EQ(wire->path(0), CurrentPath::kUpper);
}

TEST(MotorWire, TheBrakePinClosesTheLowerSwitchesWhateverTheTimerSays) {
  WireBench b;
  MotorEntry entry;
  entry.pwm = {{"TIM1", 0, false}};
  entry.direction = PinName{'E', 0};
  entry.brake = PinName{'E', 1};
  const auto wire = b.wire(entry);
  b.set("GPIOE", 0x00, 5);
  b.set("GPIOE", 0x18, 1);
  b.set("TIM1", 0x20, 1);
  b.set("TIM1", 0x34, 400);
  EXPECT_TRUE(wire->now().driven);
  EXPECT_EQ(wire->now().duty_ratio, 0.0) << "low: braked";
  wire->begin(b.now_ns());
  b.system.run_for(16 * 50);
  b.set("GPIOE", 0x18, 2);
  EXPECT_NEAR(wire->now().duty_ratio, 0.4, 1e-9);
  b.system.run_for(16 * 50);
  const BridgeDrive mean = wire->end(b.now_ns());
  EXPECT_TRUE(mean.driven);
  EXPECT_NEAR(mean.duty_ratio, 0.2, 1e-9) << "half of the time braked";
}

TEST(MotorWire, ABrakedPhaseIsLow) {
  WireBench b;
  MotorEntry entry;
  entry.pwm = {{"TIM1", 0, false}, {"TIM1", 1, false}, {"TIM1", 2, false}};
  entry.brake = PinName{'E', 1};
  const auto wire = b.wire(entry);
  b.set("TIM1", 0x20, 0x111);
  std::uint32_t leg[kLegs];
  double duty[kLegs];
  wire->legs(leg, duty);
  for (int x = 0; x < kLegs; ++x) {
    EXPECT_EQ(leg[x], std::uint32_t{OMNIHIL_LEG_LOW});
    EXPECT_EQ(duty[x], 1.0);
  }
}

struct Gate final : Device {
  void reset() override {}
  bool gates_bridge() const override { return true; }
  bool drives_bridge() const override { return drives; }
  void set(bool level) {
    drives = level;
    bridge_changed();
  }
  bool drives = true;
};

TEST(MotorWire, AGateDriverThatIsOffLetsTheMotorCoast) {
  WireBench b;
  MotorEntry entry;
  entry.pwm = {{"TIM1", 0, false}};
  const auto wire = b.wire(entry);
  Gate gate;
  wire->gate_by(gate);
  b.set("TIM1", 0x20, 1);
  b.set("TIM1", 0x34, 900);
  wire->begin(b.now_ns());
  b.system.run_for(16 * 30);
  gate.set(false);
  EXPECT_FALSE(wire->now().driven);
  b.system.run_for(16 * 70);
  gate.set(true);
  b.system.run_for(16 * 10);
  const BridgeDrive mean = wire->end(b.now_ns());
  EXPECT_TRUE(mean.driven);
  EXPECT_NEAR(mean.duty_ratio, 0.8, 1e-9) << "of the time that it drove";
}

TEST(MotorWire, DeadTimeIsLeftToTheBridge) {
  WireBench b;
  const auto wire = b.wire(three_half_bridges());
  b.set("TIM1", 0x34, 250);
  b.set("TIM1", 0x20, 0x5);
  b.set("TIM1", 0x44, 1u << 15 | 20);  // 20 of 1000 ticks
  EXPECT_LT(b.chip.find<Timer>("TIM1")->output(0).main.high_ratio, 0.25);
  std::uint32_t leg[kLegs];
  double duty[kLegs];
  wire->legs(leg, duty);
  EXPECT_DOUBLE_EQ(duty[0], 0.25);
}

// Six-step's floating phase: the channel is enabled and forced low, its complement is off.
TEST(MotorWire, AForcedLowUpperGateFloatsWhereTheLowerHasItsOwnAndGroundsWhereTheDriverMakesIt) {
  WireBench b;
  MotorEntry entry;
  entry.pwm = kPhases;
  const auto driver = b.wire(entry);
  entry.pwm_low = kLowGates;
  const auto gates = b.wire(entry);
  b.set("TIM1", 0x20, 0x1);
  b.set("TIM1", 0x18, 0x6040);
  std::uint32_t leg[kLegs];
  double duty[kLegs];
  gates->legs(leg, duty);
  EXPECT_EQ(leg[0], static_cast<std::uint32_t>(OMNIHIL_LEG_OFF));
  driver->legs(leg, duty);
  EXPECT_EQ(leg[0], static_cast<std::uint32_t>(OMNIHIL_LEG_PWM));
  EXPECT_DOUBLE_EQ(duty[0], 0.0);
}

TEST(HallLines, InvertedSensorsShowTheComplement) {
  ChipBench b("stm32f405");
  WorldState world;
  MotorEntry entry;
  entry.hall_pins = {{'A', 0}, {'A', 1}, {'A', 2}};
  entry.hall_pole_pairs = 8;
  entry.hall_inverted = true;
  HallLines lines(entry, b.chip, b.system, [&]() -> const WorldState& { return world; });
  lines.world_changed();
  EXPECT_EQ(b.get("GPIOA", 0x10) & 7, HallLines::code(0.0) ^ 7u);
}

TEST(HallLines, EdgesComeAtTheirInstantsInTheForwardOrder) {
  ChipBench b("stm32f405");
  WorldState world;
  constexpr unsigned kPolePairs = 8;
  world.omega_rotor_rad_s[1] = 100.0;
  MotorEntry entry;
  entry.wheel = 1;
  entry.hall_pins = {{'A', 0}, {'A', 1}, {'A', 2}};
  entry.hall_pole_pairs = kPolePairs;
  HallLines lines(entry, b.chip, b.system, [&]() -> const WorldState& { return world; });
  b.system.attach(0x5FFF0000, 4, lines);
  lines.world_changed();
  const unsigned kForward[] = {3, 2, 6, 4, 5, 1};
  const double sector_ns = M_PI / 3 / (100.0 * kPolePairs) * 1e9;
  for (unsigned n = 0; n < 40; ++n) {
    const double edge_ns = (n + 0.5) * sector_ns;
    b.system.run_until(b.system.from_ns(static_cast<std::int64_t>(edge_ns) - 200));
    EXPECT_EQ(b.get("GPIOA", 0x10) & 7, kForward[n % 6]) << n;
    b.system.run_until(b.system.from_ns(static_cast<std::int64_t>(edge_ns) + 200));
    EXPECT_EQ(b.get("GPIOA", 0x10) & 7, kForward[(n + 1) % 6]) << n;
  }
}

}  // namespace
}  // namespace omnihil::mcu
