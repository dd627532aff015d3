// Rig "axis": one drive on a bench, rotary or linear (identify/predict/predictor_axis.h).
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

}  // namespace

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
