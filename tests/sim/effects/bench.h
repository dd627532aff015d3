// A small brushless drive on a bench (EC 45 flat 30 W data sheet figures, no friction) and records to feed it
// with.
#pragma once
#include <vector>

#include "sim/bench/axis_sim.h"
#include "sim/bench/excitation.h"
#include "sim/law/effect_registry.h"

namespace omnihil::test {

inline DriveParams<double> small_drive() {
  DriveParams<double> p;
  p.resistance_ohm = 1.2;
  p.inductance_H = 5.6e-4;
  p.torque_constant_Nm_per_A = 0.0255;
  p.rotor_inertia_kg_m2 = 9.25e-6;
  p.load_inertia_kg_m2 = 2e-5;
  p.viscous_friction_Nm_s_per_rad = 5e-6;
  p.supply_voltage_V = 12.0;
  p.pole_pairs = 8;
  p.slots = 12;
  return p;
}

inline AxisInput excite(Excitation kind, double amplitude, double duration_s, double rate_Hz = 1000.0) {
  AxisInput in;
  const int count = static_cast<int>(duration_s * rate_Hz) + 1;
  for (int n = 0; n < count; ++n) {
    in.time_s.push_back(n / rate_Hz);
    in.command.push_back(amplitude * excitation_at(kind, in.time_s.back(), {.duration_s = duration_s}));
  }
  return in;
}

inline AxisInput held(CommandKind kind, double value, double duration_s, double rate_Hz = 1000.0) {
  AxisInput in;
  in.kind = kind;
  const int count = static_cast<int>(duration_s * rate_Hz) + 1;
  for (int n = 0; n < count; ++n) in.time_s.push_back(n / rate_Hz);
  in.command.assign(in.time_s.size(), value);
  return in;
}

inline EffectUse use_of(std::string_view id, std::vector<double> leading_values) {
  EffectUse use = neutral_use(*find_effect(id));
  std::copy(leading_values.begin(), leading_values.end(), use.values.begin());
  return use;
}

inline EffectSet<double> with(std::vector<EffectUse> uses) { return EffectSet<double>(uses); }
inline EffectSet<double> nothing() { return EffectSet<double>(); }

}  // namespace omnihil::test
