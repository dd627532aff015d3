// Speed from the time between Hall pulses: what it is by hand on a ramp, its limit, and the staircase of its signature.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/sim/effects/bench.h"

namespace omnihil::test {
namespace {

constexpr double kAngle_rad = 1.2566370614359172;  // one electrical turn of five pole pairs

AxisInput imposed(double duration_s, double (*speed)(double)) {
  AxisInput in = held(CommandKind::kMotorCurrent, 0.0, duration_s);
  for (const double t : in.time_s) in.imposed_velocity_rad_s.push_back(speed(t));
  return in;
}

// x' = (a t - x) a t / A: late by A / omega, so that x -> omega - a A / omega (exact: a t - sqrt(2 A a) D(t sqrt(a /
// 2 A)), D Dawson's function, whose tail is 1 / 2z).
TEST(HallSpeedPeriod, IsLateByItsAngleOnARamp) {
  const auto out = run_axis(small_drive(), with({use_of("hall_speed_period", {kAngle_rad, 0.0})}),
                            imposed(4.0, [](double t) { return 50.0 * t; }));
  EXPECT_NEAR(out.back().omega_rotor_rad_s - out.back().velocity_rad_s, kAngle_rad * 50.0 / 200.0, 2e-3);
}

TEST(HallSpeedPeriod, ShowsTheSpeedInTheLimitOfNoAngle) {
  const AxisInput in = excite(Excitation::kSteps, 0.6, 1.0);
  const auto out = run_axis(small_drive(), with({use_of("hall_speed_period", {1e-12, 0.0})}), in);
  for (const auto& s : out) EXPECT_NEAR(s.velocity_rad_s, s.omega_rotor_rad_s, 1e-4);
}

TEST(HallSpeedPeriod, KeepsItsLastSpeedAtStandstill) {
  const auto out = run_axis(small_drive(), with({use_of("hall_speed_period", {kAngle_rad, 0.0})}),
                            imposed(1.0, [](double t) { return t < 0.5 ? 100.0 : 0.0; }));
  EXPECT_NEAR(out.back().velocity_rad_s, 100.0, 0.1);
}

TEST(HallSpeedPeriod, ScalesWithTheClock) {
  const auto out = run_axis(small_drive(), with({use_of("hall_speed_period", {kAngle_rad, 0.025})}),
                            imposed(0.5, [](double) { return -80.0; }));
  EXPECT_NEAR(out.back().velocity_rad_s, -82.0, 1e-9);
}

TEST(HallSpeedPeriod, LeavesTheAngleAlone) {
  const AxisInput in = excite(Excitation::kSteps, 0.6, 1.0);
  const auto out = run_axis(small_drive(), with({use_of("hall_speed_period", {kAngle_rad, 0.02})}), in);
  for (const auto& s : out) EXPECT_EQ(s.position_rad, s.theta_rotor_rad);
}

// Signature: one change per angle turned, each the mean speed over the angle before it.
TEST(HallSpeedPeriod, ShowsAsAStaircaseOfOneStepPerAngle) {
  AxisInput in = imposed(4.0, [](double t) { return -10.0 - 10.0 * t; });
  in.noise_seed = 1;  // what the firmware gives, not its expected value
  const auto out = run_axis(small_drive(), with({use_of("hall_speed_period", {kAngle_rad, 0.0})}), in);
  const double turned_rad = 10.0 * 4.0 + 10.0 * 8.0;
  int changes = 0;
  for (std::size_t n = 200; n < out.size(); ++n) {
    if (out[n].velocity_rad_s == out[n - 1].velocity_rad_s) continue;
    ++changes;
    // mean speed over the last angle: half an angle old, and up to a sample of 1 ms at 10 rad/s2
    const double speed_then = -std::sqrt(std::pow(out[n].omega_rotor_rad_s, 2) -
                                         10.0 * kAngle_rad);  // v^2 = v0^2 - 2 a s, s = A / 2
    EXPECT_NEAR(out[n].velocity_rad_s, speed_then, 0.03);
  }
  EXPECT_NEAR(changes, turned_rad / kAngle_rad, 3.0);
}

}  // namespace
}  // namespace omnihil::test
