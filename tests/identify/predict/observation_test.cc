// What a channel makes of a motion, in closed form.
#include "identify/predict/observation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace omnihil::test {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
const std::vector<double> kTime_s = {0.0, 0.1, 0.2, 0.4, 0.5};

TEST(Observation, ASensorHasOneNoiseInAllRunsUnlessItIsStated) {
  std::vector<RigRun> runs(4);
  const double sigmas[] = {1.0, 5.0, 2.0, 9.0};
  std::vector<RigRun*> all;
  for (std::size_t n = 0; n < runs.size(); ++n) {
    add_signal(runs[n], {}, "motor_current", "A", {}, {}, 0.0).noise_sigma = sigmas[n];
    all.push_back(&runs[n]);
  }
  runs[3].compared[0].noise_is_stated = true;
  share_noise(all);
  for (std::size_t n = 0; n < 3; ++n) {
    EXPECT_DOUBLE_EQ(runs[n].compared[0].noise_sigma, 2.0);
    EXPECT_DOUBLE_EQ(runs[n].compared[0].whitened_sigma, 2.0);
    EXPECT_DOUBLE_EQ(runs[n].seen[0].channel_sigma, 2.0);
  }
  EXPECT_DOUBLE_EQ(runs[3].compared[0].noise_sigma, 9.0);
}

// What a band keeps of a sensor's noise is the run's own.
TEST(Observation, ARunThatIsComparedInABandHasItsOwnNoise) {
  std::vector<RigRun> runs(3);
  std::vector<RigRun*> all;
  for (RigRun& run : runs) {
    add_signal(run, {}, "motor_torque", "N m", {}, {}, 0.0).noise_sigma =
        1.0 + static_cast<double>(all.size());
    all.push_back(&run);
  }
  runs[2].filter = butterworth(4, 10.0, 100.0);
  share_noise(all);
  EXPECT_DOUBLE_EQ(runs[2].compared[0].noise_sigma, 3.0);
  EXPECT_DOUBLE_EQ(runs[0].compared[0].noise_sigma, runs[1].compared[0].noise_sigma);
}

// v_k = (x_k - x_j) / (u (t_k - t_j)), j the last known sample; one that is missing costs itself alone.
TEST(Observation, ADifferenceSpansAMissingSampleButNoGap) {
  const double per_unit = 2.0;
  RigRun run;
  add_difference(run, {.view = View::kDifference, .per_unit = per_unit}, "velocity", "rad/s", kTime_s,
                 {1.0, kNaN, 3.0, 9.0, 7.0}, 0.15, 0.0, 0.0, 0.0);
  const std::vector<double>& v = run.compared[0].measured;
  EXPECT_TRUE(std::isnan(v[0]) && std::isnan(v[1]));
  EXPECT_NEAR(v[2], (3.0 - 1.0) / (per_unit * 0.2), 1e-12);
  EXPECT_TRUE(std::isnan(v[3])) << "0.2 s is a gap";
  EXPECT_NEAR(v[4], (7.0 - 9.0) / (per_unit * 0.1), 1e-12);
  const std::vector<double> x = {0.0, 5.0, 2.0, 4.0, 5.0};
  const std::vector<double> y = observed<double>(run.seen[0], kTime_s, [&](std::size_t k) { return x[k]; });
  EXPECT_NEAR(y[2], (2.0 - 0.0) / (per_unit * 0.2), 1e-12) << "the model over the same two samples";
  EXPECT_NEAR(y[4], (5.0 - 4.0) / (per_unit * 0.1), 1e-12);
}

// sigma_v = sqrt(2) sigma_x / dt, dt the median period.
TEST(Observation, ADifferencesNoiseIsThatOfItsTwoEnds) {
  RigRun run;
  add_difference(run, {.view = View::kDifference}, "velocity", "rad/s", kTime_s, {0, 1, 2, 3, 4}, 1.0, 0.02,
                 0.05, 0.0);
  const double dt_s = median_period_s(kTime_s);
  EXPECT_NEAR(run.compared[0].noise_sigma, std::sqrt(2.0) * 0.02 / dt_s, 1e-12);
  EXPECT_NEAR(run.compared[0].quantum, 0.05 / dt_s, 1e-12);
  EXPECT_DOUBLE_EQ(run.compared[0].whitened_sigma, run.compared[0].noise_sigma) << "white where asked so";
}

TEST(Observation, ALevelIsTheRunsOwn) {
  RigRun run;
  add_signal(run, {.view = View::kLevel}, "bus_voltage", "V", kTime_s, {99.0, 12.0, kNaN, 11.0, 13.0}, 0.1);
  EXPECT_TRUE(std::isnan(run.compared[0].measured[0])) << "a mean over a period that the run does not have";
  Prediction p{.values = {{5.0, 1.0, 2.0, 3.0, 5.0}},
               .derivatives = {Eigen::MatrixXd{{0.0}, {1.0}, {7.0}, {1.0}, {4.0}}}};
  complete(run, p);
  EXPECT_TRUE(p.finite);
  EXPECT_NEAR(p.values[0][3], 3.0 + (12.0 - 3.0), 1e-12) << "means over what was measured: 12 and 3";
  EXPECT_NEAR(p.derivatives[0](4, 0), 4.0 - 2.0, 1e-12);
}

TEST(Observation, WhatIsMeasuredAndNotPredictedIsADivergence) {
  RigRun run;
  add_signal(run, {}, "velocity", "rad/s", kTime_s, {0.0, kNaN, 1.0, 2.0, 3.0}, 0.1);
  Prediction between{.values = {{0.0, kNaN, 1.0, 2.0, 3.0}}, .derivatives = {}};
  complete(run, between);
  EXPECT_TRUE(between.finite);
  Prediction lost{.values = {{0.0, 0.0, 1.0, kNaN, 3.0}}, .derivatives = {}};
  complete(run, lost);
  EXPECT_FALSE(lost.finite);
}

// Of n readings with white noise the rms is sigma (1 +- 1 / sqrt(2 n)).
TEST(Observation, AReadingHasTheSensorsNoise) {
  RigRun run;
  std::vector<double> t, at_rest(20000, 0.0), values(20000, 3.0);
  for (std::size_t k = 0; k < values.size(); ++k) t.push_back(1e-3 * static_cast<double>(k));
  at_rest[7] = kNaN;
  add_signal(run, {}, "motor_current", "A", t, at_rest, 0.2);
  add_sensor_noise(run, 0, 1, 2, values);
  EXPECT_TRUE(std::isnan(values[7])) << "what was not measured is not read";
  double square = 0.0;
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (k != 7) square += std::pow(values[k] - 3.0, 2);
  }
  EXPECT_NEAR(std::sqrt(square / 19999.0), 0.2, 3.0 * 0.2 / std::sqrt(2.0 * 19999.0));
}

}  // namespace
}  // namespace omnihil::test
