// omnihil::identify: the checks of data find a speed whose sign is swapped.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "identify/checks/check_data.h"
#include "sim/bench/axis_sim.h"
#include "sim/bench/excitation.h"
#include "sim/model/axis_model.h"

namespace {

constexpr const char* kModel = R"(
format = "omnihil-model/1"
rig = "axis"
[motor]
resistance_ohm = { value = 0.464, tolerance = 0.1 }
torque_constant_Nm_per_A = { value = 0.0335, tolerance = 0.05 }
rotor_inertia_kg_m2 = { value = 1.35e-5, tolerance = 0.1 }
viscous_friction_Nm_s_per_rad = { value = 2e-5, tolerance = 1.0 }
[load]
inertia_kg_m2 = { value = 4.6e-5, tolerance = 0.1 }
[supply]
voltage_V = 24.0
)";

omnihil::Dataset measured(const omnihil::AxisModel& model, double sign_of_speed) {
  omnihil::AxisInput in;
  in.kind = omnihil::CommandKind::kDuty;
  for (int k = 0; k < 4000; ++k) {
    in.time_s.push_back(k * 1e-3);
    in.command.push_back(0.5 * omnihil::excitation_at(omnihil::Excitation::kSteps, in.time_s.back(),
                                                      {.duration_s = 4.0, .seed = 1}));
  }
  omnihil::Dataset data;
  data.channels = {{.signal = "duty", .column = "duty", .unit = "1"},
                   {.signal = "position", .column = "position", .unit = "rad", .sigma = 1e-4},
                   {.signal = "velocity", .column = "velocity", .unit = "rad/s", .sigma = 1e-2}};
  omnihil::Run run;
  run.file = "steps.csv";
  run.time_s = in.time_s;
  run.signals["duty"] = in.command;
  for (const auto& s : omnihil::run_axis<double>(model.drive, {}, in)) {
    run.signals["position"].push_back(s.position_rad);
    run.signals["velocity"].push_back(sign_of_speed * s.velocity_rad_s);
  }
  data.runs.push_back(run);
  return data;
}

bool finds_swapped_sign(const omnihil::AxisModel& model, double sign_of_speed) {
  const omnihil::Candidate nominal = omnihil::candidate_of(model.file, model.effects);
  const auto findings = omnihil::check_data(measured(model, sign_of_speed), nominal);
  for (const auto& f : findings) std::printf("%s: %s\n", f.kind.c_str(), f.sentence.c_str());
  return std::any_of(findings.begin(), findings.end(),
                     [](const auto& f) { return f.kind == "swapped_sign"; });
}

}  // namespace

bool a_swapped_sign_is_found() {
  const omnihil::AxisReading reading = omnihil::read_axis_model(kModel, "axis", {});
  return reading.model && finds_swapped_sign(*reading.model, -1.0) &&
         !finds_swapped_sign(*reading.model, 1.0);
}
