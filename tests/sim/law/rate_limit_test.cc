#include "sim/law/rate_limit.h"

#include <gtest/gtest.h>

namespace omnihil {
namespace {

template <typename T>
T mean_of_walk(T& x, const T& target, double step_s, const T& inverse_rate) {
  const Walked<T> w = walk_towards(x, target, step_s, inverse_rate);
  return w.mean - w.lost;
}

TEST(RateLimit, WalksAtItsRateAndStopsAtTheTarget) {
  double x = 0.0, area = 0.0;
  for (int n = 0; n < 100; ++n) area += 0.01 * mean_of_walk(x, -1.0, 0.01, 0.25);
  EXPECT_EQ(x, -1.0);
  EXPECT_NEAR(area, -(1.0 - 0.5 * 0.25), 1e-12);  // the triangle until it is there is lost
}

TEST(RateLimit, LosesTheSameHoweverAStepIsCut) {
  for (const int steps : {1, 3, 7, 50}) {
    double x = 0.2, area = 0.0;
    for (int n = 0; n < steps; ++n) area += mean_of_walk(x, 1.0, 0.1 / steps, 0.06) * 0.1 / steps;
    EXPECT_NEAR(area, 0.1 - 0.5 * 0.8 * 0.8 * 0.06, 1e-12) << steps;
  }
}

TEST(RateLimit, JumpsAtNeutralAndHasItsSlopeThere) {
  Jet x(0.0);
  const Jet mean = mean_of_walk(x, Jet(2.0), 0.01, Jet(0.0, 0));
  EXPECT_EQ(mean.a, 2.0);
  EXPECT_NEAR(mean.v[0], -0.5 * 2.0 * 2.0 / 0.01, 1e-9);
  EXPECT_EQ(x.a, 2.0);
}

}  // namespace
}  // namespace omnihil
