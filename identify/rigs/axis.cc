// Rig "axis": one drive on a bench, rotary or linear (identify/predict/predictor_axis.h).
#include <algorithm>

#include "identify/predict/predictor_axis.h"
#include "identify/record/rig.h"

namespace omnihil {
namespace {

using enum SignalRole;

constexpr SignalRow kSignals[] = {
    {"time", "s", "s", kTime},
    {"duty", "1", "1", kDrive, "duty", Imposed::kWhereSaid},
    {"motor_voltage", "V", "V", kDrive, "motor_voltage", Imposed::kWhereSaid},
    {"motor_torque", "N m", "N", kDrive, "motor_torque", Imposed::kWhereSaid},
    {"position_target", "rad", "", kDrive, "position_target", Imposed::kWhereSaid},
    {"enable", "1", "1", kFlag},
    {"bus_voltage", "V", "V", kMeasured},
    {"motor_current", "A", "A", kMeasured, "", Imposed::kWhereSaid},
    {"encoder", "counts", "counts", kCounts},
    {"position", "rad", "m", kMotion, "", Imposed::kWhereSaid},
    {"velocity", "rad/s", "m/s", kMotion, "", Imposed::kWhereSaid},
    {"winding_temperature", "degC", "degC", kMeasured},
    {"load_torque", "N m", "N", kMeasured},
};

// Of settled points the input that each speed takes is compared: the torque that the motor lacks, over what its input is
// worth. A bridge or winding that lets no current pass lacks nothing at any speed and would explain them all.
void hide_losses_before_winding(Capabilities& rig) {
  for (Capability& c : rig.list) {
    if ((c.bits & (kNeedsSupply | kNeedsWinding | kNeedsDuty | kNeedsVoltage)) == 0) continue;
    c.there = false;
    c.refusal =
        "settled points by duty or voltage do not show it: without a measured current any loss before the "
        "winding explains every speed";
  }
}

}  // namespace

bool hides_losses_before_winding(const Dataset& dataset) {
  if (dataset.rig != &rig_axis() || dataset.runs.empty()) return false;
  return !is_torque(axis_command_kind(dataset)) &&
         std::ranges::all_of(dataset.runs, [](const Run& r) { return r.steady; });
}

bool takes_speed_as_reported(const Dataset& dataset) {
  if (dataset.rig != &rig_axis() || axis_method(dataset) == Method::kForward) return false;
  const Channel* const speed = dataset.channel("velocity");
  const bool position = dataset.channel("position") != nullptr || dataset.channel("encoder") != nullptr;
  return speed != nullptr && !speed->imposed && !position &&
         std::ranges::any_of(dataset.runs, [](const Run& r) { return !r.steady; });
}

Capabilities axis_capabilities(const Dataset& dataset, const Candidate& nominal) {
  const CommandKind kind = axis_command_kind(dataset);
  const DriveParams<double> drive = drive_of(nominal);
  const auto measured = [&](std::string_view name) { return dataset.channel(name) != nullptr; };
  const bool by_duty = kind == CommandKind::kDuty || kind == CommandKind::kPositionTarget;
  const bool by_voltage = !is_torque(kind);
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
               {kNeedsMeasuredCurrent, measured("motor_current") && kind != CommandKind::kMotorCurrent,
                "needs a current that is measured, not imposed"},
               {kNeedsShaftSensor, true, ""},
               {kNeedsEncoder, encoder, "needs an encoder"},
               {kNeedsAngle, encoder || measured("position"), "needs an encoder"}},
      .free_base = {},
      .present_base = {}};
  if (hides_losses_before_winding(dataset)) hide_losses_before_winding(out);
  for (const Parameter& p : nominal.file.parameters.parameters) {
    if (p.tolerance.value_or(0.0) > 0.0) out.free_base.push_back(parameter_path(*p.row));
  }
  for (const DriveParamPath& p : drive_param_paths()) {
    if (drive.*p.value > 0.0) out.present_base.emplace_back(p.path);
  }
  return out;
}

const Rig& rig_axis() {
  static constexpr Rig kRig{
      .name = "axis",
      .what = "one drive",
      .signals = kSignals,
      .drive_needed =
          "one of duty, motor_voltage, motor_torque, position_target, or motor_current with role = "
          "\"imposed\" is needed",
      .motion_needed = "one of encoder, position, velocity is needed",
      .make_predictor = make_axis_predictor,
  };
  return kRig;
}

}  // namespace omnihil
