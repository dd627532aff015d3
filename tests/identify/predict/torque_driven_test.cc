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

Candidate model_of(const std::string& text) {
  const AxisReading r =
      read_axis_model("format = \"omnihil-model/1\"\nrig = \"axis\"\n" + text, "m", nullptr);
  EXPECT_TRUE(r.model);
  return candidate_of(r.model->file, r.model->effects);
}

// Driven by a sine of torque (force): what it is, and what the axis does, at each row.
struct SineDriven {
  omnihil::Run run;  // motor_torque alone, without noise
  std::vector<AxisSample<double>> moved;
};
SineDriven driven_by_sine(const Candidate& truth, double amplitude, double frequency_Hz, std::size_t rows,
                          double period_s, AxisInput in = {}) {
  constexpr std::size_t kSteps = 10;  // a held torque is no sine: steps between the rows
  const auto torque = [&](double t) {
    return amplitude * std::sin(2.0 * std::numbers::pi * frequency_Hz * t);
  };
  const double step_s = period_s / kSteps;
  in.kind = CommandKind::kMotorTorque;
  for (std::size_t n = 0; n < rows * kSteps; ++n) {
    in.time_s.push_back(step_s * static_cast<double>(n));
    in.command.push_back(
        torque(in.time_s.back() + 0.5 * step_s));  // what acts until the next step, on average
  }
  const auto moved = run_axis<double>(drive_of(truth), EffectSet<double>(truth.effects), in);
  SineDriven out;
  out.run.file = "f.csv";
  for (std::size_t k = 0; k < rows; ++k) {
    out.run.time_s.push_back(period_s * static_cast<double>(k));
    out.run.signals["motor_torque"].push_back(torque(out.run.time_s.back()));
    out.moved.push_back(moved[k * kSteps]);
  }
  return out;
}

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
  ForceDriven out{
      .truth = model_of("linear = true\n[load]\nmass_kg = { value = 95, tolerance = 0.1 }\n[motor]\n"
                        "viscous_friction_N_s_per_m = { value = 200, tolerance = 1 }\n" +
                        recipe.more),
      .predictor = nullptr};
  Dataset d;
  d.linear = true;
  d.channels = {{.signal = "motor_torque", .column = "", .unit = "N"},
                {.signal = "position", .column = "", .unit = "m"}};
  SineDriven driven = driven_by_sine(out.truth, 40.0, recipe.force_Hz, 3000, recipe.period_s);
  for (std::size_t k = 0; k < driven.moved.size(); ++k) {
    driven.run.signals["motor_torque"][k] += recipe.force_sigma_N * gaussian(recipe.seed, 2, k);
    driven.run.signals["position"].push_back(driven.moved[k].position_rad +
                                             recipe.position_sigma_m * gaussian(recipe.seed, 1, k));
  }
  if (recipe.force_sigma_stated) d.channels[0].sigma = recipe.force_sigma_N;
  d.runs = {driven.run};
  out.predictor = make_predictor(d, out.truth, {});
  return out;
}

// A shaft that gives parts rotor (1.2e-5 kg m2) and load (7e-5): the torque turns the rotor, and which of them the encoder counts
// says which of them moves as measured. What is left of 0.02 N m at 8 Hz, by the encoder on `seen` and read as on `said`.
double left_of_a_soft_shaft_Nm(bool seen_on_output, bool said_on_output) {
  const Candidate truth = model_of(
      "[motor]\nrotor_inertia_kg_m2 = 1.2e-5\nviscous_friction_Nm_s_per_rad = 4e-6\n[load]\ninertia_kg_m2 = "
      "7e-5\n"
      "[effects.shaft_compliance]\ncompliance_rad_per_Nm = 1.0\ndamping_Nm_s_per_rad = 1e-3\n");
  constexpr double kCounts = 1e6;
  Dataset d;
  d.channels = {{.signal = "motor_torque", .column = "", .unit = "N m"},
                {.signal = "encoder",
                 .column = "",
                 .unit = "",
                 .counts_per_rev = kCounts,
                 .on_output = said_on_output}};
  AxisInput seen;
  seen.encoder_counts_per_turn = kCounts;
  seen.encoder_on_output = seen_on_output;
  SineDriven driven = driven_by_sine(truth, 0.02, 8.0, 2000, 5e-3, seen);
  for (const AxisSample<double>& s : driven.moved)
    driven.run.signals["encoder"].push_back(std::round(s.encoder_counts));
  d.runs = {driven.run};
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

// A controller commands faster than the band that is compared (a tenth of the rate), and the mass follows: that is no noise of
// the force, 28 N of it or 0.2.
TEST(AxisPredictor, WhatTheMotionFollowsOfAFastCommandIsNoNoise) {
  const auto [truth, p] =
      force_driven({.position_sigma_m = 1e-9, .period_s = 2e-3, .force_Hz = 65.0, .force_sigma_N = 0.2});
  const ComparedSignal& force = p->compared(0)[0];
  EXPECT_LT(force.noise_sigma, 0.4);
  EXPECT_GT(force.noise_sigma, 0.02);
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
