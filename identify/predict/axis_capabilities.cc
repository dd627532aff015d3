// What an axis has that effects may need: from what drives it, what is measured, and its base model.
#include "identify/predict/axis_setup.h"
#include "identify/predict/predictor_axis.h"

namespace omnihil {
Capabilities axis_capabilities(const Dataset& dataset, const Candidate& nominal) {
  const CommandKind kind = axis_command_kind(dataset);
  const DriveParams<double> drive = drive_of(nominal);
  const auto measured = [&](std::string_view name) { return dataset.channel(name) != nullptr; };
  const bool by_duty = kind == CommandKind::kDuty || kind == CommandKind::kPositionTarget;
  const bool by_voltage = by_duty || kind == CommandKind::kMotorVoltage;
  const bool simulated = axis_method(dataset) == Method::kForward;
  const bool two_inertias = drive.load_inertia_kg_m2 > 0.0 && drive.rotor_inertia_kg_m2 > 0.0;
  const bool encoder = measured("encoder");
  Capabilities out{
      .rig = kOnAxis,
      .other_rig = "acts on a robot on the floor",
      .list = {{kNeedsFloor, false, "acts on a robot on the floor"},
               {kNeedsCamera, false, "needs a camera"},
               {kNeedsSeveralMotors, false, "needs more than one motor"},
               {kNeedsSupply, by_voltage, "the drive has no supply in these data"},
               {kNeedsWinding, by_voltage || kind == CommandKind::kMotorCurrent,
                "needs a drive by duty, voltage or current"},
               {kNeedsPositionServo, kind == CommandKind::kPositionTarget, "needs a position target"},
               {kNeedsDuty, by_duty, "needs a drive by duty"},
               {kNeedsVoltage, by_voltage, "needs a winding"},
               {kNeedsTwoInertias, two_inertias, "needs an inertia on either side of the shaft"},
               {kNeedsSimulation, simulated,
                "the motion is taken as measured; actuator_delay shows the same lag"},
               {kNeedsReportedSpeed, measured("velocity"), "needs a speed that the drive reports"},
               {kNeedsShaftSensor, true, ""},
               {kNeedsEncoder, encoder, "needs an encoder"},
               {kNeedsAngle, encoder || measured("position"), "needs an encoder"}},
      .free_base = {},
      .present_base = {}};
  for (const Parameter& p : nominal.file.parameters.parameters) {
    if (p.tolerance.value_or(0.0) > 0.0) out.free_base.push_back(parameter_path(*p.row));
  }
  for (const DriveParamPath& p : drive_param_paths()) {
    if (drive.*p.value > 0.0) out.present_base.emplace_back(p.path);
  }
  return out;
}

}  // namespace omnihil
