// Inverse dynamics of a drive whose speed is imposed: the torque that its effects look at.
#include "sim/drive/drive_sim.h"
#include "sim/drive/imposed_speed.h"
#include "sim/drive/needed_torque.h"

namespace omnihil {

// The motor torque with which the imposed motion needs no help from the bench: the argument of the torque
// effects in inverse dynamics (needed_torque.h). Not part of the sub-step, and by value: see impose_speed.
template <typename T>
T DriveSim<T>::inverse_torque(const DriveState<T>& state, double start_rad_s, double end_rad_s,
                              T tau_outside_Nm, TorquePort<T> port) const {
  const T given = port.tau_motor_Nm;
  return needed_torque(given, [&](const T& tau_motor_Nm) {
    TorquePort<T> at = port;
    at.tau_motor_Nm = tau_motor_Nm;
    auto states = state.effects;  // tried, not taken
    effects_.torque.apply(effects_.values(), states.data(), at);
    const RotorLoad<T> load{inertia_kg_m2_,
                            port.tau_load_Nm + given + at.tau_Nm,
                            at.viscous_positive_Nm_s_per_rad,
                            at.viscous_negative_Nm_s_per_rad,
                            at.friction_positive_Nm,
                            at.friction_negative_Nm};
    const ImposedSpeed<T> bench =
        impose_speed(start_rad_s, end_rad_s, step_s_, inertia_kg_m2_, tau_outside_Nm, load);
    return T(given + bench.outside_Nm - tau_outside_Nm);
  });
}

template double DriveSim<double>::inverse_torque(const DriveState<double>&, double, double, double,
                                                 TorquePort<double>) const;
template Jet DriveSim<Jet>::inverse_torque(const DriveState<Jet>&, double, double, Jet,
                                           TorquePort<Jet>) const;

}  // namespace omnihil
