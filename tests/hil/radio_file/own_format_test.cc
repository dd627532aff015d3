// A team's own format, examples/radio/our_team.toml: bytes by hand, robots by the meaning of its fields.
#include <cmath>

#include "hil/radio_file/radio_file.h"
#include "protocols/meaning.h"
#include "tests/protocols/dongles/links_harness.h"

namespace omnihil {
namespace {

const RadioFormat& ours() {
  static const RadioFormat* format = [] {
    const RadioFile file = load_radio_file(OMNIHIL_SOURCE_DIR "/examples/radio/our_team.toml");
    for (const ModelProblem& problem : file.problems) ADD_FAILURE() << problem.text();
    return file.format;
  }();
  return *format;
}

TEST(OwnFormat, BytesAreThoseOfItsTable) {
  // forward 0.5 m/s in 2047 counts for 8: 127.9 -> 128 = 080h; right -8 -> -2047 = 801h; turn -1000 = FC18h.
  const Bytes bytes = encode(ours(), "MOVE",
                             {{"robot", 3},
                              {"counter", 7},
                              {"forward", 0.5},
                              {"right", -8.0},
                              {"turn", -1000},
                              {"chip", 1},
                              {"kick_speed", 100}});
  Bytes expected{0x55, 0x31, 7, 0x80, 0x10, 0x80, 0x18, 0xFC, 0x02, 100, 0};
  unsigned sum = 0;
  for (const std::uint8_t byte : expected) sum += byte;
  expected.push_back(static_cast<std::uint8_t>(sum));
  EXPECT_EQ(bytes, expected);
}

TEST(OwnFormat, ACommandReachesTheRobotInItsUnits) {
  Bench bench(ours(), {.robot_ids = {0, 3}});
  bench.write(bench.encode("MOVE", {{"robot", 3},
                                    {"forward", 1.0},
                                    {"right", 0.5},
                                    {"turn", 2500},
                                    {"kick", 1},
                                    {"kick_speed", 100},
                                    {"charge", 1},
                                    {"dribbler", 255}}));
  bench.run_to(1 * kMs);
  ASSERT_EQ(bench.sink.heard.size(), 1u);
  EXPECT_EQ(bench.sink.heard[0].robot, 3);
  EXPECT_EQ(bench.sink.heard[0].at_ns, 400 * kUs);
  const RobotCommand& command = bench.sink.heard[0].command;
  EXPECT_EQ(command.mode, unsigned{OMNIHIL_MODE_BODY_VELOCITY});
  EXPECT_EQ(command.flags, unsigned{OMNIHIL_COMMAND_CHARGE});
  EXPECT_NEAR(command.v_forward_m_s, 1.0, 0.002);
  EXPECT_NEAR(command.v_left_m_s, -0.5, 0.002);
  EXPECT_NEAR(command.omega_body_rad_s, 2.5, 1e-12);
  EXPECT_EQ(command.kick, unsigned{OMNIHIL_KICK_STRAIGHT});
  EXPECT_NEAR(command.v_kick_m_s, 5.0, 1e-12);
  EXPECT_NEAR(command.dribbler_ratio, 1.0, 1e-12);
}

TEST(OwnFormat, DutyGoesToTheWheels) {
  Bench bench(ours(), {.robot_ids = {3}});
  bench.write(bench.encode("DUTY", {{"robot", 3}, {"duty[2]", -250}}));
  bench.run_to(1 * kMs);
  ASSERT_EQ(bench.sink.heard.size(), 1u);
  EXPECT_EQ(bench.sink.heard[0].command.mode, unsigned{OMNIHIL_MODE_WHEEL_DUTY});
  EXPECT_NEAR(bench.sink.heard[0].command.duty_ratio[2], -0.25, 1e-12);
}

TEST(OwnFormat, TheRobotAnswersWithItsState) {
  Bench bench(ours(), {.robot_ids = {3}});
  bench.robots[3].battery_V = 15.24;
  bench.robots[3].yaw_rad = -1.2346;
  bench.robots[3].v_left_m_s = 0.75;
  bench.robots[3].flags = OMNIHIL_FEEDBACK_BALL_SEEN;
  bench.step();
  bench.write(bench.encode("MOVE", {{"robot", 3}, {"counter", 99}}));
  bench.run_to(2 * kMs);
  const auto answers = bench.answers("STATE");
  ASSERT_EQ(answers.size(), 1u);
  const Values& state = answers[0].values;
  EXPECT_EQ(state.number("robot"), 3.0);
  EXPECT_EQ(state.number("counter"), 99.0);
  EXPECT_EQ(state.number("battery"), 152.0);
  EXPECT_EQ(state.number("ball"), 1.0);
  EXPECT_EQ(state.number("yaw"), -1235.0);
  EXPECT_EQ(state.number("right"), -750.0);
}

TEST(OwnFormat, BytesThatBeginNoFrameAreSkippedAndAWrongSumIsCounted) {
  Bench bench(ours(), {.robot_ids = {3}});
  Bytes damaged = bench.encode("MOVE", {{"robot", 3}});
  damaged[6] ^= 1;
  bench.write(Bytes{1, 2, 3} + damaged + bench.encode("MOVE", {{"robot", 3}}));
  bench.run_to(2 * kMs);
  EXPECT_EQ(bench.refused(PacketError::kFraming), 1u);
  EXPECT_EQ(bench.refused(PacketError::kChecksum), 1u);
  EXPECT_EQ(bench.good(), 1u);
}

TEST(OwnFormat, AHostAsksForAVelocityByTheMeaningOfItsFields) {
  RobotCommand command{};
  command.mode = OMNIHIL_MODE_BODY_VELOCITY;
  command.v_forward_m_s = 0.5, command.v_left_m_s = -8.0, command.omega_body_rad_s = -1.0;
  Bytes bytes;
  ASSERT_TRUE(encode_drive(ours(), command, {.robot_id = 3}, bytes));
  EXPECT_EQ(bytes, encode(ours(), "MOVE",
                          {{"robot", 3}, {"forward", 0.5}, {"right", 8.0}, {"turn", -1000}, {"counter", 0}}));
  command.mode = OMNIHIL_MODE_WHEEL_SPEED;  // it has no packet for
  EXPECT_FALSE(encode_drive(ours(), command, {.robot_id = 3}, bytes));
}

TEST(OwnFormat, FoundByItsIdOnceInUseAndSaysNoCommandsOfItsOwn) {
  use_radio_format(ours());
  EXPECT_EQ(find_radio_format("our-team"), &ours());
  Bytes bytes;
  EXPECT_FALSE(ours().encode_command(RobotCommand{}, {}, bytes));
  EXPECT_EQ(ours().command_drives, 0u);
}

}  // namespace
}  // namespace omnihil
