// A fit recovers the parameters that a record was simulated with, states their uncertainty, and never ends
// above its parent.
#include "identify/estimate/fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "identify/select/refit.h"
#include "sim/bench/axis_sim.h"
#include "sim/drive/sensor_chain.h"
#include "sim/law/effect_registry.h"
#include "sim/model/axis_model.h"

namespace omnihil {
namespace {

Candidate model(const std::string& more = "") {
  const std::string text = R"x(
format = "omnihil-model/1"
rig = "axis"
[motor]
resistance_ohm = { value = 0.5, tolerance = 0.1 }
torque_constant_Nm_per_A = { value = 0.03, tolerance = 0.05 }
rotor_inertia_kg_m2 = { value = 1e-5, tolerance = 0.1 }
viscous_friction_Nm_s_per_rad = { value = 5e-6, tolerance = 1 }
pole_pairs = 8
slots = 12
[load]
inertia_kg_m2 = { value = 5e-5, tolerance = 0.2 }
[supply]
voltage_V = 24
[effects.coulomb_friction]
torque_Nm = { value = 0.003, tolerance = 0.5 }
)x" + more;
  AxisReading r = read_axis_model(text, "model.toml", nullptr);
  for (const ModelProblem& p : r.problems) ADD_FAILURE() << p.text();
  return r.model ? candidate_of(r.model->file, r.model->effects) : Candidate{};
}

Candidate changed(Candidate c, const std::vector<std::pair<std::string, double>>& values) {
  for (const auto& [path, value] : values) EXPECT_EQ(set_value(c, path, value), "");
  return c;
}

struct Bench {
  double size = 0.3;
  bool current = true;
  int runs = 1;
  std::size_t samples = 3000;
};

Dataset bench(const Candidate& truth, const Bench& b = {}) {
  Dataset d;
  d.channels = {{.signal = "duty", .column = "", .unit = "1"},
                {.signal = "encoder", .column = "", .unit = "counts", .counts_per_rev = 4096}};
  if (b.current) d.channels.push_back({.signal = "motor_current", .column = "", .unit = "A", .sigma = 0.03});
  for (int n = 0; n < b.runs; ++n) {
    omnihil::Run run;
    run.file = "run_" + std::to_string(n) + ".csv";
    AxisInput in;
    for (std::size_t k = 0; k < b.samples; ++k) {
      in.time_s.push_back(1e-3 * double(k));
      in.command.push_back(b.size * (double((k / (130 + 20 * std::size_t(n))) % 7) - 3.0) / 3.0);
    }
    in.encoder_counts_per_turn = 4096;
    run.time_s = in.time_s;
    run.signals["duty"] = in.command;
    std::size_t k = 0;
    for (const auto& s :
         run_axis<double>(drive_of(truth), EffectSet<double>(truth.effects), in, {.step_s = 50e-6})) {
      run.signals["encoder"].push_back(encoder_reading(s.encoder_counts));
      if (b.current) run.signals["motor_current"].push_back(noisy(s.motor_current_A, 0.03, 5, "i", k++));
    }
    d.runs.push_back(std::move(run));
  }
  return d;
}

const ParameterEstimate* find(const FitResult& r, std::string_view path) {
  const auto at =
      std::find_if(r.parameters.begin(), r.parameters.end(), [&](const auto& p) { return p.path == path; });
  return at == r.parameters.end() ? nullptr : &*at;
}

FitResult fitted(const Dataset& d, const Candidate& c, const FitOptions& options = {}) {
  const auto p = make_predictor(d, c, {});
  return fit(*p, c, unknowns_of(c), options);
}

TEST(Fit, GivesBackTheNumbersThatMadeTheRecord) {
  const Candidate nominal = model();
  const Candidate truth = changed(nominal, {{"motor.resistance_ohm", 0.46},
                                            {"motor.torque_constant_Nm_per_A", 0.0315},
                                            {"load.inertia_kg_m2", 6.1e-5},
                                            {"motor.viscous_friction_Nm_s_per_rad", 8e-6},
                                            {"coulomb_friction.torque_Nm", 0.0042}});
  const FitResult r = fitted(bench(truth), nominal);
  EXPECT_TRUE(r.converged);
  for (const auto& [path, share] :
       std::vector<std::pair<const char*, double>>{{"motor.resistance_ohm", 0.02},
                                                   {"motor.torque_constant_Nm_per_A", 0.01},
                                                   {"motor.viscous_friction_Nm_s_per_rad", 0.15},
                                                   {"coulomb_friction.torque_Nm", 0.1}}) {
    const ParameterEstimate* p = find(r, path);
    ASSERT_NE(p, nullptr) << path;
    const double expected = *value_at(truth, path);
    EXPECT_NEAR(p->value, expected, share * expected) << path;
    EXPECT_NEAR(p->value, expected, 5.0 * p->sigma) << path;
    EXPECT_LT(p->sigma, 0.2 * p->prior_sigma) << path;
  }
  // rotor and load turn as one: only their sum is known
  const double sum =
      *value_at(r.model, "motor.rotor_inertia_kg_m2") + *value_at(r.model, "load.inertia_kg_m2");
  EXPECT_NEAR(sum, 7.1e-5, 0.01 * 7.1e-5);
}

TEST(Fit, NamesWhatTradesAgainstWhat) {
  const FitResult r = fitted(bench(model()), model());
  const ParameterEstimate* rotor = find(r, "motor.rotor_inertia_kg_m2");
  ASSERT_NE(rotor, nullptr);
  EXPECT_FALSE(rotor->identifiable);
  EXPECT_NE(rotor->sentence.find("load.inertia_kg_m2"), std::string::npos) << rotor->sentence;
  EXPECT_TRUE(find(r, "motor.torque_constant_Nm_per_A")->identifiable);
}

TEST(Fit, WithoutCurrentOnlyRatiosAreKnownAndThePriorHoldsTheRest) {
  const FitResult r = fitted(bench(model(), {.current = false}), model());
  int unknown = 0;
  for (const ParameterEstimate& p : r.parameters) unknown += p.identifiable ? 0 : 1;
  EXPECT_GE(unknown, 2);
  EXPECT_NEAR(find(r, "motor.resistance_ohm")->value, 0.5, 0.05);
}

TEST(Fit, IsTheSameForAnyNumberOfJobs) {
  const Candidate truth = changed(model(), {{"motor.resistance_ohm", 0.55}});
  const Dataset d = bench(truth, {.runs = 3, .samples = 800});
  const FitResult one = fitted(d, model(), {.jobs = 1}), four = fitted(d, model(), {.jobs = 4});
  ASSERT_EQ(one.parameters.size(), four.parameters.size());
  for (std::size_t i = 0; i < one.parameters.size(); ++i) {
    EXPECT_EQ(one.parameters[i].value, four.parameters[i].value) << one.parameters[i].path;
    EXPECT_EQ(one.parameters[i].sigma, four.parameters[i].sigma);
  }
}

// Without a gear the data know the sum of the two inertias, and only the file its parts.
TEST(Fit, WalksToTheEndOfAValleyThatOnlyThePriorsKnow) {
  const Candidate nominal = model();
  const Dataset d = bench(nominal);
  const Candidate start =
      changed(nominal, {{"motor.rotor_inertia_kg_m2", 0.6e-5}, {"load.inertia_kg_m2", 5.4e-5}});
  const auto predictor = make_predictor(d, nominal, {});
  const FitResult r = fit(*predictor, start, unknowns_with_priors(start, nominal),
                          {.jobs = 1, .coarse = true, .finish_undamped = true});
  EXPECT_NEAR(find(r, "motor.rotor_inertia_kg_m2")->value, 1e-5, 0.02e-5);
  EXPECT_NEAR(find(r, "load.inertia_kg_m2")->value, 5e-5, 0.1e-5);
}

TEST(Fit, FindsAnEffectThatStartsAtNeutral) {
  // each with something that a gradient at neutral alone would miss: a phase, a limit, a delay
  for (const auto& [id, values] :
       std::vector<std::pair<std::string, std::vector<std::pair<std::string, double>>>>{
           {"imbalance", {{"imbalance.torque_Nm", 0.004}, {"imbalance.phase_rad", 2.5}}},
           {"current_limit", {{"current_limit.inverse_current_per_A", 0.2}}},
           {"actuator_delay", {{"actuator_delay.delay_s", 0.0043}}},
           {"dead_time", {{"dead_time.voltage_V", 0.3}}}}) {
    const Candidate start = with_effect(model(), *find_effect(id));
    const Candidate truth = changed(start, values);
    const FitResult r = fitted(bench(truth, {.size = id == "imbalance" ? 0.05 : 0.4}), start);
    const ParameterEstimate* p = find(r, values.front().first);
    ASSERT_NE(p, nullptr) << id;
    EXPECT_NEAR(std::abs(p->value), values.front().second, 0.1 * values.front().second) << id;
  }
}

TEST(Fit, AModelWithOneMoreEffectNeverEndsAboveItsParent) {
  const Dataset d = bench(changed(model(), {{"motor.resistance_ohm", 0.55}}));
  const FitResult parent = fitted(d, model());
  for (const char* id :
       {"stribeck_friction", "saturation", "battery_sag", "backlash", "friction_asymmetry"}) {
    const Candidate start = with_effect(parent.model, *find_effect(id));
    const auto p = make_predictor(d, start, {});
    if (!p->applies(*find_effect(id)).empty()) continue;
    const FitResult child = fit(*p, start, unknowns_of(start), {});
    EXPECT_LE(child.data_cost, (1.0 + 1e-9) * parent.data_cost) << id;
  }
}

TEST(Fit, AGlitchPullsWithBoundedForce) {
  Dataset clean = bench(model()), hit = clean;
  for (std::size_t k = 1500; k < 1503; ++k) hit.runs[0].signals["motor_current"][k] = 400.0;
  const FitResult a = fitted(clean, model()), b = fitted(hit, model());
  for (std::size_t i = 0; i < a.parameters.size(); ++i) {
    EXPECT_NEAR(a.parameters[i].value, b.parameters[i].value, 0.5 * a.parameters[i].prior_sigma)
        << a.parameters[i].path;
  }
}

TEST(Fit, AFrictionThatWouldBeNegativeIsASymptom) {
  // No friction at all in the record, and a constant load pushing along: the fit would like b < 0.
  Dataset d = bench(
      changed(model(), {{"coulomb_friction.torque_Nm", 0.0}, {"motor.viscous_friction_Nm_s_per_rad", 0.0}}));
  const FitResult r = fitted(d, model());
  const ParameterEstimate* c = find(r, "coulomb_friction.torque_Nm");
  ASSERT_NE(c, nullptr);
  EXPECT_LT(c->value, 2e-4);
}

// Duties of 0 and from 0.13 on: any band between does the same, so the prior takes it down to zero, past which there is another
// error (a drive that brakes at zero).
TEST(Fit, AStrengthThatThePriorAloneTakesToItsBoundIsNotUnphysical) {
  const Candidate truth = changed(with_effect(model(), *find_effect("pwm_dead_band")),
                                  {{"pwm_dead_band.duty", 0.05}}),
                  start = changed(truth, {{"pwm_dead_band.duty", 1e-8}});
  const FitResult r = fitted(bench(truth, {.size = 0.4}), start);
  const ParameterEstimate* p = find(r, "pwm_dead_band.duty");
  ASSERT_NE(p, nullptr);
  EXPECT_GT(p->value, 0.0);
  ASSERT_TRUE(p->at_bound) << "not the case that this test is about";
  EXPECT_FALSE(p->unphysical);
  EXPECT_NE(p->sentence.find("the same down to its bound"), std::string::npos) << p->value << p->sentence;
}

// A friction that falls with speed asks for less viscous friction than none: the others then find their least as if it were not
// an unknown, in as many steps.
TEST(Fit, AnUnknownPressedAgainstItsBoundDoesNotHoldUpTheOthers) {
  const Candidate truth = changed(with_effect(model(), *find_effect("stribeck_friction")),
                                  {{"stribeck_friction.extra_torque_Nm", 0.02},
                                   {"stribeck_friction.speed_rad_s", 150.0},
                                   {"motor.viscous_friction_Nm_s_per_rad", 0.0}});
  const Candidate start =
      changed(model(), {{"motor.viscous_friction_Nm_s_per_rad", 0.0}, {"coulomb_friction.torque_Nm", 0.006}});
  std::vector<Unknown> unknowns = unknowns_of(start);
  const auto predictor = make_predictor(bench(truth), start, {});
  const FitResult all = fit(*predictor, start, unknowns, {});
  ASSERT_TRUE(find(all, "motor.viscous_friction_Nm_s_per_rad")->at_bound);
  std::erase_if(unknowns, [](const Unknown& u) { return u.path == "motor.viscous_friction_Nm_s_per_rad"; });
  const FitResult others = fit(*predictor, start, unknowns, {});
  EXPECT_TRUE(all.converged);
  EXPECT_LE(all.iterations, others.iterations + 1);
  EXPECT_NEAR(all.cost, others.cost, 1e-3 * others.cost);
}

TEST(Fit, StopsWhenAsked) {
  int asked = 0;
  FitOptions options;
  options.stop = [&] { return ++asked > 2; };
  const FitResult r = fitted(bench(model()), model(), options);
  EXPECT_TRUE(r.stopped);
  EXPECT_EQ(r.parameters.size(), unknowns_of(model()).size());
}

TEST(Fit, RobustlyARunWithAnotherLoadHardlyBendsTheNumbersOfAll) {
  const Candidate truth = model();
  Dataset d = bench(truth, {.runs = 6});
  d.runs.back() = bench(changed(truth, {{"load.inertia_kg_m2", 7e-5}}), {.runs = 6}).runs.back();
  const auto predictor = make_predictor(d, truth, {});
  const auto inertia_error = [&](bool robust) {
    FitOptions options;
    options.robust = robust;
    const FitResult r = fit(*predictor, truth, unknowns_of(truth), options);
    // no gear: rotor and load turn together, 1e-5 and 5e-5
    return std::abs(value_at(r.model, "motor.rotor_inertia_kg_m2").value_or(NAN) +
                    value_at(r.model, "load.inertia_kg_m2").value_or(NAN) - 6e-5);
  };
  const double squared = inertia_error(false);
  EXPECT_GT(squared, 0.01 * 6e-5);
  EXPECT_LT(inertia_error(true), 0.5 * squared);
}

}  // namespace
}  // namespace omnihil
