// Drives by commanded velocity: rich, and near where they began.
#include "identify/design/body_drive.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

namespace omnihil {
namespace {

TEST(BodyDrive, StaysInItsRoomAndWithinItsSpeeds) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const BodyDriveOptions o{
        .duration_s = 30.0, .speed_m_s = 1.5, .turn_rad_s = 4.0, .room_m = 0.8, .seed = seed};
    for (const auto& steps : {random_body_drive(o), scan_body_drive(o)}) {
      EXPECT_LE(farthest_m(steps, o.duration_s), 0.8 + 0.01)
          << seed;  // values are rounded to 1 mm/s over 30 s
      for (std::size_t k = 0; k < steps.size(); ++k) {
        EXPECT_LE(std::hypot(steps[k].value[0], steps[k].value[1]), 1.5 + 1e-3);
        EXPECT_LE(std::abs(steps[k].value[2]), 4.0 + 1e-3);
        if (k > 0) {
          EXPECT_GT(steps[k].at_s, steps[k - 1].at_s);
        }
      }
    }
  }
}

TEST(BodyDrive, VisitsEveryDirectionBothTurnsAndRest) {
  const auto steps = random_body_drive({.duration_s = 60.0, .seed = 3});
  std::set<int> octants;
  int left = 0, right = 0, rests = 0;
  for (const BodyStep& s : steps) {
    const double speed = std::hypot(s.value[0], s.value[1]);
    if (speed > 0.1)
      octants.insert(
          static_cast<int>(std::floor((std::atan2(s.value[1], s.value[0]) / std::numbers::pi + 1.0) * 4.0)) %
          8);
    left += s.value[2] > 0.5, right += s.value[2] < -0.5;
    rests += speed == 0.0 && s.value[2] == 0.0;
  }
  EXPECT_EQ(octants.size(), 8u);
  EXPECT_GE(left, 5);
  EXPECT_GE(right, 5);
  EXPECT_GE(rests, 2);
}

TEST(BodyDrive, ASeedIsADrive) {
  const auto a = random_body_drive({.seed = 1}), b = random_body_drive({.seed = 1}),
             c = random_body_drive({.seed = 2});
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k) EXPECT_EQ(a[k].value, b[k].value);
  EXPECT_TRUE(c.size() != a.size() || c[0].value != a[0].value);
}

TEST(BodyDrive, AStraightWayIsItsLength) {
  EXPECT_NEAR(farthest_m({{0.0, {0.5, 0, 0}}, {1.0, {-0.5, 0, 0}}}, 3.0), 0.5, 1e-12);
  // Half a circle of radius v / w = 0.5 m ends one diameter away.
  EXPECT_NEAR(farthest_m({{0.0, {1.0, 0, 2.0}}}, std::numbers::pi / 2.0), 1.0, 1e-9);
}

}  // namespace
}  // namespace omnihil
