// Ports with physically plausible contents, for tests that hold for every effect of a place; and what an
// effect may have changed in them, with its parity under reversal of motion, current and voltage.
#pragma once
#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "sim/law/effect_registry.h"
#include "sim/law/effect_set.h"
#include "sim/law/random.h"
#include "sim/robot/per_wheel.h"

namespace omnihil::test {

struct Draw {
  std::uint64_t seed = 0;
  mutable std::uint64_t counter = 0;
  double motion = 1.0;  // what goes both ways (speed, current) times this
  double operator()(double from, double to) const {
    return (from + (to - from) * uniform(seed, 7, counter++)) * (from == -to ? motion : 1.0);
  }
};

template <typename T>
struct Changed {
  T value;
  bool odd;  // reversed motion: reversed sign
};

// The same numbers for either scalar; `sign` -1 gives the reversed motion.
template <typename T>
void fill(CommandPort<T>& p, const Draw& draw, double sign, CommandHistory& history) {
  for (int n = 0; n < 40; ++n) history.push(n * 1e-3, sign * draw(-1, 1));
  p.history = &history;
  p.now_s = 0.0391;
  p.dt_s = 5e-5;
  p.setpoint = T(history.newest().value);
  p.position_rad = T(sign * draw(-1, 1));
}
template <typename T>
std::vector<Changed<T>> changes(const CommandPort<T>& p) {
  return {{p.setpoint, true}, {p.duty_limit_ratio, false}};
}

template <typename T>
void fill(SupplyPort<T>& p, const Draw& draw, double, CommandHistory&) {
  p.bus_current_A = T(draw(0, 20));
  p.dt_s = 5e-5;
  p.bus_voltage_V = T(draw(12, 25));
}
template <typename T>
std::vector<Changed<T>> changes(const SupplyPort<T>& p) {
  return {{p.bus_voltage_V, false}};
}

template <typename T>
void fill(BridgePort<T>& p, const Draw& draw, double sign, CommandHistory&) {
  p.duty_ratio = T(sign * draw(-1, 1));
  p.bus_voltage_V = T(draw(12, 25));
  p.current_A = T(sign * draw(-10, 10));
  p.back_emf_V = T(sign * draw(-10, 10));
  p.temperature_rise_K = T(draw(0, 80));
  p.resistance_ohm = T(draw(0.3, 2));
  p.pwm_frequency_Hz = T(draw(1e4, 5e4));
  p.dt_s = 5e-5;
  p.voltage_V = p.duty_ratio * p.bus_voltage_V;
}
template <typename T>
std::vector<Changed<T>> changes(const BridgePort<T>& p) {
  return {{p.voltage_V, true}, {p.inverse_current_limit_per_A, false}};
}

template <typename T>
void fill(WindingPort<T>& p, const Draw& draw, double sign, CommandHistory&) {
  p.current_A = T(sign * draw(-10, 10));
  p.omega_rotor_rad_s = T(sign * draw(-300, 300));
  p.theta_rotor_rad = T(draw(-10, 10));
  p.heat_W = T(draw(0, 30));
  p.pole_pairs = 8;
  p.wheel = static_cast<int>(draw(0, kMaxWheels));
  p.dt_s = 5e-5;
  p.resistance_ohm = T(draw(0.3, 2));
  p.inductance_H = T(draw(1e-4, 1e-3));
  p.torque_constant_Nm_per_A = p.back_emf_V_s_per_rad = T(draw(0.02, 0.04));
  p.temperature_rise_K = T(draw(0, 80));
}
template <typename T>
std::vector<Changed<T>> changes(const WindingPort<T>& p) {
  return {{p.resistance_ohm, false},       {p.inductance_H, false},     {p.torque_constant_Nm_per_A, false},
          {p.back_emf_V_s_per_rad, false}, {p.back_emf_offset_V, true}, {p.temperature_rise_K, false}};
}

template <typename T>
void fill(TorquePort<T>& p, const Draw& draw, double sign, CommandHistory&) {
  p.gear_ratio = T(draw(1, 4));
  p.omega_rotor_rad_s = T(sign * draw(-300, 300));
  p.theta_rotor_rad = T(draw(-10, 10));
  p.omega_output_rad_s = p.omega_rotor_rad_s / p.gear_ratio;
  p.theta_output_rad = p.theta_rotor_rad / p.gear_ratio;
  p.tau_motor_Nm = T(sign * draw(-0.2, 0.2));
  p.tau_load_Nm = T(sign * draw(-0.1, 0.1));
  p.inertia_kg_m2 = T(draw(1e-5, 1e-4));
  p.dt_s = 5e-5;
  p.friction_positive_Nm = p.friction_negative_Nm = T(draw(0, 0.01));
  p.viscous_positive_Nm_s_per_rad = p.viscous_negative_Nm_s_per_rad = T(draw(0, 1e-5));
}
template <typename T>
std::vector<Changed<T>> changes(const TorquePort<T>& p) {
  return {{p.tau_Nm, true},
          {p.friction_positive_Nm + p.friction_negative_Nm, false},
          {p.friction_positive_Nm - p.friction_negative_Nm, true},
          {p.viscous_positive_Nm_s_per_rad + p.viscous_negative_Nm_s_per_rad, false},
          {p.viscous_positive_Nm_s_per_rad - p.viscous_negative_Nm_s_per_rad, true}};
}

template <typename T>
void fill(ShaftPort<T>& p, const Draw& draw, double sign, CommandHistory&) {
  p.twist_rad = T(sign * draw(-0.01, 0.01));
  p.twist_rate_rad_s = T(sign * draw(-1, 1));
  p.gear_ratio = T(draw(1, 4));
  p.dt_s = 5e-5;
}
template <typename T>
std::vector<Changed<T>> changes(const ShaftPort<T>& p) {
  return {{p.gap_rad, false}, {p.compliance_rad_per_Nm, false}, {p.damping_Nm_s_per_rad, false}};
}

template <typename T>
void fill(ContactPort<T>& p, const Draw& draw, double sign, CommandHistory&) {
  p.wheel = static_cast<int>(draw(0, kMaxWheels));
  p.wheel_radius_m = T(draw(0.02, 0.04));
  p.omega_wheel_rad_s = T(sign * draw(-100, 100));
  p.theta_wheel_rad = T(draw(-10, 10));
  p.v_longitudinal_m_s = p.omega_wheel_rad_s * p.wheel_radius_m;
  p.v_lateral_m_s = T(sign * draw(-3, 3));
  p.load_N = T(draw(3, 8));
  p.dt_s = 1e-3;
}
template <typename T>
std::vector<Changed<T>> changes(const ContactPort<T>& p) {
  return {{p.wheel_radius_m, false},      {p.slip_speed_m_s, false}, {p.grip_coefficient, false},
          {p.force_longitudinal_N, true}, {p.force_lateral_N, true}, {p.friction_wheel_Nm, false}};
}

template <typename T>
void fill(BodyPort<T>& p, const Draw& draw, double sign, CommandHistory&) {
  p.v_forward_m_s = T(sign * draw(-3, 3));
  p.v_left_m_s = T(sign * draw(-3, 3));
  p.omega_body_rad_s = T(sign * draw(-10, 10));
  p.yaw_rad = T(draw(-3, 3));
  p.dribbler_rad_s = T(draw(0, 800));
  p.dt_s = 1e-3;
  p.mass_kg = T(draw(2, 3));
  p.yaw_inertia_kg_m2 = T(draw(0.01, 0.02));
}
template <typename T>
std::vector<Changed<T>> changes(const BodyPort<T>& p) {
  return {{p.mass_kg, false},
          {p.yaw_inertia_kg_m2, false},
          {p.center_of_mass_x_m, false},
          {p.center_of_mass_y_m, false},
          {p.force_x_N, true},
          {p.force_y_N, true},
          {p.torque_z_Nm, true}};
}

template <typename T>
void fill(SensorPort<T>& p, const Draw& draw, double sign, CommandHistory&) {
  p.theta_rotor_rad = p.encoder_angle_rad = T(draw(-3, 3));
  p.omega_rotor_rad_s = p.measured_speed_rad_s = T(sign * draw(-300, 300));
  p.travel_rad = T(draw(0, 0.3));
  p.counts_per_turn = T(4096);
  p.time_s = 1.0;
  p.dt_s = 1e-3;
}
template <typename T>
std::vector<Changed<T>> changes(const SensorPort<T>& p) {
  return {{p.encoder_angle_rad - p.theta_rotor_rad, true}, {p.measured_speed_rad_s, true}};
}

template <typename T>
void fill(TimingPort<T>& p, const Draw& draw, double, CommandHistory&) {
  p.what = draw(0, 1) < 0.5 ? Stamped::kDriveSensors : Stamped::kVision;
  p.time_s = 1.0;
  p.dt_s = 1e-3;
}
template <typename T>
std::vector<Changed<T>> changes(const TimingPort<T>& p) {
  return {{p.age_s, false}};
}

template <typename T>
constexpr Place place_of(const CommandPort<T>&) {
  return Place::kCommand;
}
template <typename T>
constexpr Place place_of(const SupplyPort<T>&) {
  return Place::kSupply;
}
template <typename T>
constexpr Place place_of(const BridgePort<T>&) {
  return Place::kBridge;
}
template <typename T>
constexpr Place place_of(const WindingPort<T>&) {
  return Place::kWinding;
}
template <typename T>
constexpr Place place_of(const TorquePort<T>&) {
  return Place::kTorque;
}
template <typename T>
constexpr Place place_of(const ShaftPort<T>&) {
  return Place::kShaft;
}
template <typename T>
constexpr Place place_of(const ContactPort<T>&) {
  return Place::kContact;
}
template <typename T>
constexpr Place place_of(const BodyPort<T>&) {
  return Place::kBody;
}
template <typename T>
constexpr Place place_of(const SensorPort<T>&) {
  return Place::kSensor;
}
template <typename T>
constexpr Place place_of(const TimingPort<T>&) {
  return Place::kTiming;
}

// Calls visit(function, Port<T>{}) for every place at which the effect acts.
template <typename T, typename Visit>
void for_each_place(const EffectEntry& entry, Visit visit) {
  const ApplyFunctions<T>& f = entry.functions<T>();
  const auto at = [&](auto function, auto port) {
    if (function != nullptr) visit(function, port);
  };
  at(f.command, CommandPort<T>{});
  at(f.supply, SupplyPort<T>{});
  at(f.bridge, BridgePort<T>{});
  at(f.winding, WindingPort<T>{});
  at(f.torque, TorquePort<T>{});
  at(f.shaft, ShaftPort<T>{});
  at(f.contact, ContactPort<T>{});
  at(f.body, BodyPort<T>{});
  at(f.sensor, SensorPort<T>{});
  at(f.timing, TimingPort<T>{});
}

// One call of one law on the contents number `seed`; states start at their initial values.
template <typename T, typename Function, typename Port>
Port applied(const EffectEntry& entry, Function function, Port port, std::span<const T> params,
             std::uint64_t seed, double sign = 1.0, double motion = 1.0) {
  CommandHistory history;
  fill(port, Draw{.seed = seed, .motion = motion}, sign, history);
  std::vector<T> states;
  for (const EffectState& s : entry.info->states) states.push_back(T(s.initial));
  function(entry.context, law_params(entry, params).data(), states.data(), port);
  if constexpr (requires { port.history; }) port.history = nullptr;
  return port;
}

inline std::vector<Jet> as_jets(std::span<const double> values, int unknown) {
  std::vector<Jet> jets;
  for (std::size_t i = 0; i < values.size(); ++i) {
    jets.push_back(static_cast<int>(i) == unknown ? Jet(values[i], 0) : Jet(values[i]));
  }
  return jets;
}

class EveryEffect : public ::testing::TestWithParam<const EffectEntry*> {
 protected:
  const EffectEntry& entry() const { return *GetParam(); }
  const EffectInfo& info() const { return *GetParam()->info; }
};

}  // namespace omnihil::test
