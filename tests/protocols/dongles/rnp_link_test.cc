// SSL A-Team: a robot looks for a host, talks to it, and gives it up.
#include "tests/protocols/dongles/links_harness.h"

namespace omnihil {
namespace {

constexpr const char* kId = "ateam-rnp-stspin-2025";

struct Robot : Bench {
  explicit Robot(Team team = Team::kYellow) : Bench(kId, {.robot_ids = {7}, .team = team}) { boot_robots(); }
  void welcome() { write(encode("hello_response", {{"ipv4[0]", 127}, {"ipv4[3]", 1}, {"port", 5000}})); }
  void drive(double vx) { write(encode("control", {{"vel_x", vx}, {"kick_request", 1}})); }
  double last_speed() const { return sink.heard.back().command.v_forward_m_s; }
};

TEST(RnpLink, ARobotLooksForAHostEverySecond) {
  Robot robot(Team::kBlue);
  robot.run_to(3500 * kMs);
  const auto asked = robot.answers();
  ASSERT_EQ(asked.size(), 4u);  // at 0, 1, 2 and 3 s
  for (const DecodeResult& hello : asked) {
    EXPECT_EQ(hello.values.message->name, "hello_request");
    EXPECT_EQ(hello.values.number("robot_id"), 7.0);
    EXPECT_EQ(hello.values.number("color"), 1.0);
    EXPECT_EQ(hello.values.number("crc32"), 0.0) << "robots do not compute it";
  }
}

TEST(RnpLink, AControlBeforeTheHandshakeIsNotObeyed) {
  Robot robot;
  robot.drive(1.0);
  robot.run_to(10 * kMs);
  EXPECT_TRUE(robot.sink.heard.empty());
}

TEST(RnpLink, WithAHostItDrivesAndReportsAHundredTimesASecond) {
  Robot robot;
  robot.robots[7].battery_V = 23.5;
  robot.robots[7].flags = OMNIHIL_FEEDBACK_BALL_SEEN;
  robot.welcome();
  for (int tick = 0; tick < 100; ++tick) {
    robot.drive(1.25);
    robot.run_to(robot.now_ns + 10 * kMs);
  }
  EXPECT_EQ(robot.sink.heard.size(), 100u);
  EXPECT_EQ(robot.last_speed(), 1.25);
  EXPECT_EQ(robot.sink.heard.back().message, "control");
  const auto reports = robot.answers("telemetry");
  EXPECT_NEAR(static_cast<double>(reports.size()), 100.0, 1.0);
  for (std::size_t i = 0; i < reports.size(); ++i)
    EXPECT_EQ(reports[i].values.number("sequence"), static_cast<double>(i));
  EXPECT_EQ(reports.back().values.number("battery"), 23.5);
  EXPECT_TRUE(reports.back().values.flag("flags.breakbeam_ball_detected"));
  EXPECT_TRUE(robot.answers("hello_request").size() <= 1);
}

TEST(RnpLink, WheelsStopAfter200MsAndTheRobotStartsAnewAfterASecond) {
  Robot robot;
  robot.welcome();
  robot.drive(1.0);
  robot.run_to(190 * kMs);
  EXPECT_EQ(robot.sink.heard.size(), 1u);
  robot.run_to(210 * kMs);
  ASSERT_EQ(robot.sink.heard.size(), 2u);
  EXPECT_EQ(robot.last_speed(), 0.0);
  EXPECT_EQ(robot.sink.heard.back().command.mode, unsigned{OMNIHIL_MODE_BODY_VELOCITY});
  robot.run_to(990 * kMs);
  EXPECT_EQ(robot.sink.heard.size(), 2u);
  robot.to_host.clear();
  robot.run_to(1010 * kMs);
  ASSERT_EQ(robot.sink.heard.size(), 3u);
  EXPECT_EQ(robot.sink.heard.back().command.mode, unsigned{OMNIHIL_MODE_COAST});
  EXPECT_EQ(robot.answers("hello_request").size(), 1u);
}

TEST(RnpLink, KeepaliveHoldsTheConnectionButNotTheWheels) {
  Robot robot;
  robot.welcome();
  robot.drive(1.0);
  for (int i = 0; i < 30; ++i) {
    robot.write(robot.encode("empty", {{"command_code", 4}}));
    robot.run_to(robot.now_ns + 100 * kMs);
  }
  EXPECT_EQ(robot.sink.heard.size(), 2u);
  EXPECT_EQ(robot.last_speed(), 0.0);
}

TEST(RnpLink, AGoodbyeOrARefusalSendsItLookingAgain) {
  for (const double code : {2.0, 3.0}) {
    Robot robot;
    robot.welcome();
    robot.drive(1.0);
    robot.run_to(50 * kMs);
    robot.to_host.clear();
    robot.write(robot.encode("empty", {{"command_code", code}}));
    robot.run_to(60 * kMs);
    EXPECT_EQ(robot.sink.heard.back().command.mode, unsigned{OMNIHIL_MODE_COAST});
    EXPECT_EQ(robot.answers("hello_request").size(), 1u);
  }
}

TEST(RnpLink, ParametersAreReadAndWritten) {
  Robot robot;
  robot.gains.p[1] = 2.5, robot.gains.d[1] = 0.125;
  robot.welcome();
  robot.run_to(5 * kMs);
  robot.write(robot.encode("robot_parameter_command", {{"code", 0}, {"name", 1}}));
  robot.write(
      robot.encode("robot_parameter_command", {{"code", 1}, {"format", 3}, {"name", 1}, {"values[0]", 4.0}}));
  robot.write(robot.encode("robot_parameter_command", {{"code", 1}, {"format", 0}, {"name", 1}}));
  robot.write(robot.encode("robot_parameter_command", {{"code", 0}, {"name", 9}}));
  robot.run_to(20 * kMs);
  const auto answers = robot.answers("robot_parameter_command");
  ASSERT_EQ(answers.size(), 4u);
  EXPECT_EQ(answers[0].values.number("code"), 2.0);
  EXPECT_EQ(answers[0].values.number("values[0]"), 2.5);
  EXPECT_EQ(answers[0].values.number("values[2]"), 0.125);
  EXPECT_EQ(answers[1].values.number("code"), 2.0);
  EXPECT_EQ(answers[2].values.number("code"), 4.0) << "a controller is not one number";
  EXPECT_EQ(answers[3].values.number("code"), 3.0) << "nothing here has this name";
  ASSERT_EQ(robot.sink.heard.size(), 1u);
  EXPECT_EQ(robot.sink.heard[0].kind, Delivery::Kind::kGains);
  EXPECT_EQ(robot.sink.heard[0].gains.p[1], 4.0);
  EXPECT_EQ(robot.sink.heard[0].gains.d[1], 0.0) << "all three are written";
}

TEST(RnpLink, DamageIsCountedAndTheNextDatagramCounts) {
  Robot robot;
  robot.welcome();
  Bytes damaged = robot.encode("control", {{"vel_x", 3.0}});
  damaged[20] ^= 1;
  robot.write(damaged);
  robot.run_to(10 * kMs);
  robot.write({1, 2, 3});
  robot.run_to(20 * kMs);
  robot.drive(1.0);
  robot.write(robot.encode("telemetry", {}));
  robot.write(robot.encode("control", {}) + Bytes{});
  robot.run_to(30 * kMs);
  EXPECT_EQ(robot.refused(PacketError::kChecksum), 1u);
  EXPECT_EQ(robot.refused(PacketError::kTooShort), 1u);
  EXPECT_EQ(robot.refused(PacketError::kDirection), 1u);
  EXPECT_EQ(robot.good(), 3u);
}

TEST(RnpLink, ThePacketsOf2026HaveTheSameSession) {
  Bench robot("ateam-rnp-2026", {.robot_ids = {7}});
  robot.boot_robots();
  robot.robots[7].v_forward_m_s = 0.25;
  robot.run_to(1500 * kMs);
  EXPECT_EQ(robot.answers("hello_request").size(), 2u);  // at 0 and 1 s
  robot.write(robot.encode("hello_response", {}));
  robot.write(robot.encode("control_local_velocity", {{"command.xd", 1.5}, {"kick_request", 1}}));
  robot.to_host.clear();
  robot.run_to(1600 * kMs);
  ASSERT_EQ(robot.sink.heard.size(), 1u);
  EXPECT_EQ(robot.sink.heard[0].message, "control_local_velocity");
  EXPECT_EQ(robot.sink.heard[0].command.v_forward_m_s, 1.5);
  EXPECT_EQ(robot.sink.heard[0].command.flags, 0u);
  const auto reports = robot.answers("telemetry");
  ASSERT_GE(reports.size(), 9u);
  EXPECT_EQ(reports.back().values.number("body_mode"), 12.0) << "the latest control's";
  EXPECT_EQ(reports.back().values.number("velocity[0]"), 250.0);
  robot.write(robot.encode("control_global_position", {{"command.x", 3.0}}));
  robot.write(robot.encode("control_off", {}));
  robot.run_to(1620 * kMs);
  ASSERT_EQ(robot.sink.heard.size(), 3u);
  EXPECT_EQ(robot.sink.heard[1].command.mode, unsigned{OMNIHIL_MODE_BODY_VELOCITY});
  EXPECT_EQ(robot.sink.heard[1].command.v_forward_m_s, 0.0) << "nothing here knows where it is";
  EXPECT_EQ(robot.sink.heard[2].command.mode, unsigned{OMNIHIL_MODE_COAST});
}

TEST(RnpLink, AFirmwareThatDecodesHasTheSessionToItself) {
  Bench bench(kId, {.robot_ids = {7}, .firmware_decodes = true});
  bench.boot_robots();
  const Bytes control = bench.encode("control", {{"vel_x", 1.0}});
  bench.write(control);
  const Bytes hello = bench.encode("hello_request", {{"robot_id", 7}});
  bench.link->robot_frame(7, hello, bench.now_ns);
  bench.link->robot_frame(7, control, bench.now_ns);
  bench.run_to(2000 * kMs);
  ASSERT_EQ(bench.sink.heard.size(), 1u);
  EXPECT_EQ(bench.sink.heard[0].frame, control);
  EXPECT_EQ(bench.to_host, hello);
  EXPECT_EQ(bench.link->from_robots().bad[static_cast<std::size_t>(PacketError::kDirection)], 1u);
}

}  // namespace
}  // namespace omnihil
