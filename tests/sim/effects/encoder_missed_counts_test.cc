#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/sim/effects/bench.h"

namespace omnihil::test {
namespace {

constexpr double kCounts = 4096;

AxisInput turned(double speed_rad_s, double duration_s) {
  AxisInput in = held(CommandKind::kMotorCurrent, 0.0, duration_s);
  in.imposed_velocity_rad_s.assign(in.time_s.size(), speed_rad_s);
  in.encoder_counts_per_turn = kCounts;
  return in;
}

double counted_rad(const AxisSample<double>& s) {
  return s.encoder_counts * 2.0 * std::numbers::pi / kCounts;
}

// Expected: a thousandth of 20 rad.
TEST(EncoderMissedCounts, LosesItsShareOfTheWayInTheMean) {
  const auto effects = with({use_of("encoder_missed_counts", {0.001})});
  const auto out = run_axis(small_drive(), effects, turned(10.0, 2.0)).back();
  EXPECT_NEAR(out.theta_rotor_rad - counted_rad(out), 0.001 * 20.0, 1e-12);
  const auto back = run_axis(small_drive(), effects, turned(-10.0, 2.0)).back();
  EXPECT_NEAR(back.theta_rotor_rad - counted_rad(back), -0.001 * 20.0, 1e-12);
}

TEST(EncoderMissedCounts, VanishesInTheLimit) {
  const auto out =
      run_axis(small_drive(), with({use_of("encoder_missed_counts", {1e-12})}), turned(10.0, 1.0));
  for (const auto& s : out) EXPECT_NEAR(counted_rad(s), s.theta_rotor_rad, 1e-10);
}

// The number lost is Poisson: about p n counts, to four standard deviations.
TEST(EncoderMissedCounts, LosesAsManyAsItsProbabilitySays) {
  for (const double p : {0.001, 0.1}) {
    AxisInput in = turned(100.0, 4.0);
    in.noise_seed = 5;
    const auto out = run_axis(small_drive(), with({use_of("encoder_missed_counts", {p})}), in).back();
    const double passed = 400.0 * kCounts / (2.0 * std::numbers::pi);
    const double lost = (out.theta_rotor_rad - counted_rad(out)) * kCounts / (2.0 * std::numbers::pi);
    EXPECT_NEAR(lost, p * passed, 4.0 * std::sqrt(p * passed));
  }
}

// Signature: the angle falls behind in jumps of whole counts, never forward; the same for the same seed.
TEST(EncoderMissedCounts, ShowsAsJumpsOfWholeCountsThatNoTorqueMade) {
  AxisInput in = turned(10.0, 4.0);
  in.noise_seed = 7;
  const auto effects = with({use_of("encoder_missed_counts", {0.001})});
  const auto out = run_axis(small_drive(), effects, in);
  const auto again = run_axis(small_drive(), effects, in);
  int jumps = 0;
  for (std::size_t n = 1; n < out.size(); ++n) {
    EXPECT_EQ(counted_rad(out[n]), counted_rad(again[n]));
    const double lost = ((out[n].theta_rotor_rad - counted_rad(out[n])) -
                         (out[n - 1].theta_rotor_rad - counted_rad(out[n - 1]))) *
                        kCounts / (2.0 * std::numbers::pi);
    EXPECT_NEAR(lost, std::round(lost), 1e-6);
    EXPECT_GE(std::round(lost), 0.0);
    jumps += lost > 0.5 ? 1 : 0;
    EXPECT_NEAR(out[n].motor_current_A, 0.0, 1e-12);
  }
  EXPECT_GT(jumps, 10);
  EXPECT_LT(jumps, 60);
}

}  // namespace
}  // namespace omnihil::test
