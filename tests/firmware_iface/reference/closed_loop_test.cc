// The whole firmware against motors: what a robot on the floor would show.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "tests/firmware_iface/reference/bench_robot.h"

namespace omnihil::test {
namespace {

struct Motion {
  const char* name;
  Body velocity;
};
constexpr Motion kMotions[] = {{"Forward", {1, 0, 0}},
                               {"Left", {0, 1, 0}},
                               {"Turn", {0, 0, 6}},
                               {"Diagonal", {-0.7, 0.7, 0}},
                               {"Arc", {0.8, 0.2, -2}}};

class StepResponse : public testing::TestWithParam<std::tuple<bool, int>> {
 protected:
  BenchRobotParams params() const { return std::get<0>(GetParam()) ? geared_robot() : direct_robot(); }
  Motion motion() const { return kMotions[std::get<1>(GetParam())]; }
};

// Speed of the wheel that turns fastest in this motion, as a share of its commanded speed, at each ms.
std::vector<double> response(const BenchRobotParams& params, const Body& velocity, int ms) {
  Bench bench(params);
  int fastest = 0;
  for (int w = 1; w < kWheels; ++w) {
    if (std::abs(wheel_speed(bench.config, w, velocity)) >
        std::abs(wheel_speed(bench.config, fastest, velocity))) {
      fastest = w;
    }
  }
  std::vector<double> shares;
  for (int n = 0; n < ms; ++n) {
    if (n % 20 == 0) bench.send_body(velocity[0], velocity[1], velocity[2]);
    bench.tick();
    shares.push_back(bench.robot.omega_wheel_rad_s(fastest) / wheel_speed(bench.config, fastest, velocity));
  }
  return shares;
}

TEST_P(StepResponse, RisesWithinFourHundredMillisecondsAndOvershootsLessThanTenPercent) {
  const std::vector<double> shares = response(params(), motion().velocity, 1500);
  const auto risen = std::find_if(shares.begin(), shares.end(), [](double share) { return share >= 0.9; });
  EXPECT_LE(risen - shares.begin(), 400);
  EXPECT_LE(*std::max_element(shares.begin(), shares.end()), 1.10);
}

TEST_P(StepResponse, SettlesWithinTwoPercentAndStaysThere) {
  const std::vector<double> shares = response(params(), motion().velocity, 2500);
  for (std::size_t ms = 1000; ms < shares.size(); ++ms) ASSERT_NEAR(shares[ms], 1.0, 0.02) << ms;
  double mean = 0;
  for (std::size_t ms = 2000; ms < 2500; ++ms) mean += shares[ms] / 500;
  EXPECT_NEAR(mean, 1.0, 0.002);
}

INSTANTIATE_TEST_SUITE_P(Robots, StepResponse, testing::Combine(testing::Bool(), testing::Range(0, 5)),
                         [](const auto& robot) {
                           return std::string(std::get<0>(robot.param) ? "Geared" : "Direct") +
                                  kMotions[std::get<1>(robot.param)].name;
                         });

class BothRobots : public testing::TestWithParam<bool> {
 protected:
  BenchRobotParams params() const { return GetParam() ? geared_robot() : direct_robot(); }
};
INSTANTIATE_TEST_SUITE_P(Robots, BothRobots, testing::Bool(),
                         [](const auto& robot) { return robot.param ? "Geared" : "Direct"; });

TEST_P(BothRobots, HeavierLighterOrStickierThanGuessedStillSettles) {
  for (const double factor : {0.7, 1.4}) {
    BenchRobotParams other = params();
    other.mass_kg *= factor;
    other.yaw_inertia_kg_m2 *= factor;
    other.coulomb_Nm *= 2;
    const std::vector<double> shares = response(other, {1, 0, 0}, 2500);
    EXPECT_LE(*std::max_element(shares.begin(), shares.end()), 1.10) << factor;
    for (std::size_t ms = 1500; ms < shares.size(); ++ms) ASSERT_NEAR(shares[ms], 1.0, 0.02) << factor;
  }
}

TEST_P(BothRobots, MotorConstantsOffByTwentyPercentStillSettle) {
  for (const double factor : {0.8, 1.2}) {
    BenchRobotParams real = params();
    BenchRobotParams believed = real;
    believed.config.motor_torque_constant_Nm_per_A *= factor;
    believed.config.motor_resistance_ohm /= factor;
    Bench bench(believed);
    bench.robot = BenchRobot(real);
    bench.run_with(body_command(1, 0, 0), 2500);
    EXPECT_NEAR(bench.robot.body[0], 1.0, 0.02) << factor;
  }
}

// In the air the motor sees a fortieth of the inertia it drives on the floor: no howling.
TEST_P(BothRobots, LiftedRobotDoesNotOscillate) {
  Bench bench(params());
  bench.robot.lifted = true;
  const RobotCommand command = body_command(1, 0, 0);
  bench.run_with(command, 1000);
  const double target = wheel_speed(bench.config, 0, {1, 0, 0});
  for (int n = 0; n < 500; ++n) {
    bench.run_with(command, 1);
    ASSERT_NEAR(bench.robot.omega_wheel_rad_s(0), target, 0.03 * std::abs(target)) << n;
  }
}

TEST_P(BothRobots, ReportedSpeedsAreTheTrueOnes) {
  Bench bench(params());
  bench.run_with(body_command(0.6, -0.4, 2), 1500);
  const RobotFeedback feedback = bench.firmware->feedback();
  EXPECT_NEAR(feedback.v_forward_m_s, bench.robot.body[0], 0.01);
  EXPECT_NEAR(feedback.v_left_m_s, bench.robot.body[1], 0.01);
  EXPECT_NEAR(feedback.omega_body_rad_s, bench.robot.body[2], 0.05);
  for (int w = 0; w < kWheels; ++w) {
    EXPECT_NEAR(feedback.omega_wheel_rad_s[w], bench.robot.omega_wheel_rad_s(w), 0.3);
    EXPECT_NEAR(feedback.omega_wheel_target_rad_s[w], wheel_speed(bench.config, w, {0.6, -0.4, 2}), 1e-3);
    EXPECT_EQ(feedback.duty_ratio[w], bench.drive.duty_ratio[w]);
  }
}

TEST_P(BothRobots, CommandBeyondTheMotorKeepsItsDirection) {
  Bench bench(params());
  bench.run_with(body_command(30, 15, 0), 6000);
  EXPECT_NEAR(bench.robot.body[1] / bench.robot.body[0], 0.5, 0.02);
  EXPECT_GT(bench.robot.body[0], 1.5);
  for (double duty : bench.drive.duty_ratio) EXPECT_LE(std::abs(duty), 1.0);
}

TEST_P(BothRobots, FastestOfAllNumbersIsNoHazard) {
  const double huge = std::numeric_limits<float>::max();
  for (const double value : {huge, -huge, 1e308, -1e308}) {
    Bench bench(params());
    bench.run_with(body_command(value, value / 3, value), 300);
    EXPECT_EQ(bench.firmware->faults().total(), 0u);
    for (double duty : bench.drive.duty_ratio) EXPECT_TRUE(std::isfinite(duty));
    EXPECT_TRUE(std::isfinite(bench.firmware->feedback().body_output[0]));
  }
}

// Held fast at full command, then let go: the integral must not have run away.
TEST_P(BothRobots, RecoversFromABlockedRobotWithoutSwingingOver) {
  Bench bench(params());
  bench.robot.blocked = true;
  bench.run_with(body_command(1, 0, 0), 3000);
  bench.robot.blocked = false;
  double fastest = 0;
  for (int n = 0; n < 1000; ++n) {
    bench.run_with(body_command(1, 0, 0), 1);
    fastest = std::max(fastest, bench.robot.body[0]);
  }
  const double no_load_m_s = 24.0 / bench.config.motor_torque_constant_Nm_per_A / bench.config.gear_ratio *
                             bench.config.wheel_radius_m;
  EXPECT_LT(fastest, 0.75 * no_load_m_s);
  bench.run_with(body_command(1, 0, 0), 1000);
  EXPECT_NEAR(bench.robot.body[0], 1.0, 0.02);
}

TEST_P(BothRobots, SaturatedWheelLeavesTheLimitAtOnce) {
  Bench bench(params());
  bench.robot.bus_V = 6.0;  // nearly flat battery: a quarter of the speed it was built for
  bench.run_with(body_command(8, 0, 0), 3000);
  const double top_m_s = bench.robot.body[0];
  bench.run_with(body_command(top_m_s / 2, 0, 0), 1500);
  EXPECT_NEAR(bench.robot.body[0], top_m_s / 2, 0.03 * top_m_s);
}

TEST_P(BothRobots, SaggingBatteryIsCompensated) {
  Bench bench(params());
  bench.run_with(body_command(1, 0, 0), 1500);
  const double duty_full = bench.drive.duty_ratio[0];
  bench.robot.bus_V = 18.0;
  bench.run_with(body_command(1, 0, 0), 5);
  EXPECT_NEAR(bench.robot.body[0], 1.0, 0.02);
  EXPECT_NEAR(bench.drive.duty_ratio[0] / duty_full, 24.0 / 18.0, 0.1);
}

TEST_P(BothRobots, StartsAtAnyEncoderCountAndAcrossTheWrap) {
  std::vector<double> speeds;
  for (const std::int64_t first : {std::int64_t{0}, std::numeric_limits<std::int64_t>::max() - 500,
                                   std::numeric_limits<std::int64_t>::min() + 500, std::int64_t{1} << 53}) {
    Bench bench(params());
    bench.robot.first_count = first;
    bench.run_with(body_command(-1, 0.5, 1), 700);
    speeds.push_back(bench.robot.body[0]);
  }
  for (double speed : speeds) EXPECT_EQ(speed, speeds.front());
}

TEST_P(BothRobots, SameInputsGiveTheSameBits) {
  Bench one(params()), two(params());
  const RobotCommand command = body_command(0.8, -0.3, 2);
  one.run_with(command, 1000);
  two.run_with(command, 1000);
  EXPECT_EQ(one.firmware->save(), two.firmware->save());
  EXPECT_EQ(one.robot.theta_rotor_rad, two.robot.theta_rotor_rad);
}

TEST_P(BothRobots, CopiedStateGoesOnAlike) {
  Bench bench(params());
  bench.run_with(body_command(0.8, -0.3, 2), 300);
  const std::unique_ptr<HostFirmware> copy = make_reference_firmware(params().config);
  ASSERT_TRUE(copy->restore(bench.firmware->save()));
  for (int n = 0; n < 100; ++n) {
    const RobotSensors sensors = bench.robot.sensors();
    const RobotDrive twin = copy->tick(sensors);
    bench.tick();
    for (int w = 0; w < kWheels; ++w) ASSERT_EQ(twin.duty_ratio[w], bench.drive.duty_ratio[w]);
  }
  EXPECT_EQ(copy->save(), bench.firmware->save());
}

// Six steps per electrical turn need a slow filter, so the loop is slow, too: but it gets there.
TEST_P(BothRobots, CoarseEncoderStillDrives) {
  BenchRobotParams hall = params();
  hall.config.encoder_counts_per_rotor_turn = 48;  // Hall sensors only
  Bench bench(hall);
  bench.run_with(body_command(1, 0, 0), 8000);
  double mean_m_s = 0;
  for (int n = 0; n < 1000; ++n) {
    bench.run_with(body_command(1, 0, 0), 1);
    mean_m_s += bench.robot.body[0] / 1000;
    ASSERT_NEAR(bench.robot.body[0], 1.0, 0.15);
  }
  EXPECT_NEAR(mean_m_s, 1.0, 0.02);
}

}  // namespace
}  // namespace omnihil::test
