// The run that is proposed tells models apart that the usual run does not.
#include "identify/design/experiment.h"

#include <algorithm>
#include <cmath>

#include "sim/bench/excitation.h"
#include "tests/identify/simulated_robot.h"

namespace omnihil::test {
namespace {

constexpr const char* kAxisModel = R"(
format = "omnihil-model/1"
rig = "axis"
[motor]
resistance_ohm = { value = 0.464, tolerance = 0.10 }
inductance_H = 0.0003
torque_constant_Nm_per_A = { value = 0.0335, tolerance = 0.05 }
pole_pairs = 8
slots = 12
rotor_inertia_kg_m2 = { value = 1.35e-5, tolerance = 0.1 }
viscous_friction_Nm_s_per_rad = { value = 4e-6, tolerance = 1.0 }
[load]
inertia_kg_m2 = 4.6e-5
[supply]
voltage_V = { value = 24.0, tolerance = 0.01 }
[effects.coulomb_friction]
torque_Nm = { value = 2.5e-3, tolerance = 0.5 }
)";

Candidate axis_candidate() {
  const ModelReading reading = read_model(kAxisModel, "model.toml", nullptr);
  for (const ModelProblem& p : reading.problems) ADD_FAILURE() << p.text();
  return candidate_of(*reading.model);
}

// A drive that was run in one direction only: duty at a bias with some steps on top.
Dataset one_way_axis(double bias, double swing, double current_sigma_A, const Candidate& truth) {
  Dataset d;
  Run run;
  run.file = "one_way.csv";
  d.channels = {{.signal = "duty", .column = "duty", .unit = "1"},
                {.signal = "motor_current", .column = "i", .unit = "A", .sigma = current_sigma_A},
                {.signal = "encoder", .column = "ticks", .unit = "counts", .counts_per_rev = 4096.0}};
  for (int k = 0; k < 4000; ++k) {
    const double t = 1e-3 * k;
    run.time_s.push_back(t);
    run.signals["duty"].push_back(bias + swing * excitation_at(Excitation::kSteps, t, {.duration_s = 4.0}));
    run.signals["motor_current"].push_back(0.0);
    run.signals["encoder"].push_back(0.0);
  }
  d.runs = {run};
  return measured(d, *make_predictor(d, truth, {})->simulated(truth, 3));
}

Candidate with(Candidate c, const std::string& id, const std::vector<double>& values) {
  c = with_effect(c, *find_effect(id));
  c.effects.back().values = values;
  return c;
}

ExperimentOptions options(double duration_s) {
  ExperimentOptions o;
  o.limits.duration_s = duration_s;
  o.jobs = 2;
  return o;
}

// Above a rotor's Stribeck speed its friction is a Coulomb friction of another size.
TEST(Experiment, StribeckIsToldFromCoulombBySlowTurning) {
  const Candidate base = axis_candidate();
  const std::vector<Rival> rivals = {{"stribeck_friction", with(base, "stribeck_friction", {1e-5, 4.0, 2.0})},
                                     {"base", base}};
  const Dataset fast = one_way_axis(0.5, 0.1, 0.5, rivals[0].model);
  const ExperimentPlan plan = plan_experiment(fast, rivals, {}, options(8.0));
  ASSERT_TRUE(plan.run) << plan.problem;
  EXPECT_LT(plan.given_sigmas, 2.0);
  EXPECT_GE(plan.expected_sigmas, 5.0) << plan.next.what;
  EXPECT_LT(plan.generic_sigmas, 2.0) << plan.next.what;
}

// A small cogging is gone in the rush of full steps; turning slowly shows it.
TEST(Experiment, CoggingShowsWhereTheUsualStepsHideIt) {
  const Candidate base = axis_candidate();
  Candidate cogging = with_effect(base, *find_effect("cogging"));
  const DriveParams<double> drive = drive_of(base);
  cogging.effects.back() = typical_use(*find_effect("cogging"), &drive);
  cogging.effects.back().values[0] = 4e-4;  // N m
  const std::vector<Rival> rivals = {{"cogging", cogging}, {"base", base}};
  const ExperimentPlan plan =
      plan_experiment(one_way_axis(0.85, 0.1, 0.05, cogging), rivals, {}, options(8.0));
  ASSERT_TRUE(plan.run) << plan.problem;
  EXPECT_LT(plan.given_sigmas, 2.0) << plan.next.what;
  EXPECT_LT(plan.generic_sigmas, 2.0) << plan.next.what;
  EXPECT_GE(plan.expected_sigmas, 5.0) << plan.next.what;
}

// A warm winding and a weak battery both take voltage under load; how long the load lasts tells them apart.
TEST(Experiment, HeatIsToldFromASaggingBatteryByLoad) {
  const Candidate base = axis_candidate();
  const std::vector<Rival> rivals = {
      {"winding_heating", with(base, "winding_heating", {0.00393, 3.96, 2.9, 0.0, 44.0})},
      {"battery_sag", with(base, "battery_sag", {0.001})}};
  ExperimentOptions o = options(20.0);
  o.limits.current_A = 15.0;
  const ExperimentPlan plan = plan_experiment(one_way_axis(0.08, 0.0, 0.5, base), rivals, {}, o);
  ASSERT_TRUE(plan.run) << plan.problem;
  EXPECT_LT(plan.given_sigmas, 2.0) << plan.next.what;
  EXPECT_GE(plan.expected_sigmas, 5.0) << plan.next.what;
  EXPECT_LE(plan.largest_current_A, 15.0);
}

// Limits are simulated: no run that is proposed passes them, and what does is refused by name.
TEST(Experiment, LimitsHoldInTheProposedRun) {
  const Candidate base = axis_candidate();
  const std::vector<Rival> rivals = {{"quadratic_drag", with(base, "quadratic_drag", {2e-8})},
                                     {"base", base}};
  ExperimentOptions o = options(3.0);
  o.coarse = true;
  o.limits.speed_rad_s = 150.0;
  o.limits.current_A = 8.0;
  const ExperimentPlan plan = plan_experiment(one_way_axis(0.2, 0.1, 0.05, base), rivals, {}, o);
  ASSERT_TRUE(plan.run) << plan.problem;
  EXPECT_LE(plan.largest_speed_rad_s, 150.0);
  EXPECT_LE(plan.largest_current_A, 8.0);
  const bool refused = std::any_of(plan.tried.begin(), plan.tried.end(), [](const TriedRun& t) {
    return t.refused.find("allowed are") != std::string::npos;
  });
  EXPECT_TRUE(refused);
}

TEST(Experiment, NoRunWithinImpossibleLimitsSaysWhichLimit) {
  const Candidate base = axis_candidate();
  const std::vector<Rival> rivals = {{"quadratic_drag", with(base, "quadratic_drag", {2e-8})},
                                     {"base", base}};
  ExperimentOptions o = options(2.0);
  o.coarse = true;
  o.limits.travel = 1e-6;
  const ExperimentPlan plan = plan_experiment(one_way_axis(0.2, 0.1, 0.05, base), rivals, {}, o);
  EXPECT_FALSE(plan.run);
  EXPECT_NE(plan.problem.find("from the start"), std::string::npos) << plan.problem;
}

TEST(Experiment, ANumberIsKnownBetterAfterwards) {
  const Candidate base = axis_candidate();
  ExperimentOptions o = options(4.0);
  o.coarse = true;
  const ExperimentPlan plan = plan_experiment(one_way_axis(0.5, 0.05, 0.5, base), {{"base", base}},
                                              {.shrink = "coulomb_friction.torque_Nm"}, o);
  ASSERT_TRUE(plan.run) << plan.problem;
  EXPECT_LT(plan.sigma_after, 0.5 * plan.sigma_before) << plan.next.what;
}

TEST(Experiment, TheSameForAnyNumberOfThreads) {
  const Candidate base = axis_candidate();
  const std::vector<Rival> rivals = {{"quadratic_drag", with(base, "quadratic_drag", {2e-8})},
                                     {"base", base}};
  ExperimentOptions one = options(1.0), many = options(1.0);
  one.coarse = many.coarse = true;
  one.jobs = 1;
  many.jobs = 3;
  const ExperimentPlan a = plan_experiment(one_way_axis(0.2, 0.1, 0.05, base), rivals, {}, one);
  const ExperimentPlan b = plan_experiment(one_way_axis(0.2, 0.1, 0.05, base), rivals, {}, many);
  EXPECT_EQ(a.next.what, b.next.what);
  EXPECT_EQ(a.expected_sigmas, b.expected_sigmas);
}

// A bench that imposes the motion and tells the torque: fast one-way sines, where Stribeck's curve is flat.
Dataset imposed_axis(const Candidate& truth) {
  Dataset d;
  Run run;
  run.file = "imposed.csv";
  d.channels = {{.signal = "motor_torque", .column = "tau", .unit = "N m", .sigma = 5e-4},
                {.signal = "position", .column = "x", .unit = "rad", .sigma = 1e-6}};
  for (int k = 0; k < 4000; ++k) {
    const double t = 1e-3 * k;
    run.time_s.push_back(t);
    run.signals["position"].push_back(60.0 * t -
                                      2.0 * std::cos(10.0 * t));  // 40 to 80 rad/s, up to 200 rad/s2
    run.signals["motor_torque"].push_back(0.0);
  }
  d.runs = {run};
  return measured(d, *make_predictor(d, truth, {})->simulated(truth, 3));
}

TEST(Experiment, ABenchThatImposesTheMotionIsAskedForOneThatItCanMake) {
  const Candidate base = axis_candidate(), stribeck = with(base, "stribeck_friction", {3e-3, 3.0, 1.0});
  const Dataset given = imposed_axis(stribeck);
  const ExperimentPlan plan =
      plan_experiment(given, {{"stribeck_friction", stribeck}, {"base", base}}, {}, options(6.0));
  ASSERT_TRUE(plan.run) << plan.problem;
  EXPECT_EQ(plan.run->input, "velocity");
  ASSERT_EQ(plan.run->duty.size(), 1U);
  const std::vector<double>& speed = plan.run->duty.front();
  double travel = 0.0;
  for (std::size_t k = 1; k < speed.size(); ++k) {
    EXPECT_LE(std::abs(speed[k] - speed[k - 1]), 200.0 * 1e-3 * 1.05);
    EXPECT_LE(std::abs(speed[k]), 80.0 * 1.05);
    travel += speed[k] * 1e-3;
    EXPECT_LE(std::abs(travel), 241.0);  // that of the given motion
  }
  EXPECT_GT(plan.expected_sigmas, 5.0) << plan.next.what;
  EXPECT_GT(plan.expected_sigmas, 2.0 * plan.given_sigmas) << plan.next.what;
}

// A robot's floor tilts it, or its masses sit off the middle: standing still shows neither.
TEST(Experiment, SlowRobotIsAskedToDriveWhereItsRivalsPart) {
  const Candidate base = robot_candidate();
  const std::vector<Rival> rivals = {
      {"lateral_roller_friction", with(base, "lateral_roller_friction", {0.02})},
      {"rolling_resistance", with(base, "rolling_resistance", {0.02})}};
  ExperimentOptions o = options(6.0);
  o.coarse = true;
  o.limits.travel = 2.0;
  const Dataset blank = blank_robot(2.0, true);
  const Dataset given = measured(blank, *make_predictor(blank, base, {})->simulated(rivals[0].model, 3));
  const ExperimentPlan plan = plan_experiment(given, rivals, {}, o);
  ASSERT_TRUE(plan.run) << plan.problem;
  EXPECT_EQ(plan.run->duty.size(), 4U);
  EXPECT_GE(plan.expected_sigmas, 5.0) << plan.next.what;
  EXPECT_LE(plan.largest_travel, 2.0);
}

}  // namespace
}  // namespace omnihil::test
