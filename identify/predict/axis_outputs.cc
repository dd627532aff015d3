#include "identify/predict/axis_outputs.h"

#include "identify/predict/settled_points.h"

namespace omnihil {
namespace {

template <typename T>
T quantity_of(const AxisSetup& s, const DriveParams<T>& p, Quantity what, const AxisSample<T>& now,
              std::size_t k) {
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
      if (k == 0 && !s.steady) return T(0);
      const std::size_t from = s.steady ? k : k - 1;  // where what was given began
      const auto given = [&](const std::vector<double>& of) { return of.empty() ? 0.0 : of[from]; };
      // torque that the bench would have to add at the rotor, beyond the measured load
      const T lacking = (now.load_torque_Nm - given(s.input.load_torque_Nm)) / p.gear_ratio;
      return lacking * input_per_torque(s.input.kind, p, given(s.input.bus_voltage_V));
    }
    default:
      return T(kMissing);
  }
}

// A settled point as an input in time: held until the winding has settled, and once more, by a step each. The middle of a step
// is at the measured angle.
void set_settled_point(const AxisSetup& s, std::size_t k, AxisInput& point) {
  constexpr double kCreep_rad_s = 1e-6;  // slow enough that nothing but dry friction notices; a choice
  const AxisInput& in = s.input;
  const double measured = in.imposed_velocity_rad_s[k];
  const double speed = measured != 0.0 ? measured : s.approach[k] * kCreep_rad_s;
  const auto hold = [&](const std::vector<double>& of, std::vector<double>& held, double less = 0.0) {
    if (!of.empty()) held.assign(3, of[k] - less);
  };
  point.kind = in.kind;
  point.time_s = {0.0, kSettled_s, 2.0 * kSettled_s};
  hold(in.command, point.command);
  hold(in.bus_voltage_V, point.bus_voltage_V);
  point.imposed_velocity_rad_s.assign(3, speed);
  point.command_is_compared = in.command_is_compared;
  hold(in.load_torque_Nm, point.load_torque_Nm);
  hold(s.position, point.measured_position_rad, 0.5 * kSettled_s * speed);
}

}  // namespace

template <typename T>
std::vector<std::vector<T>> axis_outputs(const AxisSetup& setup, const DriveParams<T>& params,
                                         const EffectSet<T>& effects, double step_s) {
  const std::vector<double>& time_s = setup.input.time_s;
  std::vector<std::vector<T>> out(setup.seen.size());
  for (std::vector<T>& signal : out) signal.reserve(time_s.size());
  const auto see = [&](std::size_t k, const AxisSample<T>& now) {
    for (std::size_t s = 0; s < out.size(); ++s)
      out[s].push_back(quantity_of(setup, params, setup.seen[s].quantity, now, k));
  };
  if (setup.steady) {
    AxisInput point;
    const auto settled = [&](std::size_t k) -> const AxisInput& {
      set_settled_point(setup, k, point);
      return point;
    };
    visit_axis_ends<T>(params, effects, time_s.size(), settled, {.step_s = kSettled_s}, see);
  } else {
    visit_axis<T>(params, effects, setup.input, {.step_s = step_s}, see);
  }
  for (std::size_t s = 0; s < out.size(); ++s) {
    const Observation& how = setup.seen[s];
    if (how.view == View::kDifference)
      out[s] = observed<T>(how, time_s, [&](std::size_t k) { return out[s][k]; });
  }
  return out;
}

template std::vector<std::vector<double>> axis_outputs(const AxisSetup&, const DriveParams<double>&,
                                                       const EffectSet<double>&, double);
template std::vector<std::vector<Jet>> axis_outputs(const AxisSetup&, const DriveParams<Jet>&,
                                                    const EffectSet<Jet>&, double);

}  // namespace omnihil
