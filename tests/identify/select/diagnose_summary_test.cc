// Confounded sets against the effects of the answer.
#include "identify/select/diagnose_summary.h"

#include <gtest/gtest.h>

namespace omnihil {
namespace {

using Names = std::vector<std::string>;

Diagnosis answer(Names effects, std::vector<ConfoundedSet> sets) {
  Diagnosis d;
  d.effects = std::move(effects);
  d.confounded = std::move(sets);
  settle_confounded(d);
  return d;
}

TEST(SettleConfounded, WhatALaterIterationTookIsNoAlternative) {
  const Diagnosis d = answer({"stribeck_friction", "lugre_friction"},
                             {{{"stribeck_friction", "coulomb_friction", "lugre_friction"}, "of three"}});
  ASSERT_EQ(d.confounded.size(), 1u);
  EXPECT_EQ(d.confounded[0].members, (Names{"stribeck_friction", "coulomb_friction"}));
  EXPECT_EQ(
      d.confounded[0].sentence,
      "These data cannot tell apart: stribeck_friction, coulomb_friction. The first is the simplest; any of "
      "them explains the recording as well.");
}

TEST(SettleConfounded, ASetOfOneIsNone) {
  EXPECT_TRUE(answer({"grease_drag", "coulomb_friction"}, {{{"grease_drag", "coulomb_friction"}, "of two"}})
                  .confounded.empty());
}

TEST(SettleConfounded, OfAnEffectThatWasRemovedNothingIsSaid) {
  EXPECT_TRUE(answer({"dead_time"}, {{{"backlash", "gear_efficiency"}, "of two"}}).confounded.empty());
}

TEST(SettleConfounded, OthersStayAsTheyAre) {
  const Diagnosis d =
      answer({"gravity_load"}, {{{"gravity_load", "imbalance"}, "as it was"},
                                {{"gravity_load", "motor.resistance_ohm"}, "2 % is its own"}});
  ASSERT_EQ(d.confounded.size(), 2u);
  EXPECT_EQ(d.confounded[0].sentence, "as it was");
  EXPECT_EQ(d.confounded[1].members.size(), 2u);
}

}  // namespace
}  // namespace omnihil
