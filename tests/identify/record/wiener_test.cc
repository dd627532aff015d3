// A record without the part of its spectrum that is noise: what it keeps, what it takes, and the coefficient that a fit
// on its slope gets.
#include "identify/record/wiener.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "identify/record/filter.h"
#include "sim/law/random.h"

namespace omnihil {
namespace {

constexpr double kPeriod_s = 1e-3;
constexpr std::size_t kSamples = 20000;

// A motion of three lines below 20 Hz, and its slope.
struct Motion {
  static constexpr double kHz[] = {0.7, 4.0, 17.0}, kSize[] = {30.0, 10.0, 0.5};
  static double value(double t) {
    double v = 0.0;
    for (int i = 0; i < 3; ++i) v += kSize[i] * std::sin(2.0 * std::numbers::pi * kHz[i] * t);
    return v;
  }
  static double slope(double t) {
    double a = 0.0;
    for (int i = 0; i < 3; ++i) {
      const double w = 2.0 * std::numbers::pi * kHz[i];
      a += kSize[i] * w * std::cos(w * t);
    }
    return a;
  }
};

std::vector<double> white(double sigma) {
  std::vector<double> x;
  for (std::size_t k = 0; k < kSamples; ++k) x.push_back(sigma * gaussian(5, 1, k));
  return x;
}

std::vector<double> motion_with(const std::vector<double>& noise) {
  std::vector<double> x = noise;
  for (std::size_t k = 0; k < kSamples; ++k) x[k] += Motion::value(kPeriod_s * static_cast<double>(k));
  return x;
}

std::vector<double> slope_of(const std::vector<double>& x) {
  std::vector<double> a = central_differences(x);
  for (double& v : a) v /= kPeriod_s;
  return a;
}

double mean_square(const std::vector<double>& x) {
  double sum = 0.0;
  for (const double v : x) sum += v * v / static_cast<double>(x.size());
  return sum;
}

// Of y = c a without noise in y: the least-squares c where `measured` stands for a.
double coefficient(const std::vector<double>& measured) {
  double xy = 0.0, xx = 0.0;
  for (std::size_t k = 1000; k + 1000 < kSamples; ++k) {
    xy += measured[k] * Motion::slope(kPeriod_s * static_cast<double>(k));
    xx += measured[k] * measured[k];
  }
  return xy / xx;
}

TEST(Wiener, KeepsAMotionWithoutNoise) {
  const std::vector<double> x = motion_with(std::vector<double>(kSamples, 0.0));
  const std::vector<double> y = wiener_smoothed(x, NoiseSpectrum::kWhite).value;
  for (std::size_t k = 600; k + 600 < kSamples; ++k) ASSERT_NEAR(y[k], x[k], 1e-3) << k;
}

TEST(Wiener, KeepsAConstantAndARamp) {
  std::vector<double> x = white(0.01);
  for (std::size_t k = 0; k < kSamples; ++k) x[k] += 5.0 + 1e-3 * static_cast<double>(k);
  const std::vector<double> y = wiener_smoothed(x, NoiseSpectrum::kWhite).value;
  for (std::size_t k = 0; k < kSamples; ++k)
    ASSERT_NEAR(y[k], 5.0 + 1e-3 * static_cast<double>(k), 0.04) << k;
}

TEST(Wiener, TakesMostOfWhiteNoise) {
  const std::vector<double> y = wiener_smoothed(white(1.0), NoiseSpectrum::kWhite).value;
  EXPECT_LT(mean_square(y), 0.01);
}

// The noise of the slope, sqrt(130 / 144) sigma / T by the four samples' weights, is as large as the slope
// itself: least squares give half the coefficient.
TEST(Wiener, TheCoefficientOfASlopeIsNotPulledLow) {
  double power = 0.0;
  for (int i = 0; i < 3; ++i)
    power += 0.5 * std::pow(Motion::kSize[i] * 2.0 * std::numbers::pi * Motion::kHz[i], 2);
  const double sigma = std::sqrt(144.0 / 130.0 * power) * kPeriod_s;
  const std::vector<double> measured = motion_with(white(sigma));
  EXPECT_NEAR(coefficient(slope_of(measured)), 0.5, 0.02);
  EXPECT_NEAR(coefficient(slope_of(wiener_smoothed(measured, NoiseSpectrum::kWhite).value)), 1.0, 0.01);
}

// The same from a position, whose differences have noise that grows with the frequency.
TEST(Wiener, TheCoefficientFromAPositionIsNotPulledLow) {
  std::vector<double> position = white(1e-3);  // a good encoder
  for (std::size_t k = 0; k < kSamples; ++k) {
    const double t = kPeriod_s * static_cast<double>(k);
    for (int i = 0; i < 3; ++i) {
      const double w = 2.0 * std::numbers::pi * Motion::kHz[i];
      position[k] -= Motion::kSize[i] / w * std::cos(w * t);
    }
  }
  const std::vector<double> speed = slope_of(position);
  EXPECT_LT(coefficient(slope_of(speed)), 0.6);
  EXPECT_NEAR(coefficient(slope_of(wiener_smoothed(speed, NoiseSpectrum::kDifferenced).value)), 1.0, 0.02);
}

double mean(const std::vector<double>& x) {
  double sum = 0.0;
  for (const double v : x) sum += v / static_cast<double>(x.size());
  return sum;
}

// What is said of the smoothed record's error is what it is off by the motion.
TEST(Wiener, TheErrorThatIsSaidIsTheErrorThatIsLeft) {
  const std::vector<double> truth = motion_with(std::vector<double>(kSamples, 0.0));
  for (const double sigma : {0.05, 0.5, 5.0}) {
    const std::vector<double> measured = motion_with(white(sigma));
    std::vector<double> off = wiener_smoothed(measured, NoiseSpectrum::kWhite).value;
    for (std::size_t k = 0; k < kSamples; ++k) off[k] -= truth[k];
    const double left = mean_square({off.begin() + 1000, off.end() - 1000});
    const double said = mean(wiener_smoothed(measured, NoiseSpectrum::kWhite).error_spectrum);
    EXPECT_NEAR(std::sqrt(said / left), 1.0, 0.3) << sigma;
  }
}

// Motion of 40 Hz and less under a noise that hides it above: where half of the spectrum is noise it is said to end.
TEST(Wiener, TheMotionIsResolvedAsFarAsItStandsOutOfTheNoise) {
  const double half_Hz = 0.5 / kPeriod_s;
  const std::vector<double> slow = zero_phase(butterworth(4, 40.0, 1.0 / kPeriod_s), white(1.0));
  std::vector<double> measured = slow;
  for (std::size_t k = 0; k < kSamples; ++k) measured[k] += 0.1 * gaussian(5, 2, k);
  EXPECT_NEAR(wiener_smoothed(measured, NoiseSpectrum::kWhite).resolved * half_Hz, 52.0, 8.0);
  EXPECT_LT(wiener_smoothed(white(1.0), NoiseSpectrum::kWhite).resolved * half_Hz, 2.0);
}

TEST(Wiener, AShortRecordStaysAsItIs) {
  EXPECT_TRUE(wiener_smoothed(std::vector<double>(20, 1.0), NoiseSpectrum::kWhite).error_spectrum.empty());
  const std::vector<double> x = {1.0, 3.0, 2.0};
  EXPECT_EQ(wiener_smoothed(x, NoiseSpectrum::kWhite).value, x);
}

}  // namespace
}  // namespace omnihil
