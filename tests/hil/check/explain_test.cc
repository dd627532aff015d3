// Which change of the model explains a difference: planted in the recorded robot, found from another seed with noise.
#include <gtest/gtest.h>

#include <random>

#include "hil/check/explain_candidates.h"
#include "hil/check/explain_difference.h"
#include "hil/check/measured_series.h"
#include "hil/loop/effect_overrides.h"
#include "tests/hil/recording/real_run.h"

namespace omnihil {
namespace {

const RadioFormat& rem() { return *find_radio_format("roboteam-rem-v8"); }

// Two robots that change speed and direction every 0.6 s, with telemetry asked for.
Recording drive(const SessionSetup& setup, int milliseconds) {
  constexpr double kRho_m_s[] = {1.2, 0.4, 1.6, 0.2, 1.4, 0.8},
                   kTheta_rad[] = {0.0, 1.1, -2.0, 2.6, -0.7, 1.8};
  RecordingHeader header = recording_header(setup, "abc1234");
  header.sample_every = 10;
  Session session(session_config(setup), make_reference_firmware);
  RecordingMemory memory(header);
  session.set_observer(&memory);
  std::vector<std::uint8_t> host, out;
  for (int n = 0; n < milliseconds; ++n) {
    host.clear();
    const auto phase = static_cast<std::size_t>(n / 600) % std::size(kRho_m_s);
    for (const int id : setup.robot_ids) {
      if (n % 16 != 0) break;
      const auto turn = (phase + static_cast<std::size_t>(id)) % std::size(kTheta_rad);
      const real::Bytes command = real::frame(rem(), "REM_RobotCommand",
                                              {{"toRobotId", id},
                                               {"toColor", 1},
                                               {"fromPC", 1},
                                               {"sendStateInfo", 1},
                                               {"rho", kRho_m_s[phase]},
                                               {"theta", kTheta_rad[turn]}});
      host.insert(host.end(), command.begin(), command.end());
    }
    session.step(host, out);
  }
  return memory.take(session.now_ns());
}

SessionSetup robot() { return real::setup(real::kRem); }

// The planted robot: a constant of its motor's file, by the text that a user would change.
SessionSetup with_torque_constant(double factor) {
  SessionSetup setup = robot();
  for (const ExplainCandidate& candidate : explain_candidates(setup.model)) {
    if (candidate.name == "motor.torque_constant_Nm_per_A")
      setup.model = *candidate.model(factor * candidate.value);
  }
  return setup;
}

void add_noise(Recording& recording, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  const auto& columns = recording.header.columns;
  for (RecordedChunk& chunk : recording.chunks) {
    for (std::size_t i = 0; i < chunk.sample.size(); ++i) {
      if (columns[i].starts_with("motor_current_A")) chunk.sample[i] += 0.05 * normal(random);
      if (columns[i] == "gyro_z_rad_s") chunk.sample[i] += 0.02 * normal(random);
      if (columns[i].starts_with("accel_")) chunk.sample[i] += 0.3 * normal(random);
    }
  }
}

// As a robot on a field is checked: by the nominal model, with another seed.
DifferenceExplained explained(const Recording& recording) {
  ReplayOptions options;
  options.model = robot().model;
  options.seed = 77;
  return explain_difference(recording, rem(), options);
}

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
