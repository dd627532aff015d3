#include "identify/estimate/residual_spectrum.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "identify/estimate/evidence.h"
#include "sim/law/random.h"
#include "tests/identify/fake_residuals.h"

namespace omnihil {
namespace {

constexpr int kSamples = 20000;
constexpr double kPhi = 0.98;

// x' = phi x + e, e of unit variance: power 1 / |1 - phi exp(-i w)|^2.
Eigen::VectorXd first_order(std::uint64_t stream) {
  Eigen::VectorXd out(2 * kSamples);
  double x = 0.0;
  for (Eigen::Index i = 0; i < out.size(); ++i) {
    x = kPhi * x + gaussian(1, stream, static_cast<std::uint64_t>(i));
    out[i] = x;
  }
  return out;
}

double power_at(double cycles_per_sample) {
  const double w = 2.0 * std::numbers::pi * cycles_per_sample;
  return 1.0 / (1.0 - 2.0 * kPhi * std::cos(w) + kPhi * kPhi);
}

Eigen::VectorXd tone(double amplitude, double cycles_per_sample) {
  Eigen::VectorXd out(2 * kSamples);
  for (Eigen::Index i = 0; i < out.size(); ++i)
    out[i] = amplitude * std::sin(2.0 * std::numbers::pi * cycles_per_sample * static_cast<double>(i));
  return out;
}

// Two fit runs and two held-out ones, of one channel.
struct Runs : ZeroRuns {
  Runs() : ZeroRuns({Split::kTraining, Split::kValidation, Split::kTraining, Split::kValidation}, kSamples) {}
};

// What it was made of, and another record of the same process, have the mean square of white noise and no memory: the process'
// own is 99 samples.
TEST(ResidualSpectrumTest, WhitensTheProcessThatItWasMadeOf) {
  const Runs runs;
  const Eigen::VectorXd made_of = first_order(3), another = first_order(4);
  ASSERT_GT(autocorrelation_time(runs.training, made_of, 0), 50.0);
  const ResidualSpectrum spectrum(runs.training, made_of);
  const Eigen::VectorXd own = spectrum.flattened(runs.training, made_of),
                        other = spectrum.flattened(runs.validation, another);
  // 0.937: the mean over all frequencies of this process' power over that of the octaves' means, straight lines between their middles;
  // less than 1 since the highest octave's power is held above its middle. 3 sigma of a mean square of n: 3 sqrt(2 / n) = 2 %.
  EXPECT_NEAR(runs.training.mean_square(own)[0], 0.937, 0.02);
  EXPECT_NEAR(runs.validation.mean_square(other)[0], 0.937, 0.02);
  EXPECT_LT(autocorrelation_time(runs.training, own, 0), 1.3);
  EXPECT_LT(autocorrelation_time(runs.validation, other, 0), 1.3);
}

// A tone 20 dB below the process: 1 % of the plain energy, and of the innovations' A^2 / 2 over the power at its frequency.
TEST(ResidualSpectrumTest, ATonePassesByThePowerAtItsFrequency) {
  const Runs runs;
  const Eigen::VectorXd noise = first_order(5);
  const ResidualSpectrum spectrum(runs.training, noise);
  for (const double frequency : {0.02, 0.11, 0.37}) {
    const Eigen::VectorXd added = tone(0.7, frequency);
    const double by_law = 0.5 * 0.49 / power_at(frequency);
    EXPECT_LT(added.squaredNorm(), 0.015 * noise.squaredNorm());
    // the power changes by up to a quarter within half an octave, which a straight line follows
    EXPECT_NEAR(runs.training.mean_square(spectrum.flattened(runs.training, added))[0], by_law, 0.15 * by_law)
        << frequency;
  }
}

// A difference of residuals is flattened as the residuals are: gains add up.
TEST(ResidualSpectrumTest, IsLinear) {
  const Runs runs;
  const Eigen::VectorXd a = first_order(6), b = tone(2.0, 0.05);
  const ResidualSpectrum spectrum(runs.training, a);
  const Eigen::VectorXd apart =
      spectrum.flattened(runs.training, a) - 3.0 * spectrum.flattened(runs.training, b);
  EXPECT_LT((spectrum.flattened(runs.training, a - 3.0 * b) - apart).cwiseAbs().maxCoeff(), 1e-9);
}

// Offset and drift of a run are no innovation, and do not leak into other frequencies.
TEST(ResidualSpectrumTest, AStraightLineIsNone) {
  const Runs runs;
  const ResidualSpectrum spectrum(runs.training, first_order(7));
  Eigen::VectorXd line(2 * kSamples);
  for (int i = 0; i < kSamples; ++i) line[i] = line[kSamples + i] = 50.0 - 0.01 * i;
  EXPECT_LT(spectrum.flattened(runs.training, line).cwiseAbs().maxCoeff(), 1e-6);
}

TEST(ResidualSpectrumTest, ADivergedRunStaysEmpty) {
  const Runs runs;
  const ResidualSpectrum spectrum(runs.training, first_order(8));
  EXPECT_EQ(spectrum.flattened(runs.training, Eigen::VectorXd()).size(), 0);
}

}  // namespace
}  // namespace omnihil
