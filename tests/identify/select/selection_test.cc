#include "identify/select/selection.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sim/law/effect_registry.h"
#include "sim/law/random.h"
#include "tests/identify/fake_residuals.h"

namespace omnihil {
namespace {

constexpr int kSamples = 4000;

class MarkedPredictor : public FakePredictor {
 public:
  std::string mark;
  bool shows_signature_of(const EffectEntry& effect) const override { return effect.info->id == mark; }
};

// One run to fit and one held out, of noise; contenders that leave shares of it.
struct Ring {
  MarkedPredictor fake;
  std::unique_ptr<FakeResiduals> residuals;
  SelectionTask task;
  Fitted parent;
  Iteration iteration;

  Ring() {
    for (const Split split : {Split::kTraining, Split::kValidation}) {
      fake.add(split, std::vector<double>(kSamples, 1.0), std::vector<double>(kSamples, 0.0));
    }
    residuals = std::make_unique<FakeResiduals>(fake);
    task.predictor = &fake;
    task.channels = &residuals->channels;
    task.splits = residuals->splits.get();
    task.null = &residuals->null;
    task.acceptance_context = residuals->context;
    parent = leaving(1.0, 1.0);
  }

  // Root mean squares of the run's two halves.
  static Fitted leaving(double first, double second) {
    Fitted out;
    out.finite = true;
    for (std::size_t u = 0; u < 2; ++u) {
      out.residual[u] = Eigen::VectorXd::Constant(kSamples, first);
      out.residual[u].tail(kSamples / 2).setConstant(second);
    }
    return out;
  }

  void enter(const std::string& effect, Fitted fitted) {
    CandidateEffect c;
    c.screened.entry = find_effect(effect);
    c.screened.name = effect;
    c.fitted = std::move(fitted);
    c.acceptance = test_acceptance(task.acceptance_context, parent, c.fitted, "x", 100.0);
    EXPECT_TRUE(c.acceptance.accepted) << c.acceptance.why;
    iteration.candidates.push_back(std::move(c));
  }

  // Of no gain; a base parameter comes back with it.
  void believe(const std::string& effect, const std::string& base) {
    CandidateEffect c;
    c.screened.entry = find_effect(effect);
    c.screened.name = effect;
    c.screened.tried = true;
    c.screened.closest_parameter = base;
    c.fitted = leaving(1.0, 1.0);
    c.acceptance.accepted = c.acceptance.by_prior = true;
    EXPECT_EQ(c.screened.aliased_parameter(), base);
    iteration.candidates.push_back(std::move(c));
  }

  std::string winner() {
    select_best(task, parent, iteration);
    return iteration.chosen < 0
               ? ""
               : iteration.candidates[static_cast<std::size_t>(iteration.chosen)].screened.name;
  }

  std::vector<std::string> twins() const {
    std::vector<std::string> names;
    for (const int t : iteration.twins)
      names.push_back(iteration.candidates[static_cast<std::size_t>(t)].screened.name);
    return names;
  }
};

TEST(ContestTest, TheOneThatLeavesLeastWins) {
  Ring ring;
  ring.enter("cogging", Ring::leaving(0.8, 0.8));
  ring.enter("dead_time", Ring::leaving(0.5, 0.5));
  EXPECT_EQ(ring.winner(), "dead_time");
  EXPECT_TRUE(ring.twins().empty());
}

// Firmware's delay explains a hair more; but the readings are multiples of a pulse.
TEST(ContestTest, OfThoseThatLeaveTheSameTheOneWhoseMarkTheReadingsCarryWins) {
  Ring ring;
  ring.enter("sampling_delay", Ring::leaving(0.500, 0.500));
  ring.enter("hall_speed_estimator", Ring::leaving(0.502, 0.502));
  EXPECT_EQ(ring.winner(), "sampling_delay");
  Ring marked;
  marked.fake.mark = "hall_speed_estimator";
  marked.enter("sampling_delay", Ring::leaving(0.500, 0.500));
  marked.enter("hall_speed_estimator", Ring::leaving(0.502, 0.502));
  EXPECT_EQ(marked.winner(), "hall_speed_estimator");
  EXPECT_EQ(marked.twins(), std::vector<std::string>{"sampling_delay"});
  Ring far;
  far.fake.mark = "hall_speed_estimator";
  far.enter("sampling_delay", Ring::leaving(0.5, 0.5));
  far.enter("hall_speed_estimator", Ring::leaving(0.8, 0.8));
  EXPECT_EQ(far.winner(), "sampling_delay");
}

// Each explains another half of the record: which is the better one depends on the draw.
TEST(ContestTest, WhatSomeDrawsPreferIsATwin) {
  Ring ring;
  ring.enter("constant_load", Ring::leaving(0.50, 0.62));
  ring.enter("back_emf_missing", Ring::leaving(0.62, 0.51));
  EXPECT_EQ(ring.winner(), "constant_load");
  EXPECT_EQ(ring.twins(), std::vector<std::string>{"back_emf_missing"});
}

TEST(ContestTest, WhatLeavesTwiceAsMuchIsNoTwinWhateverTheDraws) {
  Ring ring;
  ring.enter("constant_load", Ring::leaving(0.10, 0.30));
  ring.enter("back_emf_missing", Ring::leaving(0.80, 0.09));
  EXPECT_EQ(ring.winner(), "constant_load");
  EXPECT_GT(ring.iteration.candidates[1].probability, 0.0);
  EXPECT_TRUE(ring.twins().empty());
}

TEST(ContestTest, NamesThreeThatCannotBeToldApartAndNoMore) {
  Ring ring;
  ring.fake.mark = "shaft_compliance";
  for (const char* name : {"cogging", "imbalance", "gravity_load", "dead_time", "shaft_compliance"})
    ring.enter(name, Ring::leaving(0.5, 0.5));
  EXPECT_EQ(ring.winner(), "shaft_compliance");
  EXPECT_EQ(ring.twins().size(), 2u);
}

TEST(ContestTest, WhatIsBelievedWinsWhereNothingGains) {
  Ring ring;
  ring.believe("payload", "robot.mass_kg");
  EXPECT_EQ(ring.winner(), "payload");
  EXPECT_EQ(ring.iteration.candidates.front().probability, 1.0);
  Ring beside;
  beside.believe("payload", "robot.mass_kg");
  beside.enter("dead_time", Ring::leaving(0.5, 0.5));
  EXPECT_EQ(beside.winner(), "dead_time");
  EXPECT_TRUE(beside.twins().empty());
}

// Each lets another base parameter come back: neither explains what the other does.
TEST(ContestTest, WhatIsBelievedForDifferentReasonsIsNoTwin) {
  Ring ring;
  ring.believe("payload", "robot.mass_kg");
  ring.believe("quadratic_drag", "motor.viscous_friction_Nm_s_per_rad");
  EXPECT_FALSE(ring.winner().empty());
  EXPECT_TRUE(ring.twins().empty());
  Ring same;
  same.believe("grease_drag", "motor.viscous_friction_Nm_s_per_rad");
  same.believe("quadratic_drag", "motor.viscous_friction_Nm_s_per_rad");
  EXPECT_FALSE(same.winner().empty());
  EXPECT_EQ(same.twins().size(), 1u);
}

}  // namespace
}  // namespace omnihil
