// Which change of the model explains a difference: planted in the recorded robot, found from another seed with noise.
#include <gtest/gtest.h>

#include "hil/check/explain_candidates.h"
#include "hil/check/explain_difference.h"
#include "hil/check/measured_series.h"
#include "hil/loop/effect_overrides.h"
#include "tests/hil/check/driven_robots.h"

namespace omnihil {
namespace {

using driven::add_noise, driven::drive, driven::explained, driven::rem, driven::robot,
    driven::with_torque_constant;

TEST(ExplainDifference, FindsATorqueConstantFivePercentOff) {
  Recording recording = drive(with_torque_constant(1.05), 4000);
  add_noise(recording, 1);
  const DifferenceExplained all = explained(recording);
  ASSERT_FALSE(all.found.empty()) << all.headline;
  const ExplainedBy& best = all.found.front();
  EXPECT_EQ(best.name, "motor.torque_constant_Nm_per_A") << explained_text(all);
  EXPECT_NEAR(best.is / best.was, 1.05, 0.015) << explained_text(all);
  EXPECT_LT(best.sigma, 0.02 * best.was);
  EXPECT_TRUE(all.headline.starts_with("found: ")) << all.headline;
  EXPECT_TRUE(all.second.empty()) << explained_text(all);  // there is but one
}

TEST(ExplainDifference, FindsNothingInNoise) {
  for (const std::uint64_t seed : {1, 2}) {
    Recording recording = drive(robot(), 3000);
    add_noise(recording, seed);
    const DifferenceExplained all = explained(recording);
    EXPECT_TRUE(all.found.empty()) << explained_text(all);
    EXPECT_TRUE(all.headline.starts_with("nothing found")) << all.headline;
    EXPECT_LT(all.error_over_noise, 1.5);
  }
}

TEST(ExplainDifference, FindsAnEffectAndItsSize) {
  SessionSetup setup = robot();
  std::vector<std::string> faults;
  add_effects(setup.model, {"battery_sag.resistance_ohm=0.15"}, faults);
  ASSERT_TRUE(faults.empty());
  const DifferenceExplained all = explained(drive(setup, 4000));
  ASSERT_FALSE(all.found.empty()) << all.headline;
  EXPECT_EQ(all.found.front().name, "battery_sag.resistance_ohm") << explained_text(all);
  EXPECT_NEAR(all.found.front().is, 0.15, 0.03);
}

TEST(ExplainDifference, TelemetryAloneIsEnoughForAHeavierRobot) {
  SessionSetup setup = robot();
  for (const ExplainCandidate& candidate : explain_candidates(setup.model)) {
    if (candidate.name == "robot.mass_kg") setup.model = *candidate.model(1.15 * candidate.value);
  }
  Recording recording = drive(setup, 4000);
  std::erase_if(recording.chunks,
                [](const auto& chunk) { return chunk.kind == RecordedChunk::Kind::kSample; });
  ASSERT_EQ(measured_by(recording), MeasuredBy::kTelemetry);
  const DifferenceExplained all = explained(recording);
  ASSERT_FALSE(all.found.empty()) << all.headline;
  bool named = false;
  for (const ExplainedBy& by : all.found)
    named = named || by.name == "robot.mass_kg" || by.name == "payload.mass_kg";
  EXPECT_TRUE(named) << explained_text(all);
}

TEST(ExplainCandidates, AreTheUncertainNumbersAndTheCataloguesEffects) {
  const ModelBundle model = robot().model;
  std::size_t parameters = 0, effects = 0;
  for (const ExplainCandidate& c : explain_candidates(model)) {
    (c.is_effect ? effects : parameters) += 1;
    const auto at_value = c.model(c.to);
    ASSERT_TRUE(at_value) << c.name;
    EXPECT_TRUE(read_bundle(*at_value).model) << c.name;
  }
  EXPECT_GT(parameters, 15U);
  EXPECT_GT(effects, 30U);
}

// A parameter written back at its own value is the same robot to the last bit: nothing of the text is lost.
TEST(ExplainCandidates, TheSameValueIsTheSameRobot) {
  const SessionSetup setup = robot();
  const Recording recording = drive(setup, 700);
  const std::string before = run_again(recording, {}).sha256;
  for (const ExplainCandidate& c : explain_candidates(setup.model)) {
    if (c.is_effect) continue;
    ReplayOptions options;
    options.model = c.model(c.value);
    EXPECT_EQ(run_again(recording, options).sha256, before) << c.name;
  }
}

}  // namespace
}  // namespace omnihil
