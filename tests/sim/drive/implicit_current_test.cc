#include "sim/drive/implicit_current.h"

#include <gtest/gtest.h>

namespace omnihil::test {
namespace {

TEST(ImplicitCurrent, SolvesALinearLaw) {
  EXPECT_NEAR(implicit_current(5.0, [](double i) { return 2.0 - 0.6 * i; }), 2.0 / 1.6, 1e-12);
  EXPECT_EQ(implicit_current(0.0, [](double i) { return -30.0 * i; }), 0.0);
}

// i = v - V i / sqrt(i^2 + w^2) with v < V: about w v / sqrt(V^2 - v^2), not the zero mean of two sides.
TEST(ImplicitCurrent, StaysWithinTheWidthOfASteepLaw) {
  for (const double width_A : {1e-3, 1e-5}) {
    const auto law = [&](double i) { return 0.3 - 0.5 * i / std::hypot(i, width_A); };
    const double i = implicit_current(-0.7, law);
    EXPECT_NEAR(i, law(i), 1e-6);
    // v / sqrt(V^2 - v^2), to the first order of w
    EXPECT_NEAR(i / width_A, 0.3 / 0.4, 0.01);
  }
}

// i = a - b i: di/da = 1 / (1 + b), di/db = -i / (1 + b); steep laws alike.
TEST(ImplicitCurrent, CarriesTheDerivativesOfTheSolution) {
  const Jet a(2.0, 0), b(0.6, 1);
  const Jet i = implicit_current(Jet(0.1), [&](const Jet& x) { return a - b * x; });
  EXPECT_NEAR(i.v[0], 1.0 / 1.6, 1e-8);
  EXPECT_NEAR(i.v[1], -1.25 / 1.6, 1e-8);
  const auto steep = [](const auto& v, const auto& w) {
    using T = std::decay_t<decltype(v)>;
    return implicit_current(T(0.0), [&](const T& x) {
      using std::sqrt;
      return v - 0.5 * x / sqrt(x * x + w * w);
    });
  };
  const Jet solution = steep(Jet(0.3, 0), Jet(1e-2, 1));
  EXPECT_NEAR(solution.v[0], (steep(0.3 + 1e-6, 1e-2) - steep(0.3 - 1e-6, 1e-2)) / 2e-6, 1e-6);
  EXPECT_NEAR(solution.v[1], (steep(0.3, 1e-2 + 1e-7) - steep(0.3, 1e-2 - 1e-7)) / 2e-7, 1e-5);
}

// A voltage that grows with the current faster than the resistance takes: no solution between, the start stands.
TEST(ImplicitCurrent, LeavesALawThatRunsAway) {
  EXPECT_EQ(implicit_current(1.0, [](double i) { return 1.0 + 2.0 * i; }), 1.0);
}

}  // namespace
}  // namespace omnihil::test
