// A record that begins with a command, before the drive has heard it.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "identify/predict/predictor.h"
#include "sim/bench/axis_sim.h"
#include "sim/model/axis_model.h"
#include "tests/identify/rms.h"

namespace omnihil {
namespace {

constexpr double kPeriod_s = 1e-3, kDelay_s = 5e-3;

Candidate late_drive() {
  const AxisReading r = read_axis_model(
      "format = \"omnihil-model/1\"\nrig = \"axis\"\n[motor]\nresistance_ohm = 0.8\ntorque_constant_Nm_per_A "
      "= 0.03\n"
      "rotor_inertia_kg_m2 = 2e-5\nviscous_friction_Nm_s_per_rad = 1e-5\n[supply]\nvoltage_V = 24\n"
      "[effects.actuator_delay]\ndelay_s = 5e-3\n",
      "m", nullptr);
  EXPECT_TRUE(r.model);
  return candidate_of(r.model->file, r.model->effects);
}

// Duty 0 for a tenth of a second, then 0.5, then 0.2; rows from `first` on.
Dataset recorded_from(std::size_t first) {
  const Candidate truth = late_drive();
  AxisInput in;
  for (std::size_t k = 0; k < 400; ++k) {
    in.time_s.push_back(kPeriod_s * static_cast<double>(k));
    in.command.push_back(k < 100 ? 0.0 : k < 250 ? 0.5 : 0.2);
  }
  const auto moved = run_axis<double>(drive_of(truth), EffectSet<double>(truth.effects), in);
  omnihil::Run run;
  run.file = "f.csv";
  for (std::size_t k = first; k < moved.size(); ++k) {
    run.time_s.push_back(in.time_s[k]);
    run.signals["duty"].push_back(in.command[k]);
    run.signals["velocity"].push_back(moved[k].velocity_rad_s);
    run.signals["motor_current"].push_back(moved[k].motor_current_A);
  }
  Dataset d;
  d.channels = {{.signal = "duty", .column = "", .unit = "1"},
                {.signal = "velocity", .column = "", .unit = "rad/s"},
                {.signal = "motor_current", .column = "", .unit = "A"}};
  d.runs = {run};
  return d;
}

// The same drive by an imposed current, which is there from the first row on and yet not asked before it.
Dataset recorded_by_current() {
  const Candidate truth = late_drive();
  AxisInput in;
  in.kind = CommandKind::kMotorCurrent;
  in.command_before = 0.0;
  omnihil::Run run;
  run.file = "f.csv";
  for (std::size_t k = 0; k < 200; ++k) {
    in.time_s.push_back(kPeriod_s * static_cast<double>(k));
    in.command.push_back(k < 120 ? 2.0 : -1.0);
  }
  for (const auto& s : run_axis<double>(drive_of(truth), EffectSet<double>(truth.effects), in))
    run.signals["velocity"].push_back(s.velocity_rad_s);
  run.time_s = in.time_s;
  run.signals["motor_current"] = in.command;
  Dataset d;
  d.channels = {{.signal = "motor_current", .column = "", .unit = "A", .imposed = true},
                {.signal = "velocity", .column = "", .unit = "rad/s"}};
  d.runs = {run};
  return d;
}

double left_rad_s(const Dataset& dataset) {
  const auto p = make_predictor(dataset, late_drive(), {});
  return rms(p->compared(0)[0].measured, p->predict(late_drive(), 0).values[0]);
}

TEST(AxisPredictor, ADriveAtRestHasNotHeardTheFirstCommandYet) {
  EXPECT_LT(left_rad_s(recorded_from(50)), 0.1);
  EXPECT_LT(left_rad_s(recorded_from(100)), 0.1);
}

TEST(AxisPredictor, ADriveAtRestByCurrentHasNotHeardItsFirstRowYet) {
  EXPECT_LT(left_rad_s(recorded_by_current()), 0.1);
}

// One that turns was asked for what it is doing.
TEST(AxisPredictor, ADriveThatTurnsHadItsFirstCommandBefore) {
  EXPECT_LT(left_rad_s(recorded_from(200)), 0.5);
}

}  // namespace
}  // namespace omnihil
