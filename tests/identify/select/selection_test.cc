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

// One run to fit and one held out; candidates that leave shares of their energy.
struct SelectionFixture {
  MarkedPredictor fake;
  std::unique_ptr<FakeResiduals> residuals;
  SelectionTask task;
  Fitted parent;
  Iteration iteration;

  SelectionFixture() {
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

  void add_candidate(const std::string& effect, Fitted fitted) {
    CandidateEffect c;
    c.screened.entry = find_effect(effect);
    c.screened.name = effect;
    c.fitted = std::move(fitted);
    c.acceptance = test_acceptance(task.acceptance_context, parent, c.fitted, "x", 100.0);
    EXPECT_TRUE(c.acceptance.accepted()) << c.acceptance.why;
    iteration.candidates.push_back(std::move(c));
  }

  // Of no gain; a base parameter returns to its prior with it.
  void accept_by_prior(const std::string& effect, const std::string& base) {
    CandidateEffect c;
    c.screened.entry = find_effect(effect);
    c.screened.name = effect;
    c.screened.tried = true;
    c.screened.closest_parameter = base;
    c.fitted = leaving(1.0, 1.0);
    c.acceptance.accepted_by = AcceptedBy::kPrior;
    EXPECT_EQ(c.screened.aliased_parameter(), base);
    iteration.candidates.push_back(std::move(c));
  }

  std::string best() {
    select_best(task, parent, iteration);
    return iteration.chosen < 0
               ? ""
               : iteration.candidates[static_cast<std::size_t>(iteration.chosen)].screened.name;
  }

  std::vector<std::string> confounded() const {
    std::vector<std::string> names;
    for (const ConfoundedCandidate& c : iteration.confounded)
      names.push_back(iteration.candidates[static_cast<std::size_t>(c.index)].screened.name);
    return names;
  }
};

TEST(SelectionTest, TheCandidateOfLargestGainIsChosen) {
  SelectionFixture fixture;
  fixture.add_candidate("cogging", SelectionFixture::leaving(0.8, 0.8));
  fixture.add_candidate("dead_time", SelectionFixture::leaving(0.5, 0.5));
  EXPECT_EQ(fixture.best(), "dead_time");
  EXPECT_TRUE(fixture.confounded().empty());
}

// A delay gains 0.2 % more; but the readings are multiples of a pulse.
TEST(SelectionTest, OfEqualGainsTheOneWhoseQuantisationTheReadingsShowIsChosen) {
  SelectionFixture fixture;
  fixture.add_candidate("sampling_delay", SelectionFixture::leaving(0.500, 0.500));
  fixture.add_candidate("hall_speed_estimator", SelectionFixture::leaving(0.502, 0.502));
  EXPECT_EQ(fixture.best(), "sampling_delay");
  SelectionFixture marked;
  marked.fake.mark = "hall_speed_estimator";
  marked.add_candidate("sampling_delay", SelectionFixture::leaving(0.500, 0.500));
  marked.add_candidate("hall_speed_estimator", SelectionFixture::leaving(0.502, 0.502));
  EXPECT_EQ(marked.best(), "hall_speed_estimator");
  EXPECT_EQ(marked.confounded(), std::vector<std::string>{"sampling_delay"});
  EXPECT_NEAR(marked.iteration.confounded.front().remaining, 0.500 / 0.502, 0.02);
  SelectionFixture far;
  far.fake.mark = "hall_speed_estimator";
  far.add_candidate("sampling_delay", SelectionFixture::leaving(0.5, 0.5));
  far.add_candidate("hall_speed_estimator", SelectionFixture::leaving(0.8, 0.8));
  EXPECT_EQ(far.best(), "sampling_delay");
}

// Late readings gain as much; a law of the angle would be lost beside them.
TEST(SelectionTest, OfEqualGainsOneWithoutLateReadingsIsChosen) {
  SelectionFixture fixture;
  fixture.add_candidate("sampling_delay", SelectionFixture::leaving(0.5, 0.5));
  fixture.add_candidate("actuator_delay", SelectionFixture::leaving(0.501, 0.501));
  EXPECT_EQ(fixture.best(), "actuator_delay");
  SelectionFixture better;
  better.add_candidate("sampling_delay", SelectionFixture::leaving(0.5, 0.5));
  better.add_candidate("actuator_delay", SelectionFixture::leaving(0.7, 0.7));
  EXPECT_EQ(better.best(), "sampling_delay");
}

// Each explains another half of the record: which is the better one depends on the draw.
TEST(SelectionTest, ACandidateThatSomeDrawsSelectIsConfoundedWithTheBest) {
  SelectionFixture fixture;
  fixture.add_candidate("constant_load", SelectionFixture::leaving(0.50, 0.62));
  fixture.add_candidate("back_emf_missing", SelectionFixture::leaving(0.62, 0.51));
  EXPECT_EQ(fixture.best(), "constant_load");
  EXPECT_EQ(fixture.confounded(), std::vector<std::string>{"back_emf_missing"});
}

TEST(SelectionTest, ACandidateThatLeavesTwiceTheEnergyIsNotConfoundedWhateverTheDraws) {
  SelectionFixture fixture;
  fixture.add_candidate("constant_load", SelectionFixture::leaving(0.10, 0.30));
  fixture.add_candidate("back_emf_missing", SelectionFixture::leaving(0.80, 0.09));
  EXPECT_EQ(fixture.best(), "constant_load");
  EXPECT_GT(fixture.iteration.candidates[1].selection_frequency, 0.0);
  EXPECT_TRUE(fixture.confounded().empty());
}

TEST(SelectionTest, AConfoundedSetHasThreeMembersAtMost) {
  SelectionFixture fixture;
  fixture.fake.mark = "shaft_compliance";
  for (const char* name : {"cogging", "imbalance", "gravity_load", "dead_time", "shaft_compliance"})
    fixture.add_candidate(name, SelectionFixture::leaving(0.5, 0.5));
  EXPECT_EQ(fixture.best(), "shaft_compliance");
  EXPECT_EQ(fixture.confounded().size(), 2u);
}

TEST(SelectionTest, ACandidateAcceptedByItsPriorIsChosenWhereNothingGains) {
  SelectionFixture fixture;
  fixture.accept_by_prior("payload", "robot.mass_kg");
  EXPECT_EQ(fixture.best(), "payload");
  // it gains nothing, so no draw of the bootstrap selects it
  EXPECT_EQ(fixture.iteration.candidates.front().selection_frequency, 0.0);
  SelectionFixture beside;
  beside.accept_by_prior("payload", "robot.mass_kg");
  beside.add_candidate("dead_time", SelectionFixture::leaving(0.5, 0.5));
  EXPECT_EQ(beside.best(), "dead_time");
  EXPECT_TRUE(beside.confounded().empty());
}

// They restore different base parameters to their priors: neither is an alternative to the other.
TEST(SelectionTest, CandidatesThatRestoreDifferentParametersAreNotConfounded) {
  SelectionFixture fixture;
  fixture.accept_by_prior("payload", "robot.mass_kg");
  fixture.accept_by_prior("quadratic_drag", "motor.viscous_friction_Nm_s_per_rad");
  EXPECT_FALSE(fixture.best().empty());
  EXPECT_TRUE(fixture.confounded().empty());
  SelectionFixture same;
  same.accept_by_prior("grease_drag", "motor.viscous_friction_Nm_s_per_rad");
  same.accept_by_prior("quadratic_drag", "motor.viscous_friction_Nm_s_per_rad");
  EXPECT_FALSE(same.best().empty());
  EXPECT_EQ(same.confounded().size(), 1u);
}

// The selection frequency is a share of draws, whether or not a candidate passes the acceptance test.
TEST(SelectionTest, EqualCandidatesShareEveryDraw) {
  SelectionFixture fixture;
  fixture.add_candidate("cogging", SelectionFixture::leaving(0.5, 0.5));
  fixture.add_candidate("dead_time", SelectionFixture::leaving(0.5, 0.5));
  fixture.iteration.candidates[1].acceptance.accepted_by = AcceptedBy::kNone;
  EXPECT_EQ(fixture.best(), "cogging");
  for (const CandidateEffect& c : fixture.iteration.candidates)
    EXPECT_NEAR(c.selection_frequency, 0.5, 1e-9) << c.screened.name;
}

}  // namespace
}  // namespace omnihil
