#include <gtest/gtest.h>

#include <cmath>

#include "sim/law/random.h"
#include "tests/sim/effects/bench.h"

namespace omnihil::test {
namespace {

// Errors of the measured angle while the bench turns the shaft evenly.
std::vector<double> errors(double speed_rad_s, double sigma_s, std::optional<std::uint64_t> seed) {
  AxisInput in = held(CommandKind::kMotorCurrent, 0.0, 4.0);
  in.imposed_velocity_rad_s.assign(in.time_s.size(), speed_rad_s);
  in.noise_seed = seed;
  std::vector<double> e;
  const auto out = run_axis(small_drive(), with({use_of("sample_jitter", {sigma_s})}), in);
  for (std::size_t n = 100; n < out.size(); ++n) e.push_back(out[n].position_rad - out[n].theta_rotor_rad);
  return e;
}

double rms(const std::vector<double>& e) {
  double sum = 0.0;
  for (const double x : e) sum += x * x;
  return std::sqrt(sum / static_cast<double>(e.size()));
}

TEST(SampleJitter, IsItsSigmaTimesANormalNumber) {
  const NoiseKey key{.seed = 3, .stream = 4, .sample = 5};
  TimingPort<double> port;
  port.noise = &key;
  const double sigma_s = 0.002;
  find_effect("sample_jitter")->simulate.timing(nullptr, &sigma_s, nullptr, port);
  EXPECT_EQ(port.age_s, 0.002 * gaussian(3, 4 + stream_of("sample_jitter"), 5));
}

TEST(SampleJitter, IsAbsentInTheMean) {
  for (const double e : errors(20.0, 0.0005, std::nullopt)) EXPECT_NEAR(e, 0.0, 1e-9);
}

TEST(SampleJitter, IsTheSameForTheSameSeedAndAnotherForAnother) {
  EXPECT_EQ(errors(20.0, 0.0005, 1), errors(20.0, 0.0005, 1));
  EXPECT_NE(errors(20.0, 0.0005, 1), errors(20.0, 0.0005, 2));
}

// Signature: noise of the angle of omega sigma, twice as much at twice the speed, of either sign, without
// memory. Bounds: four standard deviations of 3900 samples.
TEST(SampleJitter, ShowsAsNoiseInProportionToTheSpeed) {
  for (const double speed : {20.0, 40.0}) {
    const std::vector<double> e = errors(speed, 0.0005, 11);
    const double size = rms(e), n = static_cast<double>(e.size());
    EXPECT_NEAR(size, speed * 0.0005, 4.0 * size / std::sqrt(2.0 * n));
    double mean = 0.0, neighbour = 0.0;
    for (std::size_t k = 1; k < e.size(); ++k) {
      mean += e[k] / n;
      neighbour += e[k] * e[k - 1] / (n * size * size);
    }
    EXPECT_NEAR(mean, 0.0, 4.0 * size / std::sqrt(n));
    EXPECT_NEAR(neighbour, 0.0, 4.0 / std::sqrt(n));
  }
}

// A mean over the time between two readings: where the current does not change, it does not matter when it is
// read.
TEST(SampleJitter, LeavesASteadyCurrentAlone) {
  AxisInput in = held(CommandKind::kMotorCurrent, 1.5, 2.0);
  in.imposed_velocity_rad_s.assign(in.time_s.size(), 20.0);
  in.noise_seed = 3;
  const auto out = run_axis(small_drive(), with({use_of("sample_jitter", {2e-4})}), in);
  for (std::size_t n = 100; n < out.size(); ++n) EXPECT_NEAR(out[n].motor_current_A, 1.5, 1e-6) << n;
}

}  // namespace
}  // namespace omnihil::test
