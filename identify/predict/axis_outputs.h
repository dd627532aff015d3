// Prediction of an axis' compared signals for one prepared run (axis_setup.h), for both scalars.
//
//   std::vector<std::vector<Jet>> y = axis_outputs<Jet>(setup, params, effects, 100e-6);
//
// Returns y[signal][sample], n samples each, in the units of AxisSetup::compared; levels and filters, which are linear
// in the signal, are left to complete() (observation.h).
#pragma once
#include "identify/predict/axis_setup.h"

namespace omnihil {

// Drive input per torque that is missing at the rotor: duty, V, A or N m per N m. `bus_V` 0: not measured, the model's.
template <typename T>
T input_per_torque(CommandKind kind, const DriveParams<T>& p, double bus_V) {
  switch (kind) {
    case CommandKind::kMotorTorque:
      return T(1.0);
    case CommandKind::kMotorCurrent:
      return 1.0 / p.torque_constant_Nm_per_A;
    case CommandKind::kMotorVoltage:  // u = R / k tau
      return p.resistance_ohm / p.torque_constant_Nm_per_A;
    default:
      return p.resistance_ohm / p.torque_constant_Nm_per_A / (bus_V > 0.0 ? T(bus_V) : p.supply_voltage_V);
  }
}

template <typename T>
std::vector<std::vector<T>> axis_outputs(const AxisSetup& setup, const DriveParams<T>& params,
                                         const EffectSet<T>& effects, double step_s);

}  // namespace omnihil
