#include "hil/scenario/wheel_order.h"

#include <gtest/gtest.h>

namespace omnihil {
namespace {

using Four = std::array<double, kWheels>;
constexpr Four kWanted = {21, 33, 4, 13};

TEST(WheelOrder, EachAtItsOwnSpeedIsRight) {
  const WheelOrder order = wheel_order({20, 30, 5, 12}, kWanted);
  EXPECT_EQ(order.verdict, "");
  EXPECT_EQ(order.out_of_place, 0);
}

TEST(WheelOrder, NamesTwoThatAreExchanged) {
  EXPECT_EQ(wheel_order({21, 4, 33, 13}, kWanted).verdict, "wheels 1 and 2 are exchanged");
  EXPECT_EQ(wheel_order({21, 4, 33, 13}, kWanted).out_of_place, 2);
  EXPECT_EQ(wheel_order({33, 21, 13, 4}, kWanted).verdict,
            "wheels 0 and 1 are exchanged, wheels 2 and 3 are exchanged");
}

TEST(WheelOrder, NamesARound) {
  EXPECT_EQ(
      wheel_order({33, 4, 21, 13}, kWanted).verdict,
      "wheel 0 turns at wheel 1's speed, wheel 1 turns at wheel 2's speed, wheel 2 turns at wheel 0's speed");
}

TEST(WheelOrder, AWheelAtNobodysSpeedIsSaidSo) {
  EXPECT_EQ(wheel_order({21, 100, 4, 13}, kWanted).verdict,
            "wheel 1 turns at 100 rad/s, which is asked of none");
}

TEST(WheelOrder, NeedsFourDifferentSpeeds) {
  EXPECT_NE(wheel_order({15, 15, 15, 15}, {15, 15, 15, 15}).verdict.find("tell the wheels apart"),
            std::string::npos);
}

}  // namespace
}  // namespace omnihil
