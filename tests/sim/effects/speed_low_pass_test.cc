#include <gtest/gtest.h>

#include <cmath>

#include "tests/sim/effects/bench.h"

namespace omnihil::test {
namespace {

AxisInput imposed(double start_rad_s, double rate_rad_s2, double duration_s) {
  AxisInput in = held(CommandKind::kMotorCurrent, 0.0, duration_s);
  for (const double t : in.time_s) in.imposed_velocity_rad_s.push_back(start_rad_s + rate_rad_s2 * t);
  return in;
}

TEST(SpeedLowPass, IsLateByItsTimeConstantOnARamp) {
  const auto out = run_axis(small_drive(), with({use_of("speed_low_pass", {0.02})}), imposed(0.0, 50.0, 1.0));
  EXPECT_NEAR(out.back().velocity_rad_s, 50.0 * (1.0 - 0.02), 1e-6);
}

TEST(SpeedLowPass, BeginsAtTheSpeedThatIsThereAndLeavesAngleAndMotionAlone) {
  const auto out = run_axis(small_drive(), with({use_of("speed_low_pass", {0.02})}), imposed(30.0, 0.0, 0.2));
  for (const auto& s : out) {
    EXPECT_NEAR(s.velocity_rad_s, 30.0, 1e-9);
    EXPECT_EQ(s.position_rad, s.theta_rotor_rad);
  }
}

// The same shaft, told by its own filter: y + tau dy/dt is the speed, whatever it does.
TEST(SpeedLowPass, IsUndoneByItsInverse) {
  const AxisInput in = excite(Excitation::kChirp, 0.5, 1.0);
  const double tau = 0.01;
  const auto out = run_axis(small_drive(), with({use_of("speed_low_pass", {tau})}), in);
  for (std::size_t n = 20; n + 1 < out.size(); ++n) {
    const double rate = (out[n + 1].velocity_rad_s - out[n - 1].velocity_rad_s) / 2e-3;
    EXPECT_NEAR(out[n].velocity_rad_s + tau * rate, out[n].omega_rotor_rad_s, 0.5);
  }
}

}  // namespace
}  // namespace omnihil::test
