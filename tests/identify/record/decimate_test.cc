#include "identify/record/decimate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>

namespace omnihil {
namespace {

constexpr double kPi = std::numbers::pi;

double gain_at(const LowPass& filter, double frequency_Hz, double rate_Hz) {
  const std::complex<double> z1 = std::exp(std::complex<double>(0.0, -2.0 * kPi * frequency_Hz / rate_Hz));
  std::complex<double> h = 1.0;
  for (const Biquad& s : filter.sections)
    h *= (s.b0 + s.b1 * z1 + s.b2 * z1 * z1) / (1.0 + s.a1 * z1 + s.a2 * z1 * z1);
  return std::abs(h);
}

// |H|^2 = 1 / (1 + eps^2 T_8^2(tan(pi f / fs) / tan(pi fe / fs)))
double chebyshev_gain(double ripple_dB, double ratio) {
  const double eps_square = std::pow(10.0, ripple_dB / 10.0) - 1.0;
  const double t8 = ratio <= 1.0 ? std::cos(8.0 * std::acos(ratio)) : std::cosh(8.0 * std::acosh(ratio));
  return 1.0 / std::sqrt(1.0 + eps_square * t8 * t8);
}

TEST(Chebyshev, FollowsItsClosedForm) {
  const LowPass filter = chebyshev(8, 0.05, 40.0, 1000.0);
  for (const double f : {0.0, 5.0, 17.0, 33.0, 40.0, 45.0, 60.0, 120.0, 400.0}) {
    const double ratio = std::tan(kPi * f / 1000.0) / std::tan(kPi * 40.0 / 1000.0);
    EXPECT_NEAR(gain_at(filter, f, 1000.0), chebyshev_gain(0.05, ratio), 1e-9) << f << " Hz";
  }
}

TEST(Decimate, KeepsWhatIsSlowAndDropsWhatWouldAlias) {
  std::vector<double> slow, fast;
  for (int i = 0; i < 4000; ++i) {
    slow.push_back(std::sin(2.0 * kPi * 3.0 * i * 1e-3));
    fast.push_back(std::sin(2.0 * kPi * 97.0 * i * 1e-3));  // would show at 3 Hz
  }
  const std::vector<double> kept = decimate(slow, 10), dropped = decimate(fast, 10);
  ASSERT_EQ(kept.size(), 400u);
  const double gain = chebyshev_gain(0.05, std::tan(kPi * 0.003) / std::tan(kPi * 0.04));
  for (std::size_t i = 100; i < 300; ++i) {
    EXPECT_NEAR(kept[i], gain * gain * slow[10 * i], 1e-6);  // two passes, no delay
    EXPECT_NEAR(dropped[i], 0.0, 1e-6);
  }
}

}  // namespace
}  // namespace omnihil
