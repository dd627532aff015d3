#include "identify/predict/axis_outputs.h"

#include <cmath>

#include "identify/predict/settled_points.h"

namespace omnihil {
namespace {

double bus_at(const AxisInput& in, std::size_t k) {
  return in.bus_voltage_V.empty() ? 0.0 : in.bus_voltage_V[k];
}

template <typename T>
T quantity_of(const AxisSetup& s, const DriveParams<T>& p, Quantity what,
              const std::vector<AxisSample<T>>& samples, std::size_t k) {
  const AxisSample<T>& now = samples[k];
  switch (what) {
    case Quantity::kSpeed:
      return now.velocity_rad_s;
    case Quantity::kPosition:
      return now.position_rad;
    case Quantity::kCounts:
      return now.encoder_counts;
    case Quantity::kCurrent:
      return now.motor_current_A;
    case Quantity::kTemperature:
      return now.winding_rise_K + s.first_temperature_degC;
    case Quantity::kBusVoltage:
      return now.supply_voltage_V;
    case Quantity::kLoadTorque:
      return now.load_torque_Nm;
    case Quantity::kNeededInput: {
      if (k == 0) return T(0);
      const double load = s.input.load_torque_Nm.empty() ? 0.0 : s.input.load_torque_Nm[k - 1];
      // torque that the bench would have to add at the rotor, beyond the measured load
      const T lacking = (now.load_torque_Nm - load) / p.gear_ratio;
      return lacking * input_per_torque(s.input.kind, p, bus_at(s.input, k - 1));
    }
    default:
      return T(kMissing);
  }
}

// Steady points: two steps so long that the winding has settled in each.
template <typename T>
std::vector<std::vector<T>> steady_outputs(const AxisSetup& s, const DriveParams<T>& p,
                                           const EffectSet<T>& effects) {
  constexpr double kCreep_rad_s = 1e-6;  // slow enough that nothing but dry friction notices; a choice
  const AxisInput& in = s.input;
  const DriveSim<T> sim(p, effects, kSettled_s);
  std::vector<T> needed(in.time_s.size());
  for (std::size_t k = 0; k < needed.size(); ++k) {
    DriveState<T> state = sim.initial_state();
    const double gear = value_of(p.gear_ratio);
    const double speed =
        in.imposed_velocity_rad_s[k] != 0.0 ? in.imposed_velocity_rad_s[k] : s.approach[k] * kCreep_rad_s;
    DriveInput<T> drive{.kind = in.kind, .setpoint = T(in.command[k])};
    drive.speed_is_imposed = drive.motor_torque_is_needed = true;
    drive.imposed_start_rad_s = drive.imposed_end_rad_s = speed * gear;
    drive.bus_is_measured = !in.bus_voltage_V.empty();
    drive.bus_voltage_V = bus_at(in, k);
    if (!in.load_torque_Nm.empty()) drive.tau_outside_Nm = in.load_torque_Nm[k] / p.gear_ratio;
    DriveResult<T> r;
    for (int pass = 0; pass < 2; ++pass) {
      state.omega_rotor_rad_s = T(speed * gear);
      // the middle of the step is at the measured angle
      if (!s.position.empty())
        state.theta_rotor_rad = s.position[k] * p.gear_ratio - 0.5 * kSettled_s * speed * gear;
      r = sim.advance(state, drive, 1);
    }
    needed[k] = in.command[k] + (r.mean_outside_torque_Nm - drive.tau_outside_Nm) *
                                    input_per_torque(in.kind, p, bus_at(in, k));
  }
  return {needed};
}

}  // namespace

template <typename T>
std::vector<std::vector<T>> axis_outputs(const AxisSetup& setup, const DriveParams<T>& params,
                                         const EffectSet<T>& effects, double step_s) {
  if (setup.steady) return steady_outputs(setup, params, effects);
  const std::vector<AxisSample<T>> samples = run_axis(params, effects, setup.input, {.step_s = step_s});
  return observed<T>(setup, setup.input.time_s, [&](const Observation& how, std::size_t k) {
    return quantity_of(setup, params, how.quantity, samples, k);
  });
}

template std::vector<std::vector<double>> axis_outputs(const AxisSetup&, const DriveParams<double>&,
                                                       const EffectSet<double>&, double);
template std::vector<std::vector<Jet>> axis_outputs(const AxisSetup&, const DriveParams<Jet>&,
                                                    const EffectSet<Jet>&, double);

}  // namespace omnihil
