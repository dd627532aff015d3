// What happens when the host falls silent: the robot stops, stands, and lets go, at times that are stated.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/firmware_iface/reference/bench_robot.h"

namespace omnihil::test {
namespace {

bool timed_out(const Bench& bench) {
  return (bench.firmware->feedback().flags & OMNIHIL_FEEDBACK_COMMAND_TIMEOUT) != 0;
}

// 1 m/s at 3 to 4 m/s^2: 0.25 to 0.33 s of braking, then the wheels must be seen standing.
TEST(CommandTimeout, RobotStandsHalfASecondAfterTheTimeoutAndThenCoasts) {
  for (const double timeout_s : {0.0, 0.1, 0.5}) {
    BenchRobotParams params = geared_robot();
    params.config.command_timeout_s = timeout_s;
    const int timeout_ms = timeout_s == 0.0 ? 250 : static_cast<int>(timeout_s * 1000);
    Bench bench(params);
    for (int n = 0; n < 1000; ++n) {
      if (n % 20 == 0) bench.send_body(1, 0, 0);
      bench.tick();
    }
    bench.send_body(1, 0, 0);  // the last one
    bench.run(timeout_ms + 1);
    EXPECT_FALSE(timed_out(bench)) << timeout_s;
    EXPECT_NEAR(bench.robot.body[0], 1.0, 0.02) << timeout_s;
    bench.run(1);
    EXPECT_TRUE(timed_out(bench)) << timeout_s;
    bench.run(100);
    EXPECT_LT(bench.robot.body[0], 0.75) << timeout_s;  // braking, at 3 to 4 m/s^2
    EXPECT_GT(bench.robot.body[0], 0.55) << timeout_s;
    bench.run(400);
    EXPECT_TRUE(bench.coasting()) << timeout_s;
    EXPECT_NEAR(bench.robot.body[0], 0.0, 0.03) << timeout_s;
    EXPECT_NEAR(bench.firmware->feedback().command_age_ms, timeout_ms + 502, 2) << timeout_s;
  }
}

TEST(CommandTimeout, NothingMovesBeforeTheFirstCommand) {
  Bench bench(geared_robot());
  for (int n = 0; n < 500; ++n) {
    bench.tick();
    ASSERT_TRUE(bench.coasting());
  }
  EXPECT_TRUE(timed_out(bench));
  EXPECT_NEAR(bench.firmware->feedback().command_age_ms, 499, 1);
}

TEST(CommandTimeout, NextCommandDrivesAgain) {
  Bench bench(geared_robot());
  bench.run_with(body_command(1, 0, 0), 500);
  bench.run(1000);
  ASSERT_TRUE(bench.coasting());
  bench.run_with(body_command(0, 1, 0), 1000);
  EXPECT_FALSE(timed_out(bench));
  EXPECT_NEAR(bench.robot.body[1], 1.0, 0.02);
}

TEST(CommandTimeout, OpenLoopDriveIsBrakedToo) {
  Bench bench(geared_robot());
  RobotCommand command{};
  command.mode = OMNIHIL_MODE_WHEEL_DUTY;
  for (double& duty : command.duty_ratio) duty = 0.3;  // turns on the spot
  bench.run_with(command, 1000);
  ASSERT_GT(bench.robot.body[2], 5.0);
  bench.run(250 + 600);
  EXPECT_TRUE(bench.coasting());
  EXPECT_NEAR(bench.robot.body[2], 0.0, 0.3);
}

TEST(CommandTimeout, CoastingRobotIsNotGrabbed) {
  Bench bench(geared_robot());
  bench.run_with(body_command(1, 0, 0), 500);
  RobotCommand coast{};
  bench.send(coast);
  for (int n = 0; n < 1000; ++n) {
    bench.tick();
    ASSERT_TRUE(bench.coasting()) << n;
  }
}

TEST(CommandTimeout, StopsTryingAfterOneSecondWhenTheWheelsWillNotStop) {
  Bench bench(geared_robot());
  bench.run_with(body_command(1, 0, 0), 500);
  bench.robot.lifted = true;
  bench.send_body(1, 0, 0);
  bench.run(252);
  int driven_ms = 0;
  for (int n = 0; n < 2000; ++n) {
    bench.robot.omega_rotor_rad_s.fill(200.0);  // something keeps turning them
    bench.tick();
    driven_ms += bench.coasting() ? 0 : 1;
  }
  EXPECT_NEAR(driven_ms, 1000, 5);
  EXPECT_TRUE(bench.coasting());
}

TEST(CommandTimeout, DribblerStopsWithTheLink) {
  Bench bench(geared_robot());
  RobotCommand command = body_command(0, 0, 0);
  command.dribbler_ratio = 0.35;
  bench.run_with(command, 100);
  EXPECT_EQ(bench.drive.dribbler_ratio, 0.35);
  bench.run(300);
  EXPECT_EQ(bench.drive.dribbler_ratio, 0.0);
}

TEST(CommandTimeout, RefusedCommandDoesNotKeepTheLinkAlive) {
  Bench bench(geared_robot());
  bench.run_with(body_command(1, 0, 0), 500);
  RobotCommand bad = body_command(1, 0, 0);
  bad.v_left_m_s = std::nan("");
  bench.run_with(bad, 1000);
  EXPECT_TRUE(timed_out(bench));
  EXPECT_TRUE(bench.coasting());
}

}  // namespace
}  // namespace omnihil::test
