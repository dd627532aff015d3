#include "identify/predict/torque_scale.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "sim/law/effect_registry.h"
#include "sim/law/param_range.h"
#include "tests/identify/simulated_bench.h"

namespace omnihil {
namespace {

// A run of one constant value of the drive's torque (or of what stands for it).
Dataset asked_for(const char* signal, double value, bool imposed = false) {
  Dataset dataset;
  dataset.channels.push_back({.signal = signal, .column = signal, .unit = "", .imposed = imposed});
  omnihil::Run run;
  for (int k = 0; k < 100; ++k) run.time_s.push_back(0.01 * k);
  run.signals[signal] = std::vector<double>(run.time_s.size(), value);
  dataset.runs.push_back(run);
  return dataset;
}

Candidate wheel_model() {
  BenchRecipe recipe;
  recipe.excitations = {Excitation::kSteps, Excitation::kSteps};
  recipe.duration_s = 0.5;
  return simulated_bench(recipe).nominal;
}

TEST(TorqueScale, IsTheRmsTorqueOverARobotsWheelsAndNeverLess) {
  const Candidate model = wheel_model();
  EXPECT_DOUBLE_EQ(torque_scale_of(asked_for("motor_torque", -30.0), model), 300.0);
  EXPECT_DOUBLE_EQ(torque_scale_of(asked_for("motor_torque", 0.02), model), 1.0);
  EXPECT_DOUBLE_EQ(torque_scale_of(asked_for("motor_torque", 1e6), model), kStrongestDrive);
  EXPECT_NEAR(torque_scale_of(asked_for("duty", 0.5), model), 0.0335 * 24.0 / 0.464 / 1.6, 1e-9);
  // 0.0335 N m/A of the model
  EXPECT_NEAR(torque_scale_of(asked_for("motor_current", 20.0, true), model), 0.0335 * 20.0 / 0.1, 1e-9);
  EXPECT_NEAR(torque_scale_of(asked_for("motor_current", 20.0, false), model), 1.083,
              1e-3);  // an answer, not asked for
}

// A hub wheel of 24 V, 0.3 ohm and 1 N m/A: 80 N m at standstill, fifty times a robot's wheel motor.
TEST(TorqueScale, OfADriveThatIsAskedForAVoltageIsItsTorqueAtStandstill) {
  Candidate hub = wheel_model();
  EXPECT_EQ(set_value(hub, "motor.resistance_ohm", 0.3), "");
  EXPECT_EQ(set_value(hub, "motor.torque_constant_Nm_per_A", 1.0), "");
  EXPECT_EQ(set_value(hub, "supply.voltage_V", 24.0), "");
  EXPECT_NEAR(torque_scale_of(asked_for("duty", 0.2), hub), 80.0 / 1.6, 1e-9);
  EXPECT_NEAR(torque_scale_of(asked_for("motor_voltage", -12.0), hub), 40.0 / 1.6, 1e-9);
}

TEST(TorqueScale, HeldOutRunsDoNotCount) {
  Dataset dataset = asked_for("motor_torque", 1.0);
  dataset.runs.push_back(dataset.runs.front());
  dataset.runs.back().split = Split::kValidation;
  for (double& v : dataset.runs.back().signals["motor_torque"]) v = 1e3;
  EXPECT_DOUBLE_EQ(torque_scale_of(dataset, wheel_model()), 10.0);
}

// Torques, and what is a torque per something, in proportion; speeds, ratios and a linear axis as they were.
TEST(TorqueScale, PriorAndBoundsOfATorqueGrowWithIt) {
  const auto prior_of = [](Candidate model, const char* effect, const char* path) {
    const std::vector<Unknown> all = unknowns_of(with_effect(model, *find_effect(effect)));
    const auto it = std::find_if(all.begin(), all.end(), [&](const Unknown& u) { return u.path == path; });
    EXPECT_NE(it, all.end()) << path;
    return *it;
  };
  Candidate model = wheel_model();
  model.torque_scale = 1.0;
  const Unknown before = prior_of(model, "gravity_load", "gravity_load.torque_Nm");
  const Unknown delay = prior_of(model, "actuator_delay", "actuator_delay.delay_s");
  model.torque_scale = 300.0;
  const Unknown after = prior_of(model, "gravity_load", "gravity_load.torque_Nm");
  EXPECT_DOUBLE_EQ(after.prior_sigma, 300.0 * before.prior_sigma);
  EXPECT_DOUBLE_EQ(after.upper, 300.0 * before.upper);
  EXPECT_DOUBLE_EQ(after.scale, 300.0 * before.scale);
  EXPECT_DOUBLE_EQ(prior_of(model, "actuator_delay", "actuator_delay.delay_s").prior_sigma,
                   delay.prior_sigma);
  const EffectParam& gravity = find_effect("gravity_load")->info->params[0];
  EXPECT_DOUBLE_EQ(param_range(gravity, true, 300.0).upper, param_range(gravity, true, 1.0).upper);
}

}  // namespace
}  // namespace omnihil
