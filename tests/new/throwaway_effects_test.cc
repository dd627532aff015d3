// Adding an effect touches its file and its test: three that are in no list of ours (one made by `./dev new`) are listed,
// simulated, searched, refused and fitted by what their own files say of them.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "identify/estimate/fit.h"
#include "identify/predict/predictor_axis.h"
#include "identify/select/effect_variants.h"
#include "sim/law/effect_registry.h"
#include "sim/model/axis_model.h"
#include "tests/identify/simulated_robot.h"
#include "tests/sim/effects/bench.h"

namespace omnihil::test {
namespace {

constexpr const char* kThree[] = {"fresh_effect", "pulse_window", "tooth_pull"};

Candidate axis() {
  const std::string text = R"(
format = "omnihil-model/1"
rig = "axis"
[motor]
resistance_ohm = 0.5
torque_constant_Nm_per_A = 0.03
rotor_inertia_kg_m2 = 1e-5
viscous_friction_Nm_s_per_rad = 5e-6
pole_pairs = 8
[load]
inertia_kg_m2 = 5e-5
[supply]
voltage_V = 24
)";
  const AxisReading r = read_axis_model(text, "model.toml", nullptr);
  for (const ModelProblem& p : r.problems) ADD_FAILURE() << p.text();
  return r.model ? candidate_of(r.model->file, r.model->effects) : Candidate{};
}

Dataset driven_by(const std::string& input, const std::vector<std::string>& sensors) {
  Dataset d;
  d.channels.push_back({.signal = input, .column = "", .unit = "1"});
  for (const std::string& s : sensors) d.channels.push_back({.signal = s, .column = "", .unit = ""});
  return d;
}

std::string refused(const char* id, const Dataset& dataset) {
  return refusal(*find_effect(id)->info, axis_capabilities(dataset, axis()));
}

TEST(ThrowawayEffects, AreListed) {
  for (const char* id : kThree) EXPECT_NE(find_effect(id), nullptr) << id;
  EXPECT_EQ(nearest_effect("tooth_pul"), "tooth_pull");
}

TEST(ThrowawayEffects, AreSimulated) {
  const AxisInput in = excite(Excitation::kSteps, 0.8, 1.0);
  const auto without = run_axis(small_drive(), nothing(), in);
  for (const char* id : kThree) {
    const auto effect = run_axis(small_drive(), with({typical_use(*find_effect(id))}), in);
    double most = 0.0;
    for (std::size_t k = 0; k < in.time_s.size(); ++k)
      most = std::max(most, std::abs(effect[k].velocity_rad_s - without[k].velocity_rad_s));
    // each is of a size that its file calls visible: of 300 rad/s, more than a count per sample of 4096 is seen
    EXPECT_GT(most, 2.0 * std::numbers::pi / 4096 * 1000) << id;
  }
}

TEST(ThrowawayEffects, AreRefusedForWhatTheyDemand) {
  const Dataset pulses = driven_by("duty", {"velocity"}), counts = driven_by("duty", {"encoder"}),
                torque = driven_by("motor_torque", {"velocity"});
  for (const char* id : {"fresh_effect", "tooth_pull"}) {
    for (const Dataset& d : {pulses, counts, torque}) EXPECT_EQ(refused(id, d), "") << id;
  }
  EXPECT_EQ(refused("pulse_window", pulses), "");
  EXPECT_EQ(refused("pulse_window", counts), "needs a speed that the drive reports");
  EXPECT_EQ(refused("pulse_window", torque),
            "the motion is taken as measured; actuator_delay shows the same lag");
  const auto robot = make_predictor(blank_robot(0.1, true), robot_candidate(), {});
  EXPECT_EQ(robot->applies(*find_effect("pulse_window")),
            "needs a speed that the drive's electronics estimate");
  EXPECT_EQ(robot->applies(*find_effect("tooth_pull")), "");
}

TEST(ThrowawayEffects, AreSearchedAsTheirRowsSay) {
  const DataScale scale{.top_speed_rad_s = 300.0, .top_current_A = 10.0, .duration_s = 2.0};
  const auto variants = [&](const char* id) { return variants_of(*find_effect(id), axis(), scale); };
  // one setting each; an angle that goes round is two columns, at 0 and at a quarter turn
  ASSERT_EQ(variants("fresh_effect").size(), 1u);
  EXPECT_EQ(variants("fresh_effect")[0].columns.size(), 1u);
  const auto tooth = variants("tooth_pull");
  ASSERT_EQ(tooth.size(), 1u);
  ASSERT_EQ(tooth[0].columns.size(), 2u);
  EXPECT_EQ(tooth[0].columns[1].phase, std::numbers::pi / 2.0);
  EXPECT_EQ(start_of(tooth[0], {0.0, -1.0}, axis()).values[1], -std::numbers::pi / 2.0);
  // six pulses per electrical turn, and no other number is tried
  const auto pulses = variants("pulse_window");
  ASSERT_EQ(pulses.size(), 1u);
  EXPECT_EQ(pulses[0].shape.values[0], 6.0 * 8);
}

TEST(ThrowawayEffects, AWholeNumberIsNoUnknownAndAnAngleGoesRound) {
  const Candidate pulses = with_effect(axis(), *find_effect("pulse_window"));
  for (const Unknown& u : unknowns_of(pulses)) EXPECT_NE(u.path, "pulse_window.marks_per_turn");
  const Candidate tooth = with_effect(axis(), *find_effect("tooth_pull"));
  const std::vector<Unknown> unknowns = unknowns_of(tooth);
  ASSERT_EQ(unknowns.back().path, "tooth_pull.notch_rad");
  EXPECT_EQ(unknowns.back().trait, ParamTrait::kPeriodic);
}

// From neutral: the strength and, wherever it is on the circle, the angle are found, and no bound is named.
TEST(ThrowawayEffects, AreFittedFromNeutral) {
  const Candidate nominal = with_effect(axis(), *find_effect("tooth_pull"));
  for (const double notch_rad : {-2.5, 3.1}) {
    Candidate truth = nominal;
    ASSERT_EQ(set_value(truth, "tooth_pull.pull_Nm", 0.005), "");
    ASSERT_EQ(set_value(truth, "tooth_pull.notch_rad", notch_rad), "");
    Dataset d = driven_by("duty", {"encoder"});
    d.channels[1].counts_per_rev = 4096;
    omnihil::Run run;
    AxisInput in = excite(Excitation::kSteps, 0.1, 2.0);
    in.encoder_counts_per_turn = 4096;
    run.time_s = in.time_s;
    run.signals["duty"] = in.command;
    for (const auto& s : run_axis(drive_of(truth), EffectSet<double>(truth.effects), in))
      run.signals["encoder"].push_back(std::floor(s.encoder_counts));
    d.runs.push_back(std::move(run));
    const auto predictor = make_predictor(d, nominal, {});
    const FitResult r = fit(*predictor, nominal, unknowns_of(nominal), {});
    const double pull_Nm = *value_at(r.model, "tooth_pull.pull_Nm");
    const double found_rad =
        *value_at(r.model, "tooth_pull.notch_rad") + (pull_Nm < 0.0 ? std::numbers::pi : 0.0);
    EXPECT_NEAR(std::abs(pull_Nm), 0.005, 0.05 * 0.005);
    EXPECT_NEAR(std::remainder(found_rad - notch_rad, 2.0 * std::numbers::pi), 0.0, 0.1);
    for (const ParameterEstimate& p : r.parameters) EXPECT_FALSE(p.at_bound) << p.path;
  }
}

}  // namespace
}  // namespace omnihil::test
