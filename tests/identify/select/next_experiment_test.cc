#include "identify/select/next_experiment.h"

#include <gtest/gtest.h>

#include "identify/record/rig.h"

namespace omnihil {
namespace {

Dataset bench() {
  Dataset d;
  d.name = "run/bench";
  return d;
}

TEST(NextExperimentTest, DecidesANameBeforeANumber) {
  Diagnosis d;
  d.confounded = {{.members = {"gear_efficiency", "motor.torque_constant_Nm_per_A"}, .sentence = {}},
                  {.members = {"cogging", "imbalance"}, .sentence = {}}};
  const NextExperiment next = next_experiment(bench(), d);
  EXPECT_EQ(next.separates, (std::vector<std::string>{"cogging", "imbalance"}));
  EXPECT_EQ(next.command, "omnihil experiment run/bench --separate cogging,imbalance --out next");
}

TEST(NextExperimentTest, HoldsAnEffectAgainstTheBaseWhereABaseParameterImitatesIt) {
  Diagnosis d;
  d.confounded = {{.members = {"gear_efficiency", "motor.torque_constant_Nm_per_A"}, .sentence = {}}};
  EXPECT_EQ(next_experiment(bench(), d).command,
            "omnihil experiment run/bench --separate gear_efficiency,base --out next");
}

TEST(NextExperimentTest, PlansTheRunThatShowsWhatTheseDataCouldNot) {
  Diagnosis d;
  RankedEffect hidden;
  hidden.effect = "cogging";
  hidden.visibility = Visibility::kBelowNoise;
  d.ranking = {hidden};
  EXPECT_EQ(next_experiment(bench(), d).command,
            "omnihil experiment run/bench --separate cogging,base --out next");
}

TEST(NextExperimentTest, AsksForNoPlanOfARigThatHasNone) {
  Diagnosis d;
  d.confounded = {{.members = {"cogging", "imbalance"}, .sentence = {}}};
  Rig half = rig_axis();
  half.no_plan = "half of its drive is the bench's";
  Dataset given = bench();
  given.rig = &half;
  EXPECT_EQ(next_experiment(given, d).command, "");
  EXPECT_FALSE(next_experiment(given, d).what.empty());
}

// Nobody sweeps time slowly in both directions.
TEST(NextExperimentTest, SaysWhatAPersonCanDoAboutAResidual) {
  Diagnosis d;
  d.verdict = Verdict::kUnknown;
  d.where = {{.signal = "velocity", .against = "time", .explained_fraction = 0.48}};
  EXPECT_NE(next_experiment(bench(), d).what.find("from cold and, without a pause, from warm"),
            std::string::npos);
  EXPECT_NE(next_experiment(bench(), d).what.find("time explains 48 % of the residual of velocity"),
            std::string::npos);
  d.where.front().against = "acceleration";
  EXPECT_EQ(next_experiment(bench(), d).what.find("sweeps over"), std::string::npos);
  d.where.front().against = "velocity";
  EXPECT_NE(next_experiment(bench(), d).what.find("sweeps over velocity"), std::string::npos);
}

TEST(NextExperimentTest, HasNoCommandWhereThereIsNothingToTellApart) {
  const NextExperiment next = next_experiment(bench(), Diagnosis());
  EXPECT_FALSE(next.what.empty());
  EXPECT_EQ(next.command, "");
}

}  // namespace
}  // namespace omnihil
