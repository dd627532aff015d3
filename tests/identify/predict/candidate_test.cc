// A candidate model: which parameters are unknowns, with which priors, and that its text reads back the same.
#include "identify/predict/candidate.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "hil/dataset/dataset_model.h"
#include "hil/loop/model_store.h"
#include "identify/predict/rig_values.h"
#include "sim/law/effect_registry.h"
#include "sim/model/axis_model.h"

namespace omnihil {
namespace {

constexpr const char* kAxis = R"x(
format = "omnihil-model/1"
rig = "axis"
[motor]
resistance_ohm = { value = 0.5, tolerance = 0.1, source = "sheet \"A\"" }
inductance_H = 0.0003
torque_constant_Nm_per_A = { value = 0.03, tolerance = 0.05 }
rotor_inertia_kg_m2 = { value = 1e-5, tolerance = 0.1 }
pole_pairs = 8
slots = 12
[supply]
voltage_V = 24
[effects.coulomb_friction]
torque_Nm = { value = 0.002, tolerance = 0.5 }
[effects.cogging]
amplitude_Nm = { value = 0.001, tolerance = 0.2 }
[effects.expression.drag]
adds_to = "torque_Nm"
formula = "-a*omega_rotor_rad_s*abs(omega_rotor_rad_s)"
a = { value = 2e-8, lower = 0, upper = 1e-6, unit = "N m s2/rad2" }
)x";

Candidate read(const std::string& text) {
  AxisReading r = read_axis_model(text, "model.toml", nullptr);
  for (const ModelProblem& p : r.problems) ADD_FAILURE() << p.text();
  return r.model ? candidate_of(r.model->file, r.model->effects) : Candidate{};
}

const Unknown* find(const std::vector<Unknown>& unknowns, std::string_view path) {
  const auto at =
      std::find_if(unknowns.begin(), unknowns.end(), [&](const auto& u) { return u.path == path; });
  return at == unknowns.end() ? nullptr : &*at;
}

TEST(Candidate, NumbersWithAToleranceAndStrengthsOfEffectsAreUnknown) {
  std::vector<std::string> paths;
  for (const Unknown& u : unknowns_of(read(kAxis))) paths.push_back(u.path);
  EXPECT_EQ(paths, (std::vector<std::string>{"motor.resistance_ohm", "motor.torque_constant_Nm_per_A",
                                             "motor.rotor_inertia_kg_m2", "cogging.amplitude_Nm",
                                             "cogging.phase_rad", "coulomb_friction.torque_Nm",
                                             "expression.drag.a"}));
}

TEST(Candidate, PriorIsTheTolerance) {
  const std::vector<Unknown> all = unknowns_of(read(kAxis));
  const Unknown* r = find(all, "motor.resistance_ohm");
  ASSERT_NE(r, nullptr);
  EXPECT_DOUBLE_EQ(r->prior_mean, 0.5);
  EXPECT_DOUBLE_EQ(r->prior_sigma, 0.5 * 0.1);
  const Unknown* c = find(all, "coulomb_friction.torque_Nm");
  ASSERT_NE(c, nullptr);
  EXPECT_DOUBLE_EQ(c->prior_mean, 0.002);
  EXPECT_DOUBLE_EQ(c->prior_sigma, 0.002 * 0.5);
  const std::vector<Unknown> added = unknowns_of(with_effect(read(kAxis), *find_effect("dead_time")));
  const Unknown* a = find(added, "dead_time.voltage_V");
  ASSERT_NE(a, nullptr);
  EXPECT_EQ(a->prior_mean, 0.0);
  EXPECT_EQ(a->prior_sigma, find_effect("dead_time")->info->params[0].prior_scale);
}

// "A bare number means known exactly": friction that was measured with the wheels lifted is none that a fit
// may move, or it hides what the floor takes.
TEST(Candidate, AStrengthWithoutAToleranceIsKnown) {
  std::string text(kAxis);
  for (const std::string given : {"{ value = 0.002, tolerance = 0.5 }", "{ value = 0.001, tolerance = 0.2 }"})
    text.replace(text.find(given), given.size(), "0.002");
  const Candidate bare = read(text);
  const std::vector<Unknown> all = unknowns_of(bare);
  EXPECT_EQ(find(all, "coulomb_friction.torque_Nm"), nullptr);
  EXPECT_EQ(find(all, "cogging.amplitude_Nm"), nullptr);
  EXPECT_EQ(find(all, "cogging.phase_rad"), nullptr);
  EXPECT_NE(find(all, "motor.resistance_ohm"), nullptr);
  EXPECT_NE(find(unknowns_of(read(candidate_text(bare))), "motor.resistance_ohm"), nullptr);
  EXPECT_EQ(find(unknowns_of(read(candidate_text(bare))), "cogging.amplitude_Nm"), nullptr);
}

TEST(Candidate, WhatASearchFoundIsFittedAgainFromItsFile) {
  Candidate c = with_effect(read(kAxis), *find_effect("dead_time"));
  ASSERT_EQ(set_value(c, "dead_time.voltage_V", 0.3), "");
  const std::vector<Unknown> again = unknowns_of(read(candidate_text(c)));
  ASSERT_NE(find(again, "dead_time.voltage_V"), nullptr);
  EXPECT_EQ(find(again, "dead_time.voltage_V")->start, 0.3);
  EXPECT_NE(find(again, "dead_time.current_width_A"), nullptr);
}

constexpr const char* kFittedAxis =
    "format = \"omnihil-model/1\"\nrig = \"axis\"\n[motor]\n"
    "resistance_ohm = { value = 0.55, sigma = 0.003, source = \"fitted\", data = \"sha256:0123456789ab\", "
    "date = \"2026-11-23\", believed = { value = 0.5, tolerance = 0.1, source = \"sheet \\\"A\\\"\" } }\n"
    "torque_constant_Nm_per_A = { value = 0.03, tolerance = 0.05, source = \"fitted\" }\n"
    "rotor_inertia_kg_m2 = 1e-5\n[supply]\nvoltage_V = 24\n[effects.cogging]\n"
    "amplitude_Nm = { value = 0.001, sigma = 2e-05, source = \"fitted\", data = \"sha256:0123456789ab\", "
    "date = \"2026-11-23\", believed = { value = 0, sigma = 0.002, source = \"usual size\" } }\n"
    "phase_rad = { value = 0.7, source = \"fitted\", date = \"2026-11-23\" }\n"
    "[effects.coulomb_friction]\ntorque_Nm = { value = 0.004, sigma = 1e-4, source = \"fitted\", "
    "believed = { value = 0.002, tolerance = 0.6, source = \"no-load current\" } }\n"
    "[effects.expression.drag]\nadds_to = \"torque_Nm\"\n"
    "formula = \"-a*omega_rotor_rad_s*abs(omega_rotor_rad_s)\"\n"
    "a = { value = 2e-8, lower = 0, upper = 1e-6, unit = \"N m s2/rad2\", sigma = 1e-9, "
    "source = \"fitted\", believed = { value = 1e-8, tolerance = 0.3 } }\n";

// A fit's prior is what was believed before any fit, and it starts where the last one ended.
TEST(Candidate, WhatWasFittedKeepsItsBelief) {
  const std::vector<Unknown> all = unknowns_of(read(kFittedAxis));
  struct Belief {
    const char* path;
    double start, mean, sigma;
    PriorForm form;
  };
  for (const Belief& b :
       {Belief{"motor.resistance_ohm", 0.55, 0.5, 0.05, PriorForm::kNormal},
        Belief{"motor.torque_constant_Nm_per_A", 0.03, 0.03, 0.0015, PriorForm::kNormal},
        Belief{"cogging.amplitude_Nm", 0.001, 0.0, 0.002, PriorForm::kNormal},
        Belief{"coulomb_friction.torque_Nm", 0.004, 0.002, 0.0012, PriorForm::kLogNormalAbove},
        Belief{"expression.drag.a", 2e-8, 1e-8, 3e-9, PriorForm::kNormal}}) {
    const Unknown* u = find(all, b.path);
    ASSERT_NE(u, nullptr) << b.path;
    EXPECT_DOUBLE_EQ(u->start, b.start) << b.path;
    EXPECT_DOUBLE_EQ(u->prior_mean, b.mean) << b.path;
    EXPECT_DOUBLE_EQ(u->prior_sigma, b.sigma) << b.path;
    EXPECT_EQ(u->prior_form, b.form) << b.path;
  }
  ASSERT_NE(find(all, "cogging.phase_rad"), nullptr);
  EXPECT_EQ(find(all, "cogging.phase_rad")->start, 0.7);
}

TEST(Candidate, WhatWasFittedReadsBackWithItsRecord) {
  const Candidate c = read(kFittedAxis);
  const std::string text = candidate_text(c);
  EXPECT_EQ(candidate_text(read(text)), text);
  for (
      const char* line :
      {"resistance_ohm = { value = 0.55, sigma = 0.003, source = \"fitted\", data = \"sha256:0123456789ab\", "
       "date = \"2026-11-23\", believed = { value = 0.5, tolerance = 0.1, source = \"sheet \\\"A\\\"\" } }\n",
       "torque_constant_Nm_per_A = { value = 0.03, tolerance = 0.05, source = \"fitted\" }\n",
       "believed = { value = 0, sigma = 0.002, source = \"usual size\" } }\n",
       "phase_rad = { value = 0.7, source = \"fitted\", date = \"2026-11-23\" }\n",
       "believed = { value = 0.002, tolerance = 0.6, source = \"no-load current\" } }\n",
       "sigma = 1e-09, source = \"fitted\", believed = { value = 1e-08, tolerance = 0.3 } }\n"}) {
    EXPECT_NE(text.find(line), std::string::npos) << line << text;
  }
}

TEST(Candidate, TextReadsBackWithTheSameNumbers) {
  Candidate c = read(kAxis);
  const std::vector<Unknown> unknowns = unknowns_of(c);
  std::vector<double> x;
  for (const Unknown& u : unknowns) x.push_back(u.start + 0.1234567890123 * u.scale);
  c = with_values(c, unknowns, x);
  const Candidate again = read(candidate_text(c));
  const std::vector<Unknown> back = unknowns_of(again);
  ASSERT_EQ(back.size(), unknowns.size());
  for (std::size_t i = 0; i < back.size(); ++i) {
    EXPECT_EQ(back[i].path, unknowns[i].path);
    EXPECT_EQ(back[i].start, x[i]) << back[i].path;
  }
  EXPECT_EQ(again.file.parameters.find("motor.resistance_ohm")->source, "sheet \"A\"");
  EXPECT_EQ(value_at(again, "motor.inductance_H"), 0.0003);
  EXPECT_EQ(value_at(again, "motor.pole_pairs"), 8.0);
  EXPECT_EQ(candidate_text(again), candidate_text(c));
}

TEST(Candidate, LinearAxisHasItsOwnNamesAndReadsBack) {
  const Candidate c = read(R"x(
format = "omnihil-model/1"
rig = "axis"
linear = true
[load]
mass_kg = { value = 95, tolerance = 0.1 }
[motor]
viscous_friction_N_s_per_m = { value = 200, tolerance = 1 }
[effects.coulomb_friction]
torque_N = { value = 20, tolerance = 0.5 }
[effects.friction_asymmetry]
viscous_ratio = 0.1
)x");
  const std::vector<Unknown> all = unknowns_of(c);
  ASSERT_NE(find(all, "load.mass_kg"), nullptr);
  const Unknown* f = find(all, "coulomb_friction.torque_N");
  ASSERT_NE(f, nullptr);
  EXPECT_EQ(f->unit, "N");
  EXPECT_EQ(drive_of(c).load_inertia_kg_m2, 95.0);
  const Candidate again = read(candidate_text(c));
  EXPECT_EQ(candidate_text(again), candidate_text(c));
  EXPECT_EQ(value_at(again, "friction_asymmetry.viscous_ratio"), 0.1);
}

TEST(Candidate, KnownNumbersOfARunReplaceBaseAndEffectNumbers) {
  const std::vector<std::pair<std::string, double>> known = {{"load.inertia_kg_m2", 6.1e-5},
                                                             {"drive.pwm_frequency_Hz", 200.0},
                                                             {"effects.cogging.amplitude_Nm", 0.004}};
  const Candidate c = with_known(read(kAxis), known);
  EXPECT_EQ(drive_of(c).load_inertia_kg_m2, 6.1e-5);
  EXPECT_EQ(drive_of(c).pwm_frequency_Hz, 200.0);
  EXPECT_EQ(value_at(c, "cogging.amplitude_Nm"), 0.004);
  Candidate d = read(kAxis);
  EXPECT_NE(set_value(d, "motor.resistence_ohm", 1.0), "");
  EXPECT_NE(set_value(d, "motor.resistance_ohm", -1.0), "");
  EXPECT_NE(set_value(d, "robot.mass_kg", 1.0), "");
  EXPECT_EQ(candidate_text(d), candidate_text(read(kAxis)));
}

TEST(Candidate, AnAddedEffectIsNeutralAndComesOffAgain) {
  const Candidate base = read(kAxis);
  const Candidate more = with_effect(base, *find_effect("dead_time"));
  EXPECT_TRUE(is_neutral(more.effects.back()));
  EXPECT_NE(find(unknowns_of(more), "dead_time.voltage_V"), nullptr);
  EXPECT_EQ(candidate_text(without_effect(more, "dead_time")), candidate_text(base));
  EXPECT_EQ(effect_name(without_effect(base, "cogging").effects.back()), "expression.drag");
}

TEST(Candidate, ARobotKeepsItsFrictionAndItsEffects) {
  StoredModel stored = load_robot_model("omni_default", {OMNIHIL_SOURCE_DIR "/models"});
  for (const ModelProblem& p : stored.problems) ADD_FAILURE() << p.text();
  ASSERT_TRUE(stored.model);
  Candidate c = with_effect(candidate_of(*stored.model), *find_effect("wheel_slip"));
  ASSERT_EQ(set_value(c, "wheel_slip.compliance_m_s", 0.07), "");
  ASSERT_EQ(set_value(c, "coulomb_friction.torque_Nm", 0.0031), "");
  note_fit(c, "coulomb_friction.torque_Nm", {.sigma = 1e-4, .date = "2026-11-23", .believed = 0.002});
  EXPECT_EQ(robot_of(c).motor.coulomb_friction_Nm, 0.0031);
  for (const std::string& text : {candidate_text(c), dataset_model_text(c.file)}) {
    const ModelReading r = read_model(text, "robot.toml", nullptr);
    for (const ModelProblem& p : r.problems) ADD_FAILURE() << p.text();
    ASSERT_TRUE(r.model && r.model->robot);
    EXPECT_EQ(r.model->robot->motor.coulomb_friction_Nm, 0.0031);
    if (text != dataset_model_text(c.file)) {  // that one is of the table, which only values reach
      EXPECT_EQ(find(unknowns_of(candidate_of(*r.model)), "coulomb_friction.torque_Nm")->prior_mean, 0.002);
    }
    ASSERT_NE(r.model->robot->effects, nullptr);
    EXPECT_EQ(value_at(candidate_of(*r.model), "wheel_slip.compliance_m_s"), 0.07);
  }
}

TEST(Candidate, ASimulationIsOfItsNumbersItsLawsItsRunAndItsUnknowns) {
  Candidate c;
  c.effects.push_back(typical_use(*find_effect("cogging")));
  const SimulatedNumbers cogging = simulated_numbers(c, 0);
  const std::vector<Unknown> unknowns = unknowns_of(c);
  EXPECT_EQ(simulated_numbers(Candidate(c), 0), cogging);
  EXPECT_NE(simulated_numbers(c, 1), cogging);
  EXPECT_NE(simulated_numbers(c, 0, unknowns), cogging);
  EXPECT_EQ(simulated_numbers(c, 0, unknowns), simulated_numbers(c, 0, unknowns));
  c.effects[0].values[0] *= 2.0;
  EXPECT_NE(simulated_numbers(c, 0), cogging);
  c.effects[0] = typical_use(*find_effect("battery_sag"));
  c.effects[0].values = typical_use(*find_effect("cogging")).values;
  EXPECT_NE(simulated_numbers(c, 0), cogging);
}

}  // namespace
}  // namespace omnihil
