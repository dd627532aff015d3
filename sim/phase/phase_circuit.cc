#include "sim/phase/phase_circuit.h"

#include <cassert>
#include <cmath>
#include <cstddef>

namespace omnihil {
namespace {

constexpr int kMaxParts = 12;  // of one step; each ends with a diode's current at zero

// What conducts, and by which source.
struct Conduction {
  std::array<const LegSource*, 3> source{};  // null: floats
  int count = 0;
};

// Star voltage over the conducting phases, with back-EMF e.
double star_voltage_V(const Conduction& c, const std::array<double, 3>& e) {
  double sum = 0.0;
  for (std::size_t x = 0; x < 3; ++x)
    if (c.source[x]) sum += c.source[x]->volt_V - e[x];
  return sum / c.count;
}

// Phases without current whose floating voltage opens a diode join, the most violating one first.
// A barred phase has just been found not to.
void join_floating(Conduction& c, const std::array<Leg, 3>& legs, const std::array<double, 3>& e,
                   std::size_t barred) {
  if (c.count == 0) {
    // No reference for the star point: two diodes conduct if some pair's back-EMF exceeds what they need.
    std::size_t from = 0, to = 1;
    double best_V = 0.0;
    for (std::size_t x = 0; x < 3; ++x)
      for (std::size_t y = 0; y < 3; ++y) {
        if (x == y || x == barred || y == barred) continue;
        // current out of x (its upper diode), into y (its lower one)
        const double excess_V = e[x] - e[y] + legs[y].forward.volt_V - legs[x].backward.volt_V;
        if (excess_V > best_V) best_V = excess_V, from = x, to = y;
      }
    if (best_V <= 0.0) return;
    c.source[from] = &legs[from].backward;
    c.source[to] = &legs[to].forward;
    c.count = 2;
  }
  while (c.count < 3) {
    const double star_V = star_voltage_V(c, e);
    std::size_t joins = 3;
    double worst_V = 0.0;
    for (std::size_t x = 0; x < 3; ++x) {
      if (c.source[x] || x == barred) continue;
      const double floating_V = star_V + e[x];
      const double above_V = floating_V - legs[x].backward.volt_V;
      const double below_V = legs[x].forward.volt_V - floating_V;
      if (above_V > worst_V) worst_V = above_V, joins = x;
      if (below_V > worst_V) worst_V = below_V, joins = x;
    }
    if (joins == 3) return;
    const bool upper = star_V + e[joins] > legs[joins].backward.volt_V;
    c.source[joins] = upper ? &legs[joins].backward : &legs[joins].forward;
    ++c.count;
  }
}

Conduction conduction_of(const PhaseState& s, const std::array<Leg, 3>& legs, const std::array<double, 3>& e,
                         std::size_t barred) {
  Conduction c;
  for (std::size_t x = 0; x < 3; ++x) {
    const double i = s.current_A[x];
    if (legs[x].always || i > 0.0)
      c.source[x] = &legs[x].forward;
    else if (i < 0.0)
      c.source[x] = &legs[x].backward;
    else
      continue;
    ++c.count;
  }
  if (c.count < 3) join_floating(c, legs, e, barred);
  return c;
}

// One part with fixed conduction.
struct Part {
  double h_s, decay;
  double mean_decay;                  // (1 - decay) tau / h
  double omega_mid;                   // rad/s
  std::array<double, 3> constant{};   // K_x, V s/rad
  std::array<double, 3> settled_A{};  // where the current would go
  std::array<double, 3> mean_A{};
};

void solve(const PhaseCircuit& c, const PhaseState& s, const Conduction& on, const PhaseInput& in, Part& p) {
  p.mean_decay = (1.0 - p.decay) * c.time_constant_s / p.h_s;
  const double gain = (1.0 - p.mean_decay) * c.conductance_per_ohm;
  double mean_V = 0.0, mean_K = 0.0;
  constexpr std::array<double, 4> kShare = {0.0, 1.0, 1.0 / 2.0, 1.0 / 3.0};
  const double share = kShare[static_cast<std::size_t>(on.count)];
  for (std::size_t x = 0; x < 3; ++x)
    if (on.source[x]) mean_V += on.source[x]->volt_V, mean_K += p.constant[x];
  mean_V *= share;
  mean_K *= share;
  // mean i_x = g (V_x - mean V - (K_x - mean K) w) + phi i0_x;  torque = T0 - G w
  double torque = 0.0, damping = 0.0;
  std::array<double, 3> drive_V{}, emf{};
  for (std::size_t x = 0; x < 3; ++x) {
    if (!on.source[x]) continue;
    drive_V[x] = on.source[x]->volt_V - mean_V;
    emf[x] = p.constant[x] - mean_K;
    torque += p.constant[x] * (gain * drive_V[x] + p.mean_decay * s.current_A[x]);
    damping += emf[x] * emf[x];
  }
  damping *= gain;
  if (in.speed_is_imposed) {
    p.omega_mid = s.omega_rotor_rad_s;
  } else {
    // w_mid = w_0 + h / (2 J) (T0 - G w_mid - b w_mid - tau_load)
    const double twice_inertia = 2.0 * c.inertia_kg_m2;
    p.omega_mid = (twice_inertia * s.omega_rotor_rad_s + p.h_s * (torque - in.tau_load_Nm)) /
                  (twice_inertia + p.h_s * (damping + c.viscous_Nm_s_per_rad));
  }
  for (std::size_t x = 0; x < 3; ++x) {
    if (!on.source[x]) continue;
    p.settled_A[x] = (drive_V[x] - emf[x] * p.omega_mid) * c.conductance_per_ohm;
    p.mean_A[x] = p.settled_A[x] + (s.current_A[x] - p.settled_A[x]) * p.mean_decay;
  }
}

// Where the first diode's current reaches zero within the part; its phase, or 3.
std::size_t first_zero(const PhaseCircuit& c, const PhaseState& s, const std::array<Leg, 3>& legs,
                       const Conduction& on, const Part& p, double& time_s) {
  std::size_t first = 3;
  for (std::size_t x = 0; x < 3; ++x) {
    if (!on.source[x] || legs[x].always) continue;
    const double i0 = s.current_A[x], settled = p.settled_A[x];
    const double end = settled + (i0 - settled) * p.decay;
    const bool positive = on.source[x] == &legs[x].forward;
    if (positive ? end >= 0.0 : end <= 0.0) continue;
    // i_inf + (i_0 - i_inf) exp(-t / tau) = 0
    const double t = i0 == 0.0 ? 0.0 : c.time_constant_s * std::log1p(-i0 / settled);
    if (first == 3 || t < time_s) first = x, time_s = t;
  }
  return first;
}

void book(const PhaseState& s, const Conduction& on, const PhaseInput& in, const Part& p, PhaseFlow& flow) {
  // integral of (i_inf + d exp(-t / tau))^2 = i_inf^2 h + 2 i_inf d phi h + d^2 (1 + decay) phi h / 2
  const double ring = p.mean_decay * p.h_s, ring2 = 0.5 * (1.0 + p.decay) * ring;
  double square = 0.0, torque = 0.0, bus_C = 0.0, drop_J = 0.0;
  for (std::size_t x = 0; x < 3; ++x) {
    if (!on.source[x]) continue;
    const double d = s.current_A[x] - p.settled_A[x];
    square += p.settled_A[x] * (p.settled_A[x] * p.h_s + 2.0 * d * ring) + d * d * ring2;
    torque += p.constant[x] * p.mean_A[x];
    const double charge_C = p.mean_A[x] * p.h_s;
    flow.charge_C[x] += charge_C;
    bus_C += on.source[x]->bus_share * charge_C;
    drop_J += on.source[x]->drop_V * charge_C;
  }
  flow.time_s += p.h_s;
  flow.square_A2_s += square;
  flow.bus_charge_C += bus_C;
  flow.bus_J += bus_C * in.bus_voltage_V;
  flow.drop_J += drop_J;
  flow.impulse_Nm_s += torque * p.h_s;
  flow.mechanical_J += torque * p.omega_mid * p.h_s;
  flow.angle_rad += p.omega_mid * p.h_s;
}

void finish(PhaseState& s, const Conduction& on, const PhaseInput& in, const Part& p) {
  for (std::size_t x = 0; x < 3; ++x)
    if (on.source[x]) s.current_A[x] = p.settled_A[x] + (s.current_A[x] - p.settled_A[x]) * p.decay;
  s.theta_rotor_rad += p.omega_mid * p.h_s;
  if (!in.speed_is_imposed) s.omega_rotor_rad_s = 2.0 * p.omega_mid - s.omega_rotor_rad_s;
}

// The phase's current is exactly zero; the others keep their sum at zero.
void extinguish(PhaseState& s, std::size_t x) {
  const double rest = 0.5 * s.current_A[x];
  s.current_A[x] = 0.0;
  double& y = s.current_A[(x + 1) % 3];
  double& z = s.current_A[(x + 2) % 3];
  if (y == 0.0 || z == 0.0) {
    y = z = 0.0;
  } else {
    y += rest;
    z = -y;
  }
}

}  // namespace

PhaseCircuit make_phase_circuit(const PhaseMotor<double>& m, double switch_resistance_ohm, double step_s,
                                double extra_inertia_kg_m2) {
  PhaseCircuit c;
  c.step_s = step_s;
  c.winding_ohm = m.resistance_ohm;
  c.device_ohm = switch_resistance_ohm;
  c.inductance_H = 0.5 * (m.inductance_d_H + m.inductance_q_H);
  c.conductance_per_ohm = 1.0 / (c.winding_ohm + c.device_ohm);
  c.time_constant_s = c.inductance_H * c.conductance_per_ohm;
  c.decay = std::exp(-step_s / c.time_constant_s);
  c.pole_pairs = m.pole_pairs;
  c.back_emf_V_s_per_rad = m.pole_pairs * m.flux_linkage_Wb;
  c.inertia_kg_m2 = m.rotor_inertia_kg_m2 + extra_inertia_kg_m2;
  c.viscous_Nm_s_per_rad = m.viscous_friction_Nm_s_per_rad;
  c.shape = m.back_emf;
  assert(step_s > 0.0 && c.time_constant_s > 0.0 && c.inertia_kg_m2 > 0.0);
  return c;
}

void advance_circuit(const PhaseCircuit& c, PhaseState& s, const std::array<Leg, 3>& legs,
                     const PhaseInput& in, double h_s, PhaseFlow& flow) {
  double left_s = h_s;
  std::size_t barred = 3;
  for (int part = 0; part < kMaxParts && left_s > 0.0; ++part) {
    Part p;
    p.h_s = left_s;
    p.decay = left_s == c.step_s ? c.decay : std::exp(-left_s / c.time_constant_s);
    const double theta_mid = s.theta_rotor_rad + 0.5 * left_s * s.omega_rotor_rad_s;
    p.constant = back_emf_shape(c.shape, c.pole_pairs * theta_mid);
    std::array<double, 3> emf_V;
    for (std::size_t x = 0; x < 3; ++x) {
      p.constant[x] *= c.back_emf_V_s_per_rad;
      emf_V[x] = p.constant[x] * s.omega_rotor_rad_s;
    }
    const Conduction on = conduction_of(s, legs, emf_V, barred);
    solve(c, s, on, in, p);
    double zero_s = left_s;
    const std::size_t zero = part + 1 < kMaxParts ? first_zero(c, s, legs, on, p, zero_s) : 3;
    if (zero == 3) {
      book(s, on, in, p, flow);
      finish(s, on, in, p);
      return;
    }
    ++flow.events;
    // Twice: the speed of mid step changes a little when the part becomes shorter.
    for (int refine = 0; refine < 2 && zero_s > 0.0; ++refine) {
      p.h_s = zero_s;
      p.decay = std::exp(-zero_s / c.time_constant_s);
      solve(c, s, on, in, p);
      const double i0 = s.current_A[zero], settled = p.settled_A[zero];
      const double t = -i0 / settled > -1.0 ? c.time_constant_s * std::log1p(-i0 / settled) : zero_s;
      if (refine == 0 && t > 0.0 && t < left_s) zero_s = t;
    }
    barred = zero_s > 0.0 ? 3 : zero;
    if (zero_s > 0.0) {
      book(s, on, in, p, flow);
      finish(s, on, in, p);
      left_s -= zero_s;
    }
    extinguish(s, zero);
  }
}

}  // namespace omnihil
