// A bridge's legs on the mean of an interval.
#include "firmware_iface/mcu/board/leg_means.h"

#include <gtest/gtest.h>

namespace omnihil::mcu {
namespace {

BridgeLegs legs(std::uint32_t first, double first_duty, std::uint32_t others = OMNIHIL_LEG_OFF,
                double others_duty = 0.0) {
  return {{first, others, others}, {first_duty, others_duty, others_duty}};
}

// `before` for `before_ns` of 100 ns, then `after`.
BridgeLegs mean(const BridgeLegs& before, const BridgeLegs& after, std::int64_t before_ns) {
  LegMeans means;
  means.begin(before, 1000);
  means.hold(after, 1000 + before_ns);
  const BridgeLegs is = means.end(1100);
  EXPECT_EQ(means.held().leg[0], after.leg[0]);
  EXPECT_EQ(means.held().duty_ratio[0], after.duty_ratio[0]);
  return is;
}

void expect_leg(const BridgeLegs& is, std::uint32_t leg, double duty) {
  EXPECT_EQ(is.leg[0], leg);
  EXPECT_DOUBLE_EQ(is.duty_ratio[0], duty);
}

TEST(LegMeans, ADutyThatStepsIsItsMean) {
  expect_leg(mean(legs(OMNIHIL_LEG_PWM, 0.2), legs(OMNIHIL_LEG_PWM, 0.6), 25), OMNIHIL_LEG_PWM,
             0.25 * 0.2 + 0.75 * 0.6);
}

// 0.1 has no exact mean of itself.
TEST(LegMeans, ALegThatDoesNotChangeIsWhatItWasToTheLastBit) {
  const BridgeLegs still = mean(legs(OMNIHIL_LEG_PWM, 0.2, OMNIHIL_LEG_PWM, 0.1),
                                legs(OMNIHIL_LEG_PWM, 0.7, OMNIHIL_LEG_PWM, 0.1), 33);
  EXPECT_EQ(still.duty_ratio[1], 0.1);
  const BridgeLegs low = mean(legs(OMNIHIL_LEG_PWM, 0.2, OMNIHIL_LEG_LOW, 1.0),
                              legs(OMNIHIL_LEG_PWM, 0.7, OMNIHIL_LEG_LOW, 1.0), 33);
  EXPECT_EQ(low.leg[1], static_cast<std::uint32_t>(OMNIHIL_LEG_LOW));
  EXPECT_EQ(low.duty_ratio[1], 1.0);
}

TEST(LegMeans, ALegHeldAtARailIsADutyOfThatRail) {
  expect_leg(mean(legs(OMNIHIL_LEG_LOW, 1.0), legs(OMNIHIL_LEG_PWM, 0.5), 50), OMNIHIL_LEG_PWM, 0.25);
  expect_leg(mean(legs(OMNIHIL_LEG_HIGH, 1.0), legs(OMNIHIL_LEG_PWM, 0.5), 50), OMNIHIL_LEG_PWM, 0.75);
}

TEST(LegMeans, OneSwitchAndOpenIsThatSwitchForItsShare) {
  expect_leg(mean(legs(OMNIHIL_LEG_HIGH, 0.4), legs(OMNIHIL_LEG_OFF, 0.0), 50), OMNIHIL_LEG_HIGH, 0.2);
}

TEST(LegMeans, BothSwitchesAndOpenIsWhatItWasLonger) {
  expect_leg(mean(legs(OMNIHIL_LEG_PWM, 0.4), legs(OMNIHIL_LEG_OFF, 0.0), 60), OMNIHIL_LEG_PWM, 0.4);
  expect_leg(mean(legs(OMNIHIL_LEG_PWM, 0.4), legs(OMNIHIL_LEG_OFF, 0.0), 40), OMNIHIL_LEG_OFF, 0.0);
}

}  // namespace
}  // namespace omnihil::mcu
