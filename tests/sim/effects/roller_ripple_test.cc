#include <gtest/gtest.h>

#include "tests/sim/effects/bench.h"
#include "tests/sim/effects/robot_bench.h"

namespace omnihil::test {
namespace {

TEST(RollerRipple, GivesItsShareOfTheLoadAQuarterPeriodAfterItsZero) {
  ContactPort<double> port;
  port.load_N = 6.0;
  EXPECT_EQ(called("roller_ripple", {0.05, 15, 0}, port).force_longitudinal_N, 0.0);
  port.theta_wheel_rad = std::numbers::pi / 30.0;
  EXPECT_NEAR(called("roller_ripple", {0.05, 15, 0}, port).force_longitudinal_N, 0.3, 1e-15);
}

TEST(RollerRipple, DoesNoWorkOverATurnAndNothingWithoutLoad) {
  double sum = 0.0;
  for (int n = 0; n < 360; ++n) {
    ContactPort<double> port;
    port.load_N = 6.0;
    port.theta_wheel_rad = n * std::numbers::pi / 180.0;
    sum += called("roller_ripple", {0.05, 15, 0.3}, port).force_longitudinal_N;
    port.load_N = 0.0;
    EXPECT_EQ(called("roller_ripple", {0.05, 15, 0.3}, port).force_longitudinal_N, 0.0);
  }
  EXPECT_NEAR(sum, 0.0, 1e-12);
}

// Amplitude of an order of the wheel in its speed, samples of angle and speed.
double line(const std::vector<double>& theta, const std::vector<double>& omega, int order) {
  double mean = 0.0, re = 0.0, im = 0.0;
  for (const double w : omega) mean += w / static_cast<double>(omega.size());
  for (std::size_t n = 0; n < theta.size(); ++n) {
    re += (omega[n] - mean) * std::cos(order * theta[n]);
    im += (omega[n] - mean) * std::sin(order * theta[n]);
  }
  return 2.0 * std::hypot(re, im) / static_cast<double>(theta.size());
}

// Signature: a line at the number of rollers in the speed of every wheel, driven slowly …
TEST(RollerRipple, ShowsAsALineAtTheRollersOrderInTheWheelSpeed) {
  const RobotModel m = symmetric_robot();
  Plant plant = floor_with(m, {"roller_ripple.fraction=0.06", "roller_ripple.order=15"});
  Plant without = floor_with(m, {});
  const RobotDrive turn = duty_drive({0.06, 0.06, 0.06, 0.06});
  drive_for(plant, turn, 1.0);
  drive_for(without, turn, 1.0);
  std::vector<double> theta, omega, plain_theta, plain_omega;
  for (int ms = 0; ms < 3000; ++ms) {
    drive_for(plant, turn, 1e-3);
    drive_for(without, turn, 1e-3);
    theta.push_back(plant.truth(0).theta_rotor_rad[1] / m.gear_ratio);
    omega.push_back(plant.truth(0).omega_wheel_rad_s[1]);
    plain_theta.push_back(without.truth(0).theta_rotor_rad[1] / m.gear_ratio);
    plain_omega.push_back(without.truth(0).omega_wheel_rad_s[1]);
  }
  EXPECT_GT(line(theta, omega, 15), 0.01);
  EXPECT_GT(line(theta, omega, 15), 20.0 * line(theta, omega, 11));
  EXPECT_LT(line(plain_theta, plain_omega, 15), 0.05 * line(theta, omega, 15));
}

// … that is gone when the wheel hangs free: a drive on the bench has no floor.
TEST(RollerRipple, VanishesWhenTheWheelIsLifted) {
  const AxisInput in = held(CommandKind::kDuty, 0.06, 1.0);
  const auto lifted = run_axis(small_drive(), with({use_of("roller_ripple", {0.06, 15, 0})}), in);
  const auto without = run_axis(small_drive(), nothing(), in);
  for (std::size_t n = 0; n < lifted.size(); ++n) {
    ASSERT_EQ(lifted[n].omega_rotor_rad_s, without[n].omega_rotor_rad_s);
  }
}

}  // namespace
}  // namespace omnihil::test
