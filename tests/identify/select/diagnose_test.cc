#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <nlohmann/json.hpp>
#include <numbers>

#include "hil/report/diagnosis_json.h"
#include "identify/select/add_effect.h"
#include "identify/select/diagnosis.h"
#include "sim/law/effect_registry.h"
#include "tests/identify/select/prepared_selection.h"
#include "tests/identify/simulated_bench.h"

namespace omnihil {
namespace {

// Steps to fit, steps drawn anew held out.
BenchRecipe steps_with(std::vector<std::string> hidden) {
  BenchRecipe recipe;
  recipe.with = std::move(hidden);
  recipe.excitations = {Excitation::kSteps, Excitation::kPrbs, Excitation::kSteps};
  recipe.duration_s = 2.5;
  return recipe;
}

Diagnosis diagnosed(const Bench& bench, int jobs = 1) {
  DiagnoseOptions options;
  options.jobs = jobs;
  return diagnose(bench.dataset, bench.nominal, options);
}

std::string reasons(const Diagnosis& d) {
  std::string out = d.unknown.sentence + "\n";
  for (const RankedEffect& r : d.ranking) out += r.effect + ": " + r.why + "\n";
  return out;
}

bool same_set(const Diagnosis& d, const std::string& a, const std::string& b) {
  return std::any_of(d.confounded.begin(), d.confounded.end(), [&](const ConfoundedSet& s) {
    return std::find(s.members.begin(), s.members.end(), a) != s.members.end() &&
           std::find(s.members.begin(), s.members.end(), b) != s.members.end();
  });
}

// Its impacts multiply up every exact derivative; the fit has to get through.
TEST(SlowDiagnoseTest, NamesPlay) {
  const Bench bench = simulated_bench(steps_with({"backlash.gap_rad=0.01"}));
  DiagnoseOptions options;
  options.jobs = 1;
  options.max_effects = 1;
  const Diagnosis d = diagnose(bench.dataset, bench.nominal, options);
  EXPECT_EQ(d.effects, std::vector<std::string>{"backlash"}) << reasons(d);
}

// Stiff against a heavy load, well damped: fifty times stiffer than the page's example.
TEST(SlowDiagnoseTest, NamesAStiffShaftBeforeAHeavyLoad) {
  BenchRecipe recipe = steps_with(
      {"shaft_compliance.compliance_rad_per_Nm=0.0068", "shaft_compliance.damping_Nm_s_per_rad=0.029"});
  recipe.excitations = {Excitation::kChirp, Excitation::kSteps, Excitation::kChirp};
  recipe.model = kWheelModel;
  const std::string light = "inertia_kg_m2 = { value = 4.6e-5", ratio = "ratio = 3.0";
  recipe.model.replace(recipe.model.find(light), light.size(), "inertia_kg_m2 = { value = 8e-4");
  recipe.model.replace(recipe.model.find(ratio), ratio.size(), "ratio = 10");
  const Diagnosis d = diagnosed(simulated_bench(recipe));
  EXPECT_EQ(d.effects, std::vector<std::string>{"shaft_compliance"}) << reasons(d);
}

// A long arm: 8 Hz, within what the drive does. Base parameters fitted without the spring hold the load for nothing, and no
// line leads back from there.
TEST(SlowDiagnoseTest, NamesASoftSpring) {
  BenchRecipe recipe = steps_with(
      {"shaft_compliance.compliance_rad_per_Nm=5.2", "shaft_compliance.damping_Nm_s_per_rad=3.8e-4"});
  recipe.excitations = {Excitation::kChirp, Excitation::kSteps, Excitation::kChirp};
  recipe.model = kWheelModel;
  const std::string light = "inertia_kg_m2 = { value = 4.6e-5";
  recipe.model.replace(recipe.model.find(light), light.size(), "inertia_kg_m2 = { value = 2e-4");
  const Diagnosis d = diagnosed(simulated_bench(recipe));
  EXPECT_EQ(d.effects, std::vector<std::string>{"shaft_compliance"}) << reasons(d);
}

// The duty reaches 0.6, the limit stands at 0.585: no smaller cut changes anything.
TEST(SlowDiagnoseTest, NamesALimitThatIsHardlyReached) {
  const Diagnosis d = diagnosed(simulated_bench(steps_with({"duty_limit.cut=0.415"})));
  ASSERT_EQ(d.effects, std::vector<std::string>{"duty_limit"}) << reasons(d);
  EXPECT_NEAR(value_at(d.final_fit.model, "duty_limit.cut").value_or(0.0), 0.415, 0.002);
}

// No course of any signal changes in the mean: it shows in where the record is loud.
TEST(SlowDiagnoseTest, NamesJitterByItsNoiseAndMeasuresIt) {
  const Diagnosis d = diagnosed(simulated_bench(steps_with({"sample_jitter.sigma_s=5e-6"})));
  ASSERT_EQ(d.effects, std::vector<std::string>{"sample_jitter"}) << reasons(d);
  EXPECT_EQ(d.verdict, Verdict::kEffect);
  EXPECT_NEAR(value_at(d.final_fit.model, "sample_jitter.sigma_s").value_or(0.0), 5e-6, 0.5e-6);
}

TEST(SlowDiagnoseTest, NamesNothingWhereNothingIsMissing) {
  const Diagnosis d = diagnosed(simulated_bench(steps_with({})));
  EXPECT_EQ(d.verdict, Verdict::kAdequate) << reasons(d);
  EXPECT_TRUE(d.effects.empty());
  EXPECT_TRUE(d.complete);
}

TEST(SlowDiagnoseTest, NamesCoggingThatIsNoPureSine) {
  // order 48 and its double: the model begins with one sine
  const Diagnosis d = diagnosed(simulated_bench(
      steps_with({"cogging.amplitude_Nm=0.008", "cogging.amplitude_2=0.003", "cogging.phase_2=1"})));
  ASSERT_FALSE(d.effects.empty()) << reasons(d);
  EXPECT_EQ(d.effects.front(), "cogging");
  const double before = d.baseline_comparison.error(Split::kValidation, "velocity")->rmse;
  EXPECT_LT(d.final_comparison.error(Split::kValidation, "velocity")->rmse, before);
}

TEST(SlowDiagnoseTest, AnswersTwinsAsASet) {
  // With the command as the only reference a late command and a late measurement are the same.
  const Diagnosis d = diagnosed(simulated_bench(steps_with({"actuator_delay.delay_s=0.004"})));
  ASSERT_FALSE(d.effects.empty()) << reasons(d);
  const bool either = d.effects.front() == "actuator_delay" || d.effects.front() == "sampling_delay";
  EXPECT_TRUE(either) << d.effects.front();
  EXPECT_TRUE(d.effects.front() == "actuator_delay" || same_set(d, "actuator_delay", "sampling_delay"));
  EXPECT_FALSE(d.next_experiment.what.empty());
}

TEST(SlowDiagnoseTest, TheSameAtAnyNumberOfThreads) {
  const Bench bench = simulated_bench(steps_with({"coulomb_friction.torque_Nm=0.02"}));
  EXPECT_EQ(diagnosis_json(diagnosed(bench, 1), {}), diagnosis_json(diagnosed(bench, 2), {}));
}

TEST(SlowDiagnoseTest, SelectionFrequenciesNeverSumToMoreThanOne) {
  const Bench bench = simulated_bench(steps_with({"battery_sag.resistance_ohm=0.1"}));
  DiagnoseOptions options;
  options.jobs = 1;
  options.max_effects = 1;  // the ranking is that of the first round
  const Diagnosis d = diagnose(bench.dataset, bench.nominal, options);
  double sum = 0.0;
  for (const RankedEffect& r : d.ranking) {
    EXPECT_GE(r.selection_frequency, 0.0) << r.effect;
    sum += r.selection_frequency;
  }
  EXPECT_LE(sum, 1.0 + 1e-9);
}

TEST(SlowDiagnoseTest, NeverNamesAerodynamicDrag) {
  const Diagnosis d = diagnosed(simulated_bench(steps_with({})));
  for (const RankedEffect& r : d.ranking) EXPECT_EQ(r.effect.find("aero"), std::string::npos);
}

// The search ends where what is left is what an adequate model leaves: no law is bent to the noise.
TEST(SlowDiagnoseTest, NamesNoSecondEffectWhereOneIsHidden) {
  const Diagnosis d = diagnosed(simulated_bench(steps_with({"cogging.amplitude_Nm=0.008"})));
  EXPECT_EQ(d.effects, std::vector<std::string>{"cogging"}) << reasons(d);
  EXPECT_EQ(d.ladder.size(), 3u);  // nominal, base refitted, cogging
}

// Of the first residual the smaller one is a few per cent; of what the larger leaves, most.
TEST(SlowDiagnoseTest, AMaskedEffectIsNamedOnceTheLargerOneIsIn) {
  const Diagnosis d =
      diagnosed(simulated_bench(steps_with({"constant_load.torque_Nm=0.05", "cogging.amplitude_Nm=0.008"})));
  ASSERT_GE(d.effects.size(), 2u) << reasons(d);
  EXPECT_EQ(d.effects[0], "constant_load");
  EXPECT_EQ(d.effects[1], "cogging");
}

// Slow ramps say nothing of the inductance: adding an effect must not move it, or a faster extrapolation run
// vetoes what the others show.
TEST(SlowDiagnoseTest, WhatTheDataDoNotDetermineStaysWhereItWas) {
  BenchRecipe recipe;
  recipe.with = {"quadratic_drag.coefficient_Nm_s2_per_rad2=2e-7"};
  recipe.excitations = {Excitation::kRamp, Excitation::kRamp};
  recipe.duration_s = 6.0;
  const Bench bench = simulated_bench(recipe);
  const PreparedSelection work(bench.dataset, bench.nominal, {});
  const Iteration iteration = selection_iteration(work.task, work.context.base());
  const std::string inductance = "motor.inductance_H";
  int undetermined = 0;
  for (const CandidateEffect& c : iteration.candidates) {
    for (const ParameterEstimate& p : c.fitted.fit.parameters) {
      if (p.path != inductance || p.identifiable || !p.correlated_with.empty()) continue;
      ++undetermined;
      EXPECT_EQ(value_at(c.fitted.fit.model, inductance), value_at(work.context.base().fit.model, inductance))
          << c.screened.name;
    }
  }
  EXPECT_GT(undetermined, 0);
}

// Friction that differs by direction is symmetric friction and a constant load: in one posture the same.
TEST(SlowDiagnoseTest, AsymmetryAndAConstantLoadAreASet) {
  const Diagnosis d = diagnosed(simulated_bench(steps_with({"friction_asymmetry.coulomb_ratio=0.5"})));
  ASSERT_FALSE(d.effects.empty()) << reasons(d);
  const bool either = d.effects.front() == "friction_asymmetry" || d.effects.front() == "constant_load";
  EXPECT_TRUE(either) << d.effects.front();
  EXPECT_TRUE(same_set(d, "friction_asymmetry", "constant_load")) << reasons(d);
}

TEST(SlowDiagnoseTest, AStopIsHeardInsideTheBaseFit) {
  const Bench bench = simulated_bench(steps_with({"cogging.amplitude_Nm=0.008"}));
  DiagnoseOptions options;
  std::atomic<int> asked{0};
  options.stop = [&] { return ++asked > 2; };
  const Diagnosis d = diagnose(bench.dataset, bench.nominal, options);
  EXPECT_FALSE(d.complete);
  EXPECT_TRUE(d.effects.empty());
  EXPECT_LT(asked.load(), 20);
}

TEST(SlowDiagnoseTest, SaysWhatItKnowsWhenItIsStopped) {
  const Bench bench = simulated_bench(steps_with({"cogging.amplitude_Nm=0.008"}));
  DiagnoseOptions options;
  options.progress = [](const Progress& p) { return p.share < 0.2; };
  const Diagnosis d = diagnose(bench.dataset, bench.nominal, options);
  EXPECT_FALSE(d.complete);
  EXPECT_FALSE(d.baseline.parameters.empty());
  EXPECT_EQ(nlohmann::json::parse(diagnosis_json(d, {}))["complete"], false);
}

TEST(SlowDiagnoseTest, ItsJsonHasTheKeysOfTheFormat) {
  const Diagnosis d = diagnosed(simulated_bench(steps_with({"cogging.amplitude_Nm=0.008"})));
  const nlohmann::json j = nlohmann::json::parse(diagnosis_json(d, {.elapsed_s = 1.5, .model = "m.toml"}));
  EXPECT_EQ(j["format"], "omnihil-diagnosis/1");
  for (const char* key : {"dataset", "seed", "elapsed_s", "signals", "baseline", "verdict", "effects",
                          "ranking", "indistinguishable", "where", "next_experiment", "final"}) {
    EXPECT_TRUE(j.contains(key)) << key;
  }
  EXPECT_TRUE(j["baseline"]["fit"]["velocity"]["rmse"].is_number());
  EXPECT_TRUE(j["ranking"][0]["parameters"].is_object());
  EXPECT_EQ(j["final"]["model"], "m.toml");
}

TEST(SlowDiagnoseTest, FittedErrorsNeverRiseAlongTheLadder) {
  const Diagnosis d = diagnosed(simulated_bench(steps_with({"cogging.amplitude_Nm=0.008"})));
  for (std::size_t n = 1; n < d.ladder.size(); ++n) {
    if (d.ladder[n].added.starts_with("removed")) continue;
    // whitened, all signals, as the fit weighs them
    EXPECT_LE(d.ladder[n].comparison.pooled(Split::kTraining),
              d.ladder[n - 1].comparison.pooled(Split::kTraining) * 1.01)
        << d.ladder[n].added;
  }
}

TEST(SlowAddEffectTest, RefusesWhatMakesNoDifference) {
  const Bench bench = simulated_bench(steps_with({}));
  const Addition a =
      add_effect(bench.dataset, bench.nominal, neutral_use(*find_effect("quadratic_drag")), {});
  EXPECT_TRUE(a.applies);
  EXPECT_FALSE(a.useful);
  EXPECT_FALSE(a.why.empty());
}

TEST(SlowAddEffectTest, TakesWhatIsThere) {
  const Bench bench = simulated_bench(steps_with({"cogging.amplitude_Nm=0.008"}));
  const Addition a = add_effect(bench.dataset, bench.nominal, neutral_use(*find_effect("cogging")), {});
  EXPECT_TRUE(a.useful) << a.why;
  EXPECT_LT(a.after.error(Split::kValidation, "velocity")->rmse,
            a.before.error(Split::kValidation, "velocity")->rmse);
}

// Speeds every quarter of a second in place of counts: from one row to the next the model's angle is lost.
void keep_speeds_alone(Dataset& d) {
  constexpr std::size_t kApart = 250, kSpan = 10;  // rows of a millisecond
  constexpr double kGear = 3.0;                    // of kWheelModel
  const double rad_per_count = 2.0 * std::numbers::pi / d.channel("encoder")->counts_per_rev / kGear;
  for (Run& run : d.runs) {
    Run kept = run;
    kept.time_s.clear();
    for (auto& [name, values] : kept.signals) values.clear();
    std::vector<double> speed;
    const std::vector<double>& counts = *run.signal("encoder");
    for (std::size_t k = kSpan; k < run.time_s.size(); k += kApart) {
      kept.time_s.push_back(run.time_s[k]);
      for (auto& [name, values] : kept.signals) values.push_back((*run.signal(name))[k]);
      speed.push_back((counts[k] - counts[k - kSpan]) * rad_per_count /
                      (run.time_s[k] - run.time_s[k - kSpan]));
    }
    kept.signals.erase("encoder");
    kept.signals["velocity"] = speed;
    run = std::move(kept);
  }
  Channel& encoder = *std::find_if(d.channels.begin(), d.channels.end(),
                                   [](const Channel& c) { return c.signal == "encoder"; });
  encoder = {.signal = "velocity", .column = "velocity", .unit = "rad/s"};
}

TEST(SlowAddEffectTest, TakesNoLawOfAnAngleThatIsLost) {
  Bench bench = simulated_bench(steps_with({"quadratic_drag.coefficient_Nm_s2_per_rad2=1e-7"}));
  keep_speeds_alone(bench.dataset);
  const Addition a = add_effect(bench.dataset, bench.nominal, neutral_use(*find_effect("cogging")), {});
  EXPECT_TRUE(a.applies);
  EXPECT_FALSE(a.useful);
  EXPECT_NE(a.why.find("no sensor reports the angle"), std::string::npos) << a.why;
}

TEST(SlowAddEffectTest, SaysWhyAnEffectCannotAct) {
  const Bench bench = simulated_bench(steps_with({}));
  const Addition a = add_effect(bench.dataset, bench.nominal, neutral_use(*find_effect("wheel_slip")), {});
  EXPECT_FALSE(a.applies);
  EXPECT_FALSE(a.why.empty());
}

}  // namespace
}  // namespace omnihil
