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
  settle_confounded({}, d);
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

// Two laws known to be taken for each other may be a set though one fits worse: the sentence says by how much.
TEST(SettleConfounded, TheSentenceSaysWhatAWorseFitLeaves) {
  const Diagnosis d = answer({"sampling_delay", "cogging"},
                             {{{"sampling_delay", "cogging", "hall_speed_estimator", "actuator_delay"},
                               "of four",
                               {1.0, 1.0, 3.2, 1.1}}});
  ASSERT_EQ(d.confounded.size(), 1u);
  EXPECT_TRUE(d.confounded[0].sentence.starts_with(
      "These data cannot tell apart: sampling_delay, hall_speed_estimator (leaves 3.2 times the error energy "
      "above the noise), actuator_delay. The first fits best;"))
      << d.confounded[0].sentence;
}

TEST(SettleConfounded, ASetOfOneIsNone) {
  EXPECT_TRUE(answer({"grease_drag", "coulomb_friction"}, {{{"grease_drag", "coulomb_friction"}, "of two"}})
                  .confounded.empty());
}

TEST(SettleConfounded, OfAnEffectThatWasRemovedNothingIsSaid) {
  EXPECT_TRUE(answer({"dead_time"}, {{{"backlash", "gear_efficiency"}, "of two"}}).confounded.empty());
}

TEST(SettleConfounded, AShaftsLawMayBeALossThatWasNotSearched) {
  Diagnosis d;
  d.effects = {"quadratic_drag"};
  d.confounded = {{{"quadratic_drag", "motor.torque_constant_Nm_per_A"}, "2 % is its own"}};
  Dataset points;
  points.rig = &rig_axis();
  points.channels = {{.signal = "duty", .column = "d", .unit = "1"},
                     {.signal = "velocity", .column = "w", .unit = "rad/s"}};
  points.runs.resize(1);
  Diagnosis motion = d;
  settle_confounded(points, motion);
  EXPECT_EQ(motion.confounded[0].members.size(), 2u) << "a motion shows them";
  points.runs[0].steady = true;
  settle_confounded(points, d);
  ASSERT_EQ(d.confounded.size(), 1u);
  EXPECT_EQ(d.confounded[0].members, (Names{"quadratic_drag", "dead_time", "coast_mode"}));
  EXPECT_NE(d.confounded[0].sentence.find("measure the current"), std::string::npos);
}

// A bench by torque takes the reported speed for the motion: what a low pass does to it was not searched.
TEST(SettleConfounded, OfAReportedSpeedALowPassMayBeMeant) {
  Dataset bench;
  bench.rig = &rig_axis();
  bench.channels = {{.signal = "motor_torque", .column = "t", .unit = "N m"},
                    {.signal = "velocity", .column = "w", .unit = "rad/s"}};
  bench.runs.resize(1);
  const Diagnosis before = answer({"shaft_compliance", "cogging"}, {});
  Diagnosis by_speed = before, by_position = before;
  settle_confounded(bench, by_speed);
  ASSERT_EQ(by_speed.confounded.size(), 1u);
  EXPECT_EQ(by_speed.confounded[0].members, (Names{"shaft_compliance", "speed_low_pass"}));
  EXPECT_NE(by_speed.confounded[0].sentence.find("was not searched"), std::string::npos);
  bench.channels.push_back({.signal = "position", .column = "p", .unit = "rad"});
  settle_confounded(bench, by_position);
  EXPECT_TRUE(by_position.confounded.empty());
}

TEST(SettleConfounded, OthersStayAsTheyAre) {
  const Diagnosis d =
      answer({"gravity_load"}, {{{"gravity_load", "imbalance"}, "as it was"},
                                {{"gravity_load", "motor.resistance_ohm"}, "2 % is its own"}});
  ASSERT_EQ(d.confounded.size(), 2u);
  EXPECT_EQ(d.confounded[0].sentence, "as it was");
  EXPECT_EQ(d.confounded[1].members.size(), 2u);
}

// The law that gave way explains the record as well: it stays an alternative of the one that took its place.
TEST(ReplaceInAnswer, KeepsWhatCannotBeToldApart) {
  Diagnosis d;
  d.effects = {"coast_mode", "lugre_friction"};
  d.confounded = {{{"lugre_friction", "stribeck_friction", "coulomb_friction"}, "of three"}};
  replace_in_answer("lugre_friction", "coulomb_friction", d);
  settle_confounded({}, d);
  EXPECT_EQ(d.effects, (Names{"coast_mode", "coulomb_friction"}));
  ASSERT_EQ(d.confounded.size(), 1u);
  EXPECT_EQ(d.confounded[0].members, (Names{"coulomb_friction", "lugre_friction", "stribeck_friction"}));
  EXPECT_NE(d.confounded[0].sentence.find("coulomb_friction, lugre_friction, stribeck_friction."),
            std::string::npos);
}

TEST(ReplaceInAnswer, NamesTheLawThatGaveWay) {
  Diagnosis d;
  d.effects = {"grease_drag"};
  d.confounded = {{{"grease_drag", "motor.viscous_friction_Nm_s_per_rad"}, "2 % is its own"}};
  replace_in_answer("grease_drag", "coulomb_friction", d);
  settle_confounded({}, d);
  ASSERT_EQ(d.confounded.size(), 1u);  // the base parameter was aliased with the law that is gone
  EXPECT_EQ(d.confounded[0].members, (Names{"coulomb_friction", "grease_drag"}));
}

}  // namespace
}  // namespace omnihil
