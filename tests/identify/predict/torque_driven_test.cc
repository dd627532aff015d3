// An axis driven by torque: the torque that its motion needs, and the noise of that, held against the one that was given.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <string>

#include "identify/predict/predictor.h"
#include "sim/bench/axis_sim.h"
#include "sim/law/random.h"
#include "sim/model/axis_model.h"
#include "tests/identify/rms.h"

namespace omnihil {
namespace {

// Linear motor: 95 kg, 200 N s/m, driven by a smooth force; its position read with white noise.
struct ForceRecipe {
  double position_sigma_m = 0.0, period_s = 1e-3;
  double force_Hz = 2.0, force_sigma_N = 0.0;
  bool force_sigma_stated = false;
  std::uint64_t seed = 3;
  std::string more = {};  // of the model file
};
struct ForceDriven {
  Candidate truth;
  std::unique_ptr<Predictor> predictor;
};
ForceDriven force_driven(const ForceRecipe& recipe) {
  const std::string text =
      "format = \"omnihil-model/1\"\nrig = \"axis\"\nlinear = true\n[load]\n"
      "mass_kg = { value = 95, tolerance = 0.1 }\n[motor]\n"
      "viscous_friction_N_s_per_m = { value = 200, tolerance = 1 }\n" +
      recipe.more;
  const AxisReading r = read_axis_model(text, "m", nullptr);
  EXPECT_TRUE(r.model);
  ForceDriven out{.truth = candidate_of(r.model->file, r.model->effects), .predictor = nullptr};
  Dataset d;
  d.linear = true;
  d.channels = {{.signal = "motor_torque", .column = "", .unit = "N"},
                {.signal = "position", .column = "", .unit = "m"}};
  AxisInput in;
  in.kind = CommandKind::kMotorTorque;
  const auto force_N = [&](double t) {
    return 40.0 * std::sin(2.0 * std::numbers::pi * recipe.force_Hz * t);
  };
  constexpr int kRows = 3000, kSteps = 10;  // a held force is no sine: steps between the rows
  const double step_s = recipe.period_s / kSteps;
  for (int n = 0; n < kRows * kSteps; ++n) {
    in.time_s.push_back(step_s * n);
    in.command.push_back(force_N(step_s * (n + 0.5)));  // what acts until the next step, on average
  }
  omnihil::Run run;
  run.file = "f.csv";
  const auto moved = run_axis<double>(drive_of(out.truth), EffectSet<double>(out.truth.effects), in);
  for (std::size_t k = 0; k < kRows; ++k) {
    const double time_s = recipe.period_s * static_cast<double>(k);
    run.time_s.push_back(time_s);
    run.signals["motor_torque"].push_back(force_N(time_s) +
                                          recipe.force_sigma_N * gaussian(recipe.seed, 2, k));
    run.signals["position"].push_back(moved[k * kSteps].position_rad +
                                      recipe.position_sigma_m * gaussian(recipe.seed, 1, k));
  }
  if (recipe.force_sigma_stated) d.channels[0].sigma = recipe.force_sigma_N;
  d.runs = {run};
  out.predictor = make_predictor(d, out.truth, {});
  return out;
}

// A shaft that gives parts rotor (1.2e-5 kg m2) and load (7e-5): the torque turns the rotor, and which of them the encoder counts
// says which of them moves as measured. What is left of 0.02 N m at 8 Hz, by the encoder on `seen` and read as on `said`.
double left_of_a_soft_shaft_Nm(bool seen_on_output, bool said_on_output) {
  const std::string text =
      "format = \"omnihil-model/1\"\nrig = \"axis\"\n[motor]\nrotor_inertia_kg_m2 = 1.2e-5\n"
      "viscous_friction_Nm_s_per_rad = 4e-6\n[load]\ninertia_kg_m2 = 7e-5\n"
      "[effects.shaft_compliance]\ncompliance_rad_per_Nm = 1.0\ndamping_Nm_s_per_rad = 1e-3\n";
  const AxisReading r = read_axis_model(text, "m", nullptr);
  EXPECT_TRUE(r.model);
  const Candidate truth = candidate_of(r.model->file, r.model->effects);
  constexpr double kStep_s = 5e-4, kCounts = 1e6;
  constexpr int kRows = 2000, kSteps = 10;
  const auto torque_Nm = [](double t) { return 0.02 * std::sin(2.0 * std::numbers::pi * 8.0 * t); };
  AxisInput in;
  in.kind = CommandKind::kMotorTorque;
  in.encoder_counts_per_turn = kCounts;
  in.encoder_on_output = seen_on_output;
  for (int n = 0; n < kRows * kSteps; ++n) {
    in.time_s.push_back(kStep_s * n);
    in.command.push_back(torque_Nm(kStep_s * (n + 0.5)));
  }
  const auto moved = run_axis<double>(drive_of(truth), EffectSet<double>(truth.effects), in);
  Dataset d;
  d.channels = {{.signal = "motor_torque", .column = "", .unit = "N m"},
                {.signal = "encoder",
                 .column = "",
                 .unit = "",
                 .counts_per_rev = kCounts,
                 .on_output = said_on_output}};
  omnihil::Run run;
  run.file = "f.csv";
  for (std::size_t k = 0; k < kRows; ++k) {
    run.time_s.push_back(kSteps * kStep_s * static_cast<double>(k));
    run.signals["motor_torque"].push_back(torque_Nm(run.time_s.back()));
    run.signals["encoder"].push_back(std::round(moved[k * kSteps].encoder_counts));
  }
  d.runs = {run};
  const auto p = make_predictor(d, truth, {});
  EXPECT_EQ(p->method(), Method::kInverse);
  return rms(p->compared(0)[0].measured, p->predict(truth, 0).values[0]);
}

TEST(AxisPredictor, OfAPartedShaftThatSideMovesAsMeasuredWhichTheEncoderCounts) {
  const double whole_Nm = 0.02 / std::numbers::sqrt2;
  for (const bool on_output : {false, true}) {
    EXPECT_LT(left_of_a_soft_shaft_Nm(on_output, on_output), 0.01 * whole_Nm) << on_output;
    EXPECT_GT(left_of_a_soft_shaft_Nm(on_output, !on_output), 0.1 * whole_Nm) << on_output;
  }
}

TEST(AxisPredictor, ATorqueDrivenMotionNeedsTheTorqueThatMadeIt) {
  const auto [truth, p] = force_driven({});
  ASSERT_EQ(p->method(), Method::kInverse);
  EXPECT_EQ(p->compared(0)[0].name, "motor_torque");
  EXPECT_LT(rms(p->compared(0)[0].measured, p->predict(truth, 0).values[0]), 1e-3 * 40.0);
  Candidate light = truth;
  ASSERT_EQ(set_value(light, "load.mass_kg", 90.0), "");
  EXPECT_GT(rms(p->compared(0)[0].measured, p->predict(light, 0).values[0]), 0.01 * 40.0);
}

// The force between two rows, where the compared band ends (a tenth of the rate): a line from row to row lacks 3 % of it.
TEST(AxisPredictor, ATorqueBetweenRowsIsThatOfACurveThroughThem) {
  const auto [truth, p] = force_driven({.period_s = 1e-2, .force_Hz = 9.0});
  EXPECT_LT(rms(p->compared(0)[0].measured, p->predict(truth, 0).values[0]),
            0.005 * 40.0 / std::numbers::sqrt2);
}

// A command has no noise of its own: what the right model leaves is the position's noise, by the mass.
TEST(AxisPredictor, TheNoiseOfANeededTorqueIsThatOfTheMotionTimesTheInertia) {
  for (const double sigma_m : {1e-6, 3e-6, 1e-5}) {
    double left = 0.0,
           said = 0.0;  // N^2, of eight records: the band has some thirty degrees of freedom in one
    for (std::uint64_t seed = 3; seed < 11; ++seed) {
      const auto [truth, p] = force_driven({.position_sigma_m = sigma_m, .seed = seed});
      const ComparedSignal& force = p->compared(0)[0];
      left += std::pow(rms(force.measured, p->predict(truth, 0).values[0]), 2);
      said += std::pow(force.noise_sigma, 2);
    }

    EXPECT_NEAR(std::sqrt(said / left), 1.0, 0.2) << sigma_m << " m: " << std::sqrt(left / 8.0) << " N";
  }
}

// A torque that is measured (a drive's own current) has noise, of which the compared band keeps its share, be it stated or not.
TEST(AxisPredictor, TheNoiseOfAMeasuredTorqueIsWhatItsBandKeeps) {
  for (const bool stated : {false, true}) {
    for (const double period_s : {1e-3, 1e-2}) {
      const auto [truth, p] =
          force_driven({.period_s = period_s, .force_sigma_N = 0.5, .force_sigma_stated = stated});
      const ComparedSignal& force = p->compared(0)[0];
      const double left_N = rms(force.measured, p->predict(truth, 0).values[0]);
      EXPECT_NEAR(force.noise_sigma / left_N, 1.0, 0.1)
          << stated << " " << period_s << ": " << left_N << " N";
      EXPECT_EQ(force.noise_is_stated, stated);
    }
  }
}

// Friction at a reversal bends within the filter's time: it is taken of the motion, and then filtered, not of a filtered motion.
TEST(AxisPredictor, ASlowRecordLeavesNoErrorWhereFrictionTurnsRound) {
  const auto [truth, p] =
      force_driven({.period_s = 1e-2, .more = "[effects.coulomb_friction]\ntorque_N = 8\n"});
  EXPECT_LT(rms(p->compared(0)[0].measured, p->predict(truth, 0).values[0]), 0.05 * 8.0);
}

}  // namespace
}  // namespace omnihil
