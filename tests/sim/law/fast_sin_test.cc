#include "sim/law/fast_sin.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sim/law/random.h"

namespace omnihil::test {
namespace {

TEST(FastSin, AgreesWithTheLibraryToRounding) {
  for (const double range : {1.0, 100.0, 1e6}) {
    for (std::uint64_t n = 0; n < 100000; ++n) {
      const double x = range * (2.0 * uniform(1, 2, n) - 1.0);
      EXPECT_NEAR(sin_of(x), std::sin(x), 5e-16) << x;
      EXPECT_NEAR(cos_of(x), std::cos(x), 5e-16 + std::abs(x) * 1.2e-16) << x;  // the shift by pi/2 rounds
    }
  }
}

TEST(FastSin, IsOddAndZeroAtZero) {
  EXPECT_EQ(sin_of(0.0), 0.0);
  for (std::uint64_t n = 0; n < 1000; ++n) {
    const double x = 50.0 * uniform(1, 3, n);
    EXPECT_EQ(sin_of(-x), -sin_of(x));
  }
}

TEST(FastSin, HasTheCosineForDerivative) {
  const Jet y = sin_of(Jet(0.7, 0) * 3.0);
  EXPECT_NEAR(y.v[0], 3.0 * std::cos(2.1), 1e-14);
}

// An imposed speed has no unknown behind it.
TEST(TurningMean, OfAConstantAngleHasTheSameBits) {
  for (const double angle : {1e-9, 0.3, 2.0, 40.0}) {
    const Jet by_parts = turning_mean<Jet>(Jet(angle)), quick = turning_mean(Jet(angle));
    EXPECT_EQ(quick.a, by_parts.a);
    EXPECT_EQ(quick.a, turning_mean(angle));
    EXPECT_TRUE(quick.v == by_parts.v) << angle;
    EXPECT_NE(turning_mean(Jet(angle, 0)).v[0], 0.0) << angle;
  }
}

}  // namespace
}  // namespace omnihil::test
