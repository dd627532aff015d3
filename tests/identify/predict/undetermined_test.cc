#include "identify/predict/undetermined.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace omnihil {
namespace {

std::size_t count(const std::vector<bool>& x) {
  return static_cast<std::size_t>(std::count(x.begin(), x.end(), true));
}

// Rest, motion, rest; and a motion that turns round.
TEST(Undetermined, StandingStillIsAWindowInWhichThePositionStays) {
  std::vector<double> position;
  for (int k = 0; k < 40; ++k) position.push_back(0.1 * std::clamp(k, 10, 15));
  for (int k = 0; k < 40; ++k) position.push_back(0.5 - 0.02 * (k - 20.5) * (k - 20.5));
  const std::vector<bool> still = standing_still(position, 0.01, 5, 0);
  EXPECT_TRUE(still[0] && still[10]);    // before it begins
  EXPECT_FALSE(still[11] || still[14]);  // it moves
  EXPECT_TRUE(still[15] && still[39]);
  EXPECT_EQ(std::count(still.begin() + 50, still.end(), true), 0);  // the turn
  EXPECT_EQ(count(standing_still(position, 0.01, 5, 2)),
            count(still) + 6);  // two behind 10, before 15, behind 39
  EXPECT_EQ(count(standing_still(std::vector<double>(50, 1.0), 0.0, 5, 0)), 50u);
}

TEST(Undetermined, AJumpBetweenTwoRowsIsUnresolvedAndACurveIsNot) {
  std::vector<double> torque;
  for (int k = 0; k < 400; ++k) torque.push_back(std::sin(2.0 * std::numbers::pi * 0.02 * k));
  EXPECT_EQ(count(unresolved_jumps(torque, 0.2, 0.01, 10)), 0u);
  for (int k = 200; k < 400; ++k) torque[static_cast<std::size_t>(k)] += 1.0;
  // 0.2 / sqrt(12) = 0.058 of it are above 0.05, not above 0.06
  const std::vector<bool> jumps = unresolved_jumps(torque, 0.2, 0.04, 10);
  EXPECT_EQ(count(jumps), 22u);
  EXPECT_TRUE(jumps[199] && jumps[200] && !jumps[188] && !jumps[211]);
  EXPECT_EQ(count(unresolved_jumps(torque, 0.2, 0.06, 10)), 0u);
}

// The mean of before and after, written where it changes, says when it changed.
TEST(Undetermined, AJumpWrittenAsItsMeanIsResolved) {
  std::vector<double> torque(100, 0.0);
  std::fill(torque.begin() + 51, torque.end(), 1.0);
  EXPECT_EQ(count(unresolved_jumps(torque, 0.2, 0.01, 5)), 12u);
  torque[50] = 0.5;
  EXPECT_EQ(count(unresolved_jumps(torque, 0.2, 0.01, 5)), 0u);
}

TEST(Undetermined, ARecordMadeOfJumpsKeepsThem) {
  std::vector<double> torque;
  for (int k = 0; k < 400; ++k) torque.push_back(k / 8 % 2 == 0 ? 1.0 : -1.0);
  EXPECT_EQ(count(unresolved_jumps(torque, 0.2, 0.01, 10)), 0u);
}

}  // namespace
}  // namespace omnihil
