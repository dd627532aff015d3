// Points on straight lines, by their equation.
#include "identify/predict/interpolation.h"

#include <gtest/gtest.h>

#include <limits>

namespace omnihil::test {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
const std::vector<double> kTime_s = {0.0, 1.0, 3.0};
const std::vector<double> kValues = {2.0, 4.0, 10.0};

double at(double t) {
  return instant(kTime_s, t).of([](std::size_t k) { return kValues[k]; });
}

TEST(Interpolation, IsALineBetweenSamplesAndConstantOutside) {
  EXPECT_DOUBLE_EQ(at(0.25), 2.0 + 0.25 * 2.0);
  EXPECT_DOUBLE_EQ(at(2.0), 4.0 + 0.5 * 6.0);
  for (std::size_t k = 0; k < kTime_s.size(); ++k) EXPECT_DOUBLE_EQ(at(kTime_s[k]), kValues[k]);
  EXPECT_DOUBLE_EQ(at(-1.0), 2.0);
  EXPECT_DOUBLE_EQ(at(9.0), 10.0);
}

// dy/dt is the line's slope, and nothing outside.
TEST(Interpolation, CarriesTheDerivativeOfItsTime) {
  const auto slope_at = [](double t) {
    return instant(kTime_s, Jet(t, 3)).of([](std::size_t k) { return kValues[k]; }).v[3];
  };
  EXPECT_DOUBLE_EQ(slope_at(2.0), 3.0);
  EXPECT_DOUBLE_EQ(slope_at(-1.0), 0.0);
  EXPECT_DOUBLE_EQ(slope_at(9.0), 0.0);
}

TEST(Interpolation, OfOneSampleIsThatSample) {
  const double y = instant({5.0}, 7.0).of([](std::size_t) { return 3.0; });
  EXPECT_DOUBLE_EQ(y, 3.0);
}

TEST(Interpolation, PassesOverMissingValues) {
  const std::vector<double> t = {0.0, 1.0, 2.0, 3.0}, clock = {-1.0, 0.0, 1.0, 2.5, 9.0};
  const std::vector<double> x = {kNaN, 1.0, kNaN, 5.0};
  EXPECT_EQ(resampled(t, x, clock), (std::vector<double>{1.0, 1.0, 1.0, 4.0, 5.0}));
  const auto held = [](double late_s) {
    return [=](const KnownValues& known, double at_s) { return known.held_at(at_s, late_s); };
  };
  EXPECT_EQ(resampled(t, x, clock, held(0.0)), (std::vector<double>{1.0, 1.0, 1.0, 1.0, 5.0}));
  EXPECT_EQ(resampled(t, x, {2.95}, held(0.1)), (std::vector<double>{5.0})) << "0.05 s early counts as there";
  EXPECT_TRUE(resampled(t, {kNaN, kNaN, kNaN, kNaN}, clock).empty());
}

}  // namespace
}  // namespace omnihil::test
