#include "sim/model/axis_model.h"

#include <algorithm>

#include "sim/model/effect_reader.h"

namespace omnihil {
namespace {

bool same_place(const ModelProblem& a, const ModelProblem& b) {
  return a.file == b.file && a.line == b.line && a.column == b.column;
}

void add_effects(std::string_view text, const std::string& name, AxisModel& model,
                 std::vector<ModelProblem>& problems) {
  std::vector<ModelProblem> own;
  const auto document = parse_document(text, name, own);
  if (!document) return;  // said by the model reader
  model.effects = read_effects(*document, {.drive = &model.drive, .linear = model.drive.linear}, own);
  for (ModelProblem& p : own) {
    const bool said =
        std::any_of(problems.begin(), problems.end(), [&](const auto& q) { return same_place(p, q); });
    if (!said) problems.push_back(std::move(p));
  }
}

}  // namespace

DriveParams<double> drive_params_of(const ParameterTable& table) {
  DriveParams<double> p;
  p.linear = table.value_or("linear", 0.0) != 0.0;
  for (const DriveParamPath& at : drive_param_paths()) {
    const std::string_view path = p.linear ? at.linear_path : at.path;
    if (!path.empty()) p.*at.value = table.value_or(path, p.*at.value);
  }
  p.pole_pairs = static_cast<int>(table.value_or("motor.pole_pairs", 0.0));
  p.slots = static_cast<int>(table.value_or("motor.slots", 0.0));
  if (table.find("robot.wheel_inertia_kg_m2") != nullptr) {
    p.load_inertia_kg_m2 = table.value_or("robot.wheel_inertia_kg_m2", 0.0);
  }
  if (p.supply_voltage_V == 0.0) p.supply_voltage_V = table.value_or("datasheet.nominal_voltage_V", 0.0);
  return p;
}

AxisReading read_axis_model(std::string_view text, const std::string& shown_name,
                            const MotorFileLoader& load_motor) {
  AxisReading reading;
  ModelReading base = read_model(text, shown_name, load_motor);
  reading.problems = std::move(base.problems);
  AxisModel model;
  if (base.model) {
    model.file = std::move(*base.model);
    model.drive = drive_params_of(model.file.parameters);
    model.has_servo = model.drive.servo_kp_duty_per_rad > 0.0;
    model.has_electrics = model.drive.resistance_ohm > 0.0 && model.drive.torque_constant_Nm_per_A > 0.0;
    model.encoder_counts_per_turn = model.file.parameters.value_or("encoder.counts_per_turn", 0.0);
    if (inertia_at_rotor(model.drive) <= 0.0) {
      reading.problems.push_back({.file = shown_name,
                                  .line = 0,
                                  .column = 0,
                                  .key = "motor.rotor_inertia_kg_m2",
                                  .value = "",
                                  .what = "nothing that moves has inertia",
                                  .allowed = "motor.rotor_inertia_kg_m2 or load.inertia_kg_m2 more than 0"});
    }
  }
  add_effects(text, shown_name, model, reading.problems);
  if (model.effects.empty() && !model.file.motor_file.empty() && load_motor) {
    const MotorFileText motor = load_motor(model.file.motor_file);
    if (motor.error.empty()) add_effects(motor.text, motor.shown_name, model, reading.problems);
  }
  if (reading.problems.empty() && base.model) reading.model = std::move(model);
  return reading;
}

}  // namespace omnihil
