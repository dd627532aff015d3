#include "sim/drive/dc_drive.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace omnihil {
namespace {

// What is held during one call.
struct Held {
  const DcDrive& drive;
  double bus_V = 0.0;
  double tau_load_Nm = 0.0;
};

DcFlow after(const Held& held, DcFlow flow, const DcStep& step, double voltage_V) {
  apply(step, flow, voltage_V, held.tau_load_Nm);
  return flow;
}

// Any number of sub-steps with the voltage held, in as few exact steps as there are bits.
DcFlow after_substeps(const Held& held, DcFlow flow, double voltage_V, int substeps) {
  for (int n = kLongerSteps - 1; n >= 0; --n) {
    for (; substeps >= 1 << n; substeps -= 1 << n) {
      flow = after(held, flow, held.drive.longer[static_cast<std::size_t>(n)], voltage_V);
    }
  }
  return flow;
}

// The current stays as it is for a time, by whatever voltage that takes.
DcFlow after_hold(const Held& held, DcFlow flow, double time_s) {
  const auto& c = held.drive.constants;
  const double i = flow.current_A;
  const double omega_rad_s2 = (c.torque_constant_Nm_per_A * i - held.tau_load_Nm) / c.inertia_kg_m2;
  const double angle_rad = time_s * (flow.omega_rad_s + 0.5 * omega_rad_s2 * time_s);
  flow.omega_rad_s += omega_rad_s2 * time_s;
  flow.angle_rad += angle_rad;
  flow.charge_C += i * time_s;
  flow.square_A2_s += i * i * time_s;
  // u i = R i^2 + k i omega
  flow.energy_J += c.resistance_ohm * i * i * time_s + c.torque_constant_Nm_per_A * i * angle_rad;
  return flow;
}

// Voltage held until the current is exactly `bound_A`, which it must pass within this sub-step. Halving finds
// the instant to 2^-16 of a sub-step, the rest is a straight line. `left_s`: what is left of the sub-step.
DcFlow after_reaching(const Held& held, DcFlow flow, double voltage_V, double bound_A, double& left_s) {
  const auto& c = held.drive.constants;
  const bool from_above = flow.current_A > bound_A;
  left_s = held.drive.step_s;
  for (const DcStep& step : held.drive.shorter) {
    const DcFlow trial = after(held, flow, step, voltage_V);
    if (trial.current_A == bound_A || (trial.current_A > bound_A) != from_above) continue;
    flow = trial;
    left_s -= step.step_s;
  }
  const double i = flow.current_A;
  double rest_s = 0.0;
  if (c.inductance_H > 0.0) {
    // L di/dt = u - R i - k omega
    const double drive_V = voltage_V - c.resistance_ohm * i - c.torque_constant_Nm_per_A * flow.omega_rad_s;
    rest_s = std::clamp((bound_A - i) * c.inductance_H / drive_V, 0.0, left_s);
  }
  const double mean_A = 0.5 * (i + bound_A);
  flow.charge_C += mean_A * rest_s;
  flow.square_A2_s += (i * i + i * bound_A + bound_A * bound_A) / 3.0 * rest_s;
  flow.energy_J += voltage_V * mean_A * rest_s;
  const double omega_rad_s2 = (c.torque_constant_Nm_per_A * mean_A - held.tau_load_Nm) / c.inertia_kg_m2;
  flow.angle_rad += rest_s * (flow.omega_rad_s + 0.5 * omega_rad_s2 * rest_s);
  flow.omega_rad_s += omega_rad_s2 * rest_s;
  flow.current_A = bound_A;
  left_s -= rest_s;
  return flow;
}

DcFlow after_coasting(const Held& held, const DcFlow& flow) {
  const auto& c = held.drive.constants;
  const bool conducting = flow.current_A != 0.0 && c.inductance_H > 0.0;
  const double emf_V = c.torque_constant_Nm_per_A * flow.omega_rad_s;
  const bool rectifying = !conducting && std::abs(emf_V) > held.bus_V;
  DcFlow start = flow;
  if (!conducting) start.current_A = 0.0;
  if (!conducting && !rectifying) return after_hold(held, start, held.drive.step_s);

  // diodes: u = -sign(i) bus; a current that is about to begin has the sign that brakes
  const double sign = conducting ? std::copysign(1.0, start.current_A) : -std::copysign(1.0, emf_V);
  const double voltage_V = -sign * held.bus_V;
  const DcFlow whole = after(held, start, held.drive.longer[0], voltage_V);
  if (whole.current_A * sign > 0.0) return whole;
  if (!conducting) return after_hold(held, start, held.drive.step_s);
  double left_s = 0.0;
  const DcFlow empty = after_reaching(held, start, voltage_V, 0.0, left_s);
  return after_hold(held, empty, left_s);
}

// One sub-step under the chopper; see the header.
DcFlow after_limited(const Held& held, DcFlow flow, double voltage_V) {
  const auto& c = held.drive.constants;
  const double limit_A = held.drive.current_limit_A;
  bool at_limit = false;
  if (c.inductance_H == 0.0) {  // the current follows at once: it starts at the limit or does not reach it
    flow.current_A = (voltage_V - c.torque_constant_Nm_per_A * flow.omega_rad_s) / c.resistance_ohm;
    at_limit = std::abs(flow.current_A) > limit_A;
    if (at_limit) flow.current_A = std::copysign(limit_A, flow.current_A);
  }
  const DcFlow whole = after(held, flow, held.drive.longer[0], voltage_V);
  if (std::abs(whole.current_A) <= limit_A && !at_limit) return whole;

  const double sign = std::copysign(1.0, at_limit ? flow.current_A : whole.current_A);
  const double bound_A = sign * limit_A;
  double left_s = held.drive.step_s;
  if (flow.current_A * sign > limit_A) {
    const double off_V =
        -sign * held.bus_V;  // above the limit from before: switched off, the diodes pull it down
    const DcFlow off = after(held, flow, held.drive.longer[0], off_V);
    if (off.current_A * sign > limit_A) return off;
    flow = after_reaching(held, flow, off_V, bound_A, left_s);
  } else if (flow.current_A != bound_A) {
    flow = after_reaching(held, flow, voltage_V, bound_A, left_s);
  }
  const double needed_V = c.resistance_ohm * bound_A + c.torque_constant_Nm_per_A * flow.omega_rad_s;
  if (std::abs(needed_V) > held.bus_V && left_s == held.drive.step_s) {
    return after(held, flow, held.drive.longer[0], std::copysign(held.bus_V, needed_V));
  }
  return after_hold(held, flow, left_s);
}

// True when no current within the call can reach the limit: then the unlimited law is exact.
bool limit_out_of_reach(const Held& held, const DcFlow& flow, double voltage_V, double time_s) {
  const DcDrive& d = held.drive;
  const auto& c = d.constants;
  if (d.current_limit_A <= 0.0) return true;
  // Until the limit is reached |k i| <= k limit, which bounds the change of speed and with it the voltage
  // across R; the current of an R-L branch never passes both its start and its largest voltage over R.
  const double change_rad_s = time_s *
                              (c.torque_constant_Nm_per_A * d.current_limit_A + std::abs(held.tau_load_Nm)) /
                              c.inertia_kg_m2;
  const double largest_V = std::abs(voltage_V - c.torque_constant_Nm_per_A * flow.omega_rad_s) +
                           c.torque_constant_Nm_per_A * change_rad_s;
  return std::abs(flow.current_A) <= d.current_limit_A && largest_V <= c.resistance_ohm * d.current_limit_A;
}

// True when the current is at the limit and the duty asks for more throughout the call: then holding it is
// exact.
bool stays_at_limit(const Held& held, const DcFlow& flow, double voltage_V, double time_s) {
  const auto& c = held.drive.constants;
  if (std::abs(flow.current_A) != held.drive.current_limit_A) return false;
  const double sign = std::copysign(1.0, flow.current_A);
  const double start_V = c.resistance_ohm * flow.current_A + c.torque_constant_Nm_per_A * flow.omega_rad_s;
  const double end_V = start_V + c.torque_constant_Nm_per_A * time_s *
                                     (c.torque_constant_Nm_per_A * flow.current_A - held.tau_load_Nm) /
                                     c.inertia_kg_m2;
  // the voltage that holds it changes evenly: both ends decide
  return (voltage_V - start_V) * sign > 0.0 && (voltage_V - end_V) * sign > 0.0 &&
         std::abs(start_V) <= held.bus_V && std::abs(end_V) <= held.bus_V;
}

// True when the bridge is off, no current flows and none begins within the call.
bool stays_without_current(const Held& held, const DcFlow& flow, double time_s) {
  const auto& c = held.drive.constants;
  const double end_rad_s = flow.omega_rad_s - held.tau_load_Nm / c.inertia_kg_m2 * time_s;
  // the speed changes evenly: both ends decide
  return flow.current_A == 0.0 && std::abs(c.torque_constant_Nm_per_A * flow.omega_rad_s) <= held.bus_V &&
         std::abs(c.torque_constant_Nm_per_A * end_rad_s) <= held.bus_V;
}

}  // namespace

DcDrive make_dc_drive(const MotorParams& motor, double extra_inertia_rotor_side_kg_m2, double step_s) {
  DcDrive drive;
  drive.step_s = step_s;
  drive.current_limit_A = motor.current_limit_A;
  drive.duty_limit_ratio = motor.duty_limit_ratio;
  drive.constants = {.resistance_ohm = motor.resistance_ohm,
                     .inductance_H = motor.inductance_H,
                     .torque_constant_Nm_per_A = motor.torque_constant_Nm_per_A,
                     .inertia_kg_m2 = motor.rotor_inertia_kg_m2 + extra_inertia_rotor_side_kg_m2};
  const auto& c = drive.constants;
  std::string problems;
  const auto need = [&](bool good, const char* what) {
    if (!good) problems += std::string(problems.empty() ? "" : "; ") + what;
  };
  const auto positive = [](double value) { return std::isfinite(value) && value > 0.0; };
  need(positive(step_s), "electrical step must be positive");
  need(positive(c.resistance_ohm), "resistance_ohm must be positive");
  need(positive(c.torque_constant_Nm_per_A), "torque_constant_Nm_per_A must be positive");
  need(positive(c.inertia_kg_m2), "rotor and extra inertia together must be positive");
  need(c.inductance_H == 0.0 || positive(c.inductance_H), "inductance_H must not be negative");
  need(drive.current_limit_A == 0.0 || positive(drive.current_limit_A),
       "current_limit_A must not be negative");
  need(drive.duty_limit_ratio >= 0.0 && drive.duty_limit_ratio <= 1.0,
       "duty_limit_ratio must be within 0 to 1");
  if (!problems.empty()) throw std::invalid_argument("make_dc_drive: " + problems);

  double time_s = step_s;
  for (DcStep& step : drive.longer) step = make_dc_step(c, time_s), time_s *= 2.0;
  time_s = step_s;
  for (DcStep& step : drive.shorter) step = make_dc_step(c, time_s *= 0.5);
  return drive;
}

DcDriveResult advance_drive(const DcDrive& drive, DcDriveState& state, const DcDriveInput& input,
                            int substeps) {
  const Held held{.drive = drive, .bus_V = input.bus_voltage_V, .tau_load_Nm = input.tau_load_Nm};
  const double time_s = drive.step_s * substeps;
  DcFlow flow{.current_A = state.current_A, .omega_rad_s = input.omega_rotor_rad_s};
  if (input.mode == OMNIHIL_DRIVE_DUTY) {
    const double limit = drive.duty_limit_ratio;
    const double voltage_V = std::clamp(input.duty_ratio, -limit, limit) * input.bus_voltage_V;
    if (limit_out_of_reach(held, flow, voltage_V, time_s)) {
      flow = after_substeps(held, flow, voltage_V, substeps);
    } else if (stays_at_limit(held, flow, voltage_V, time_s)) {
      flow = after_hold(held, flow, time_s);
    } else {
      for (int n = 0; n < substeps; ++n) flow = after_limited(held, flow, voltage_V);
    }
  } else if (stays_without_current(held, flow, time_s)) {
    flow = after_hold(held, flow, time_s);
  } else {
    for (int n = 0; n < substeps; ++n) flow = after_coasting(held, flow);
  }
  state.current_A = flow.current_A;

  DcDriveResult out{.omega_end_rad_s = flow.omega_rad_s, .angle_rad = flow.angle_rad};
  if (substeps <= 0) return out;
  out.mean_current_A = flow.charge_C / time_s;
  out.mean_torque_Nm = drive.constants.torque_constant_Nm_per_A * out.mean_current_A;
  out.mean_bus_current_A = input.bus_voltage_V > 0.0 ? flow.energy_J / (input.bus_voltage_V * time_s) : 0.0;
  out.heat_J = drive.constants.resistance_ohm * flow.square_A2_s;
  out.electrical_energy_J = flow.energy_J;
  return out;
}

}  // namespace omnihil
