// A diagnosis says whether effects were tried, and why not; it never says that none explains what none was
// held against.
#include <gtest/gtest.h>

#include "identify/select/diagnosis.h"
#include "tests/identify/simulated_bench.h"

namespace omnihil {
namespace {

class SlowNotSearched : public testing::Test {
 protected:
  void SetUp() override {
    bench_ = simulated_bench({.with = {"cogging.amplitude_Nm=0.02"},
                              .excitations = {Excitation::kSteps, Excitation::kPrbs, Excitation::kSteps},
                              .duration_s = 1.5,
                              .model = {}});
    options_.jobs = 2;
    options_.max_effects = 1;
  }
  void turn_the_current_round() {
    for (omnihil::Run& run : bench_.dataset.runs) {
      for (double& v : run.signals.find("motor_current")->second) v = -v;
    }
  }
  Diagnosis diagnosed() { return diagnose(bench_.dataset, bench_.nominal, options_); }

  void expect_not_searched(const Diagnosis& d, const std::string& why) {
    EXPECT_EQ(d.outcome, Outcome::kNotSearched);
    EXPECT_EQ(d.verdict, Verdict::kUnknown);
    EXPECT_TRUE(d.effects.empty());
    EXPECT_NE(d.not_searched.find(why), std::string::npos) << d.not_searched;
    EXPECT_EQ(d.unknown.sentence.find("no known effect"), std::string::npos) << d.unknown.sentence;
    EXPECT_TRUE(d.searched_despite.empty()) << d.searched_despite;
  }

  Bench bench_;
  DiagnoseOptions options_;
};

TEST_F(SlowNotSearched, AFaultOfTheDataEndsItBeforeAnyEffect) {
  turn_the_current_round();
  const Diagnosis d = diagnosed();
  expect_not_searched(d, "motor_current falls where the voltage rises");
  EXPECT_TRUE(d.ranking.empty());
}

TEST_F(SlowNotSearched, AnywaySearchesPastItAndSaysSo) {
  turn_the_current_round();
  options_.despite_faults = true;
  const Diagnosis d = diagnosed();
  EXPECT_NE(d.outcome, Outcome::kNotSearched);
  EXPECT_TRUE(d.not_searched.empty()) << d.not_searched;
  EXPECT_NE(d.searched_despite.find("motor_current falls where the voltage rises"), std::string::npos);
  EXPECT_FALSE(d.ranking.empty());
}

TEST_F(SlowNotSearched, SoundDataAreSearchedAndNothingIsSaidOfFaults) {
  options_.despite_faults = true;
  const Diagnosis d = diagnosed();
  EXPECT_TRUE(d.not_searched.empty()) << d.not_searched;
  EXPECT_TRUE(d.searched_despite.empty()) << d.searched_despite;
}

TEST_F(SlowNotSearched, AnInterruptBeforeTheFirstEffectIsNoVerdict) {
  options_.progress = [](const Progress&) { return false; };
  const Diagnosis d = diagnosed();
  expect_not_searched(d, "interrupted");
  EXPECT_FALSE(d.complete);
}

TEST_F(SlowNotSearched, AnInterruptWhileScreeningIsNoVerdict) {
  options_.progress = [](const Progress& p) { return p.doing.find("round 1") == std::string::npos; };
  expect_not_searched(diagnosed(), "interrupted");
}

}  // namespace
}  // namespace omnihil
