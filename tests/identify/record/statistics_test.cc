// Order statistics of samples small enough to sort by eye; the robust sigma against a normal's quantile.
#include "identify/record/statistics.h"

#include <gtest/gtest.h>

#include <limits>

namespace omnihil {
namespace {

TEST(Statistics, MedianIsTheMiddleValueAndOfAnEvenNumberTheUpperOfTheTwo) {
  EXPECT_EQ(median({5.0, 1.0, 3.0}), 3.0);
  EXPECT_EQ(median({4.0, 1.0, 3.0, 2.0}), 3.0);
  EXPECT_EQ(median({7.0}), 7.0);
  EXPECT_EQ(median({}), 0.0);
}

TEST(Statistics, QuantilesAreTheValuesOfTheirRanks) {
  const std::vector<double> ten{9, 8, 7, 6, 5, 4, 3, 2, 1, 0};  // sorted, the value is the index
  // p (n - 1) = 0.28 * 9 = 2.52; p n = 2.8
  EXPECT_EQ(quantile(ten, 0.28, QuantileRank::kNearest), 3.0);
  EXPECT_EQ(quantile(ten, 0.28, QuantileRank::kLower), 2.0);
  EXPECT_EQ(quantile(ten, 0.28, QuantileRank::kAbove), 2.0);
  // 0.95 * 9 = 8.55; 0.95 * 10 = 9.5
  EXPECT_EQ(quantile(ten, 0.95, QuantileRank::kNearest), 9.0);
  EXPECT_EQ(quantile(ten, 0.95, QuantileRank::kLower), 8.0);
  EXPECT_EQ(quantile(ten, 0.95, QuantileRank::kAbove), 9.0);
  for (const QuantileRank rank : {QuantileRank::kNearest, QuantileRank::kLower, QuantileRank::kAbove}) {
    EXPECT_EQ(quantile(ten, 0.0, rank), 0.0);
    EXPECT_EQ(quantile(ten, 1.0, rank), 9.0);
    EXPECT_EQ(quantile({}, 0.5, rank), 0.0);
  }
}

TEST(Statistics, TheMedianIsTheNearestHalfQuantileForEveryLength) {
  std::vector<double> values;
  for (int n = 1; n <= 9; ++n) {
    values.push_back((n * 4) % 9);
    EXPECT_EQ(median(values), quantile(values, 0.5, QuantileRank::kNearest)) << n;
    EXPECT_EQ(median(values), quantile(values, 0.5, QuantileRank::kAbove)) << n;
  }
}

// The share of a standard normal within ±1/1.4826 is a half: erf(x / sqrt 2) = 0.5.
TEST(Statistics, ScaledMedianOfSizesIsTheSigmaOfANormal) {
  EXPECT_NEAR(std::erf(1.0 / kSigmaPerMad / std::sqrt(2.0)), 0.5, 1e-6);
  EXPECT_EQ(sigma_by_mad({0.1, 2.0, 0.3, 1e9, 0.2}), kSigmaPerMad * 0.3);  // however far the outlier is
}

TEST(Statistics, FiniteValuesKeepTheirOrder) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(finite_values(std::vector<double>{3.0, nan, 1.0, std::numeric_limits<double>::infinity(), 2.0}),
            (std::vector<double>{3.0, 1.0, 2.0}));
}

}  // namespace
}  // namespace omnihil
