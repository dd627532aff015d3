// A refusal is the first thing that an effect demands and a rig does not have, in the rig's own words.
#include "sim/law/demands.h"

#include <gtest/gtest.h>

#include <set>

#include "sim/law/effect.h"

namespace omnihil {
namespace {

EffectInfo effect(Place place, std::uint32_t demands = kNeedsNothing, std::uint32_t rigs = kOnBoth) {
  EffectInfo info{};
  info.place = place;
  info.demands = demands;
  info.rigs = rigs;
  return info;
}

Capabilities bench(std::vector<Capability> list) {
  return {.rig = kOnAxis,
          .other_rig = "acts on a robot on the floor",
          .list = std::move(list),
          .free_base = {"motor.inductance_H"},
          .present_base = {"load.gravity_torque_Nm"}};
}

TEST(Demands, APlaceHasDemandsOfItsOwn) {
  EXPECT_EQ(demands_of(effect(Place::kTorque)), kNeedsNothing);
  EXPECT_EQ(demands_of(effect(Place::kShaft)), kNeedsTwoInertias);
  EXPECT_EQ(demands_of(effect(Place::kBridge, kNeedsDuty)), kNeedsWinding | kNeedsDuty);
}

TEST(Demands, WhatIsThereRefusesNothing) {
  const Capabilities rig = bench({{kNeedsWinding, true, "no winding"}, {kNeedsDuty, true, "no duty"}});
  EXPECT_EQ(refusal(effect(Place::kTorque), rig), "");
  EXPECT_EQ(refusal(effect(Place::kBridge, kNeedsDuty), rig), "");
}

TEST(Demands, TheFirstThatIsMissingIsSaidInTheRigsWords) {
  const Capabilities rig = bench({{kNeedsWinding, false, "no winding"}, {kNeedsDuty, false, "no duty"}});
  EXPECT_EQ(refusal(effect(Place::kCommand, kNeedsDuty), rig), "no duty");
  EXPECT_EQ(refusal(effect(Place::kBridge, kNeedsDuty), rig), "no winding");
}

TEST(Demands, WhatARigDoesNotListItDoesNotHave) {
  EXPECT_EQ(refusal(effect(Place::kTorque, kNeedsCamera), bench({})), "needs a camera");
}

TEST(Demands, AnEffectOfAnotherRigIsRefusedFirst) {
  EXPECT_EQ(refusal(effect(Place::kTorque, kNeedsCamera, kOnRobot), bench({})),
            "acts on a robot on the floor");
}

TEST(Demands, ABaseParameterThatDoesTheSameExcludesIt) {
  const auto excluding = [](std::string_view path, BaseExclusion::When when) {
    EffectInfo info = effect(Place::kTorque);
    info.excludes = {path, when};
    return refusal(info, bench({}));
  };
  EXPECT_EQ(excluding("motor.inductance_H", BaseExclusion::kWhereFree),
            "the base model's motor.inductance_H is free");
  EXPECT_EQ(excluding("motor.inductance_H", BaseExclusion::kWherePresent), "");
  EXPECT_EQ(excluding("load.gravity_torque_Nm", BaseExclusion::kWherePresent),
            "the base model has load.gravity_torque_Nm");
  EXPECT_EQ(excluding("load.gravity_torque_Nm", BaseExclusion::kWhereFree), "");
}

TEST(Demands, EachHasANameOfItsOwn) {
  std::set<std::string_view> names;
  for (int bit = 0; bit < kDemands; ++bit) names.insert(demand_name(static_cast<DemandBit>(1u << bit)));
  EXPECT_EQ(names.size(), static_cast<std::size_t>(kDemands));
  EXPECT_FALSE(names.contains(""));
}

}  // namespace
}  // namespace omnihil
