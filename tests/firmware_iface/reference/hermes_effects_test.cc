// Every HERMES packet type's effect on the robot, by its bytes.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "tests/firmware_iface/reference/bench_robot.h"
#include "tests/firmware_iface/reference/hermes_frames.h"

namespace omnihil::test {
namespace {

constexpr std::uint8_t kRobot = 3;

BenchRobotParams numbered(std::uint8_t id) {
  BenchRobotParams params = geared_robot();
  params.config.robot_id = id;
  return params;
}

struct Radio : Bench {
  explicit Radio(std::uint8_t id = kRobot) : Bench(numbered(id)), robot_id(id) {}
  void receive(const Bytes& frame) { firmware->radio_receive(frame, now_ns()); }
  Bytes transmit() {
    Bytes out(64);
    out.resize(firmware->radio_transmit(out));
    return out;
  }
  void run_with_frame(const Bytes& frame, int count) {
    for (int n = 0; n < count; ++n) {
      if (n % 33 == 0) receive(frame);  // StrategyAI's rate
      tick();
    }
  }
  void set_register(std::uint8_t id, std::uint8_t value) {
    receive(to_robot(robot_id, kSetRegister, {id, value}));
  }
  Bytes advance_frame(float vx, std::uint8_t dribbler, std::uint8_t kick) const {
    return to_robot(robot_id, kSpeedMoveAdvance, floats({vx, 0, 0}) + Bytes{dribbler, kick});
  }
  std::uint8_t robot_id;
};

TEST(HermesEffects, SpeedMoveDrivesTheBody) {
  Radio radio;
  radio.run_with_frame(to_robot(kRobot, kSpeedMove, floats({0.8f, -0.5f, 2.0f})), 1500);
  EXPECT_NEAR(radio.robot.body[0], 0.8, 0.02);
  EXPECT_NEAR(radio.robot.body[1], -0.5, 0.02);
  EXPECT_NEAR(radio.robot.body[2], 2.0, 0.05);
}

TEST(HermesEffects, SpeedMoveAdvanceDrivesTheBodyAndSpinsTheDribbler) {
  Radio radio;
  const double duty_of_level[] = {0.0, 0.1, 0.2, 0.35};
  for (std::uint8_t level = 0; level < 4; ++level) {
    radio.run_with_frame(radio.advance_frame(1.0f, level, 0), 10);
    EXPECT_EQ(radio.drive.dribbler_ratio, duty_of_level[level]);
  }
  radio.run_with_frame(radio.advance_frame(1.0f, 0x7F, 0), 10);  // no such level: off
  EXPECT_EQ(radio.drive.dribbler_ratio, 0.0);
  radio.run_with_frame(radio.advance_frame(1.0f, 0, 0), 1500);
  EXPECT_NEAR(radio.robot.body[0], 1.0, 0.02);
}

TEST(HermesEffects, ChargeBitChargesAndLeavesTheDribblerOn) {
  Radio radio;
  radio.run_with_frame(radio.advance_frame(0, 3, 0), 10);
  EXPECT_EQ(radio.drive.charge, 0u);
  radio.run_with_frame(radio.advance_frame(0, 0x80 | 3, 0), 10);
  EXPECT_EQ(radio.drive.charge, 1u);
  EXPECT_EQ(radio.drive.dribbler_ratio, 0.35);
}

TEST(HermesEffects, KickWaitsForChargeAndBallThenFiresOnceWithItsPulse) {
  Radio radio;
  radio.receive(radio.advance_frame(0, 0, 18));  // 18 x 0.1 ms
  radio.robot.ball_seen = false;
  radio.run(1500);
  EXPECT_EQ(radio.drive.kick, static_cast<std::uint32_t>(OMNIHIL_KICK_NONE)) << "no ball";
  radio.robot.ball_seen = true;
  radio.tick();
  EXPECT_EQ(radio.drive.kick, static_cast<std::uint32_t>(OMNIHIL_KICK_STRAIGHT));
  EXPECT_NEAR(radio.drive.kick_pulse_s, 18e-4, 1e-9);
  EXPECT_EQ(radio.drive.charge, 0u) << "never charges into the coil";
  for (int n = 0; n < 3000; ++n) {
    radio.tick();
    ASSERT_EQ(radio.drive.kick, static_cast<std::uint32_t>(OMNIHIL_KICK_NONE)) << n;
  }
}

TEST(HermesEffects, KickBeforeTheCapacitorIsFullWaitsOneSecond) {
  Radio radio;
  radio.robot.ball_seen = true;
  radio.receive(radio.advance_frame(0, 0, 10));
  int fired_ms = -1;
  for (int n = 0; n < 1500 && fired_ms < 0; ++n) {
    radio.tick();
    if (radio.drive.kick != OMNIHIL_KICK_NONE) fired_ms = n;
  }
  EXPECT_NEAR(fired_ms, 1000, 2);
}

TEST(HermesEffects, KickIsForgottenAfterTenSeconds) {
  Radio radio;
  radio.receive(radio.advance_frame(0, 0, 10));
  radio.run(10'001);
  radio.robot.ball_seen = true;
  for (int n = 0; n < 100; ++n) {
    radio.tick();
    ASSERT_EQ(radio.drive.kick, static_cast<std::uint32_t>(OMNIHIL_KICK_NONE));
  }
}

TEST(HermesEffects, RegisterKickCountsMilliseconds) {
  Radio radio;
  radio.robot.ball_seen = true;
  radio.set_register(2, 1);  // charge
  radio.run(1100);
  radio.set_register(1, 4);
  radio.tick();
  EXPECT_EQ(radio.drive.kick, static_cast<std::uint32_t>(OMNIHIL_KICK_STRAIGHT));
  EXPECT_NEAR(radio.drive.kick_pulse_s, 4e-3, 1e-9);
}

TEST(HermesEffects, RegisterChargeFillsTheCapacitorInOneSecond) {
  Radio radio;
  const auto charged = [&] {
    return (radio.firmware->feedback().flags & OMNIHIL_FEEDBACK_CAPACITOR_CHARGED) != 0;
  };
  radio.set_register(2, 0);
  radio.run(990);
  EXPECT_EQ(radio.drive.charge, 1u);
  EXPECT_FALSE(charged());
  radio.run(20);
  EXPECT_TRUE(charged());
}

TEST(HermesEffects, RegisterDribblerActsUntilTheNextPacketSaysOtherwise) {
  Radio radio;
  radio.receive(to_robot(kRobot, kSpeedMove, floats({0, 0, 0})));
  radio.set_register(3, 2);
  radio.tick();
  EXPECT_EQ(radio.drive.dribbler_ratio, 0.2);
  radio.receive(to_robot(kRobot, kSpeedMove, floats({0, 0, 0})));  // carries no dribbler
  radio.tick();
  EXPECT_EQ(radio.drive.dribbler_ratio, 0.2);
  radio.receive(radio.advance_frame(0, 0, 0));
  radio.tick();
  EXPECT_EQ(radio.drive.dribbler_ratio, 0.0);
}

TEST(HermesEffects, OpenLoopActsOnlyAfterRegisterZeroOpensTheLoop) {
  Radio radio;
  const Bytes open = to_robot(kRobot, kOpenLoop, floats({0.1f, -0.2f, 0.3f, -0.4f}));
  radio.run_with_frame(open, 100);
  EXPECT_TRUE(radio.coasting());
  radio.set_register(0, 0);
  radio.run_with_frame(open, 10);
  const float expected[] = {0.1f, -0.2f, 0.3f, -0.4f};
  for (int w = 0; w < kWheels; ++w) {
    EXPECT_EQ(radio.drive.mode[w], static_cast<std::uint32_t>(OMNIHIL_DRIVE_DUTY));
    EXPECT_EQ(radio.drive.duty_ratio[w], static_cast<double>(expected[w]));
  }
}

TEST(HermesEffects, OpeningTheLoopBeforeAnyDutyCameLetsTheWheelsRunFree) {
  Radio radio;
  radio.run_with_frame(to_robot(kRobot, kSpeedMove, floats({1, 0, 0})), 200);
  radio.set_register(0, 0);
  radio.tick();
  EXPECT_TRUE(radio.coasting());
}

TEST(HermesEffects, SpeedPacketsDoNotMoveAnOpenLoopRobot) {
  Radio radio;
  radio.set_register(0, 0);
  radio.run_with_frame(to_robot(kRobot, kSpeedMove, floats({1, 0, 0})), 500);
  EXPECT_TRUE(radio.coasting());
  EXPECT_EQ(radio.robot.body[0], 0.0);
}

TEST(HermesEffects, ClosingTheLoopTakesUpAFreshPacketAndIgnoresAnOldOne) {
  for (const std::uint8_t closed : {std::uint8_t{1}, std::uint8_t{2}}) {
    Radio fresh;
    fresh.set_register(0, 0);
    fresh.receive(to_robot(kRobot, kSpeedMove, floats({1, 0, 0})));
    fresh.run(50);
    fresh.set_register(0, closed);
    fresh.run(50);
    EXPECT_FALSE(fresh.coasting());

    Radio old;
    old.set_register(0, 0);
    old.receive(to_robot(kRobot, kSpeedMove, floats({1, 0, 0})));
    old.run(400);  // longer than the timeout
    old.set_register(0, closed);
    old.run(400);
    EXPECT_TRUE(old.coasting());
    EXPECT_NEAR(old.robot.body[0], 0.0, 1e-3);
  }
}

TEST(HermesEffects, OpenLoopDutyBeyondOneIsRefusedWhole) {
  Radio radio;
  radio.set_register(0, 0);
  radio.run_with_frame(to_robot(kRobot, kOpenLoop, floats({0.1f, 0.1f, 0.1f, 0.1f})), 10);
  radio.receive(to_robot(kRobot, kOpenLoop, floats({0.5f, 0.5f, 0.5f, 1.0001f})));
  radio.tick();
  EXPECT_EQ(radio.drive.duty_ratio[0], static_cast<double>(0.1f));
}

TEST(HermesEffects, PingBatteryAndNumberAreAnsweredByteForByte) {
  Radio radio;
  radio.robot.bus_V = 23.47;
  radio.run(1000);
  radio.receive(to_robot(kRobot, kPing));
  radio.receive(to_robot(kRobot, kGetBattery));
  radio.receive(to_robot(kRobot, kGetNum));
  EXPECT_EQ(radio.transmit(), from_robot(kRobot, kPingResponse));
  EXPECT_EQ(radio.transmit(), from_robot(kRobot, kBatteryResponse, {234}));  // cut off, not rounded
  EXPECT_EQ(radio.transmit(), from_robot(kRobot, kNumResponse, {2, 0, 0, 0}));
  EXPECT_TRUE(radio.transmit().empty());
}

// As their communication task counts (RobotMCU 44cc54f, hermes_task.c), and the dongle's own robot.
TEST(HermesEffects, TheQuestionForTheCountIsNotCounted) {
  Radio radio;
  for (int n = 0; n < 3; ++n) radio.receive(to_robot(kRobot, kGetNum));
  for (int n = 0; n < 3; ++n) EXPECT_EQ(radio.transmit(), from_robot(kRobot, kNumResponse, {0, 0, 0, 0}));
}

TEST(HermesEffects, RobotZeroAnswersToo) {
  Radio radio(0);
  radio.receive(to_robot(0, kPing));
  EXPECT_EQ(radio.transmit(), from_robot(0, kPingResponse));
}

TEST(HermesEffects, BatteryAboveTheByteSaysTwentyFivePointFive) {
  Radio radio;
  radio.robot.bus_V = 30.0;
  radio.run(1000);
  radio.receive(to_robot(kRobot, kGetBattery));
  EXPECT_EQ(radio.transmit(), from_robot(kRobot, kBatteryResponse, {255}));
}

TEST(HermesEffects, AnswerWaitsForABufferThatHoldsIt) {
  Radio radio;
  radio.receive(to_robot(kRobot, kPing));
  Bytes small(6);
  EXPECT_EQ(radio.firmware->radio_transmit(small), 0u);
  EXPECT_EQ(radio.transmit(), from_robot(kRobot, kPingResponse));
}

TEST(HermesEffects, FifthUnreadAnswerIsDroppedAndTheFirstFourStay) {
  Radio radio;
  for (int n = 0; n < 5; ++n) {
    radio.receive(to_robot(kRobot, kSpeedMove, floats({0, 0, 0})));
    radio.receive(to_robot(kRobot, kGetNum));
  }
  for (std::uint8_t n = 1; n <= 4; ++n) {
    EXPECT_EQ(radio.transmit(), from_robot(kRobot, kNumResponse, {n, 0, 0, 0}));
  }
  EXPECT_TRUE(radio.transmit().empty());
}

TEST(HermesEffects, QuestionsDoNotKeepTheRobotMoving) {
  Radio radio;
  radio.run_with_frame(to_robot(kRobot, kSpeedMove, floats({1, 0, 0})), 500);
  radio.run_with_frame(to_robot(kRobot, kPing), 1000);
  EXPECT_TRUE(radio.coasting());
}

TEST(HermesEffects, PacketForAnotherRobotOrFromARobotIsNotActedOn) {
  Radio radio;
  const Bytes payload = floats({1, 0, 0});
  radio.run_with_frame(to_robot(kRobot + 1, kSpeedMove, payload), 200);
  radio.run_with_frame(stuffed(packet(0x07, kRobot, kSpeedMove, payload)), 200);
  radio.run_with_frame(from_robot(kRobot, kPingResponse), 200);
  EXPECT_TRUE(radio.coasting());
  EXPECT_TRUE(radio.transmit().empty());
}

TEST(HermesEffects, NotANumberIsNotActedOn) {
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    Radio radio;
    radio.run_with_frame(to_robot(kRobot, kSpeedMove, floats({1.0f, bad, 0.0f})), 300);
    EXPECT_TRUE(radio.coasting());
  }
}

}  // namespace
}  // namespace omnihil::test
