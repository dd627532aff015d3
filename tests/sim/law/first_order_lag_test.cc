#include "sim/law/first_order_lag.h"

#include <gtest/gtest.h>

#include <cmath>

namespace omnihil {
namespace {

TEST(FirstOrderLag, AnswersAStepByItsExponential) {
  double y = 0.0, area = 0.0;
  for (int n = 0; n < 50; ++n) area += 1e-3 * lag_behind_held(y, 1.0, 1e-3, 0.02);
  EXPECT_NEAR(y, 1.0 - std::exp(-0.05 / 0.02), 1e-12);
  EXPECT_NEAR(area, 0.05 - 0.02 * y, 1e-12);  // integral of 1 - exp(-t / tau)
}

TEST(FirstOrderLag, IsLateByItsTimeConstantBehindARamp) {
  double y = 0.0;
  for (int n = 0; n < 400; ++n) y = lag_behind_line(y, 0.5 * n, 0.5 * (n + 1), 1e-3, 0.02);
  EXPECT_NEAR(y, 0.5 * 400 - 500.0 * 0.02, 1e-5);
}

TEST(FirstOrderLag, DoesNotDependOnHowAStepIsCut) {
  double whole = 0.3, parts = 0.3;
  whole = lag_behind_line(whole, 1.0, 2.0, 0.01, 0.004);
  for (int n = 0; n < 10; ++n) parts = lag_behind_line(parts, 1.0 + 0.1 * n, 1.1 + 0.1 * n, 0.001, 0.004);
  EXPECT_NEAR(parts, whole, 1e-12);
}

// At no time constant: the input itself, and the derivative of a delay by tau.
TEST(FirstOrderLag, BecomesADelayAtNeutral) {
  const Jet tau(0.0, 0);
  const Jet late = lag_behind_line(Jet(3.0), Jet(1.0), Jet(2.0), 0.01, tau);
  EXPECT_EQ(late.a, 2.0);
  EXPECT_EQ(late.v[0], -100.0);  // - du/dt
  Jet y(0.0);
  const Jet mean = lag_behind_held(y, Jet(1.0), 0.01, tau);
  EXPECT_EQ(mean.a, 1.0);
  EXPECT_EQ(mean.v[0], -100.0);  // a step of 1 that comes tau later, over 0.01 s
  EXPECT_EQ(y.a, 1.0);
  EXPECT_EQ(y.v[0], 0.0);
}

TEST(FirstOrderLag, HasDerivativesThatAgreeWithDifferences) {
  const auto at = [](auto tau) {
    auto y = decltype(tau)(0.2);
    auto sum = decltype(tau)(0.0);
    for (int n = 0; n < 5; ++n) sum += lag_behind_held(y, decltype(tau)(n % 2), 0.003, tau);
    return sum + y;
  };
  const double step = 1e-6;
  EXPECT_NEAR(at(Jet(0.004, 0)).v[0], (at(0.004 + step) - at(0.004 - step)) / (2.0 * step), 1e-4);
}

}  // namespace
}  // namespace omnihil
