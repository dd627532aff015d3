#include "sim/drive/phase_circuit.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>

#include "sim/drive/phase_conduction.h"

namespace omnihil {
namespace {

using namespace phase_detail;

constexpr int kMaxParts = 12;  // of one step; each ends with a diode's current at zero
// A stretch of time with fixed conduction.
struct Part : PhaseStretch {
  double omega_mid_rad_s = 0.0;
  Three settled_A{};  // where each current would go
};

void set_length(const PhaseCircuit& c, PhaseStretch& p, double h_s, double decay) {
  p.h_s = h_s;
  p.decay = decay;
  p.mean_decay = h_s > 0.0 ? (1.0 - decay) * c.time_constant_s / h_s : 1.0;
}

// What drives the phases, whatever the part's length.
struct Drive {
  Three constant;        // K_x, V s/rad
  Three volt_V, emf;     // V_x - mean V and K_x - mean K over the conducting phases; 0 of floating ones
  double driven = 0.0;   // sum K_x volt_x
  double kept = 0.0;     // sum K_x i0_x
  double damping = 0.0;  // sum emf_x^2
};

[[gnu::always_inline]] inline Drive drive_of(const Conduction& on, const Three& constant,
                                             const Three& current_A) {
  Drive d;
  d.constant = constant;
  const double mean_V = mean_of(on, on.volt_V), mean_K = mean_of(on, constant);
  each_phase([&](auto x) {
    d.volt_V[x] = on.on[x] * (on.volt_V[x] - mean_V);
    d.emf[x] = on.on[x] * (constant[x] - mean_K);
    d.driven += constant[x] * d.volt_V[x];
    d.kept += constant[x] * current_A[x];
    d.damping += d.emf[x] * d.emf[x];
  });
  return d;
}

// Fills speed, settled and mean currents for the part's length.
[[gnu::always_inline]] inline void solve(const PhaseCircuit& c, const PhaseState& s, const Drive& d,
                                         const PhaseInput& in, Part& p) {
  p.omega_mid_rad_s = s.omega_rotor_rad_s;
  if (!in.speed_is_imposed) {
    // mean i_x = g (volt_x - emf_x w) + phi i0_x;  torque = T0 - G w
    const double gain = (1.0 - p.mean_decay) * c.conductance_per_ohm;
    const double torque = gain * d.driven + p.mean_decay * d.kept;
    const double twice_inertia = 2.0 * c.inertia_kg_m2;
    // w_mid = w_0 + h / (2 J) (T0 - G w_mid - b w_mid - tau_load)
    p.omega_mid_rad_s = (twice_inertia * s.omega_rotor_rad_s + p.h_s * (torque - in.tau_load_Nm)) /
                        (twice_inertia + p.h_s * (gain * d.damping + c.viscous_Nm_s_per_rad));
  }
  each_phase(
      [&](auto x) { p.settled_A[x] = (d.volt_V[x] - d.emf[x] * p.omega_mid_rad_s) * c.conductance_per_ohm; });
}

// What is left behind a diode's current that has reached zero in `phase`.
struct Rest {
  std::size_t phase = kNone;  // none has
  double after_s = 0.0;
  PhaseStretch left;
};

// Currents that would turn within a stretch, which a diode cannot carry, and where each is going.
struct Turning {
  std::array<bool, 3> turns;
  Three settled_A;
  bool any() const { return turns[0] || turns[1] || turns[2]; }
};

// The diode whose current reaches zero first of those that would turn within the stretch, which is shortened to there.
Rest shorten(const PhaseCircuit& c, const Three& current_A, const Turning& turning, PhaseStretch& p) {
  Rest rest;
  double remaining = 1.0;  // exp(-t / tau) there
  for (std::size_t x = 0; x < 3; ++x) {
    if (!turning.turns[x]) continue;
    // i_inf + (i_0 - i_inf) exp(-t / tau) = 0
    const double i0 = current_A[x], settled = turning.settled_A[x];
    const double there = i0 == 0.0 ? 1.0 : settled / (settled - i0);
    if (rest.phase == kNone || there > remaining) rest.phase = x, remaining = there;
  }
  if (rest.phase == kNone) return rest;
  rest.after_s = -c.time_constant_s * std::log(remaining);
  set_length(c, rest.left, p.h_s - rest.after_s, p.decay / remaining);
  set_length(c, p, rest.after_s, remaining);
  return rest;
}

// Of the star point against the bus's minus.
double star_of(const Conduction& on, const std::array<Leg, 3>& legs, const Three& emf_V, double bus_V) {
  if (on.count > 0) return mean_of(on, on.volt_V) - mean_of(on, emf_V);
  double lowest_V = legs[0].forward.volt_V - emf_V[0], highest_V = legs[0].backward.volt_V - emf_V[0];
  for (std::size_t x = 1; x < 3; ++x) {
    lowest_V = std::max(lowest_V, legs[x].forward.volt_V - emf_V[x]);
    highest_V = std::min(highest_V, legs[x].backward.volt_V - emf_V[x]);
  }
  return std::max(lowest_V, std::min(highest_V, 0.5 * bus_V - (emf_V[0] + emf_V[1] + emf_V[2]) / 3.0));
}

// What floats follows the star point; what conducts is its source behind R_on.
[[gnu::always_inline]] inline void book_voltages(const PhaseCircuit& c, const std::array<Leg, 3>& legs,
                                                 const Conduction& on, const Three& constant,
                                                 const PhaseInput& in, const Part& p, const Three& charge_C,
                                                 PhaseFlow& flow) {
  const double w = p.omega_mid_rad_s;
  const Three emf_V = {constant[0] * w, constant[1] * w, constant[2] * w};
  const double star_V = on.count == 3 ? 0.0 : star_of(on, legs, emf_V, in.bus_voltage_V);
  each_phase([&](auto x) {
    flow.leg_V_s[x] +=
        on.on[x] != 0.0 ? on.volt_V[x] * p.h_s - c.device_ohm * charge_C[x] : (star_V + emf_V[x]) * p.h_s;
  });
}

[[gnu::always_inline]] inline void book(const PhaseCircuit& c, const std::array<Leg, 3>& legs,
                                        const PhaseState& s, const Conduction& on, const Three& constant,
                                        const PhaseInput& in, const Part& p, PhaseFlow& flow) {
  // integral of (i_inf + d exp(-t / tau))^2 = i_inf^2 h + 2 i_inf d phi h + d^2 (1 + decay) phi h / 2
  const double ring_s = p.mean_decay * p.h_s, ring2_s = 0.5 * (1.0 + p.decay) * ring_s;
  double square = 0.0, torque = 0.0, bus_A = 0.0, drop_W = 0.0;
  Three charge_C;
  each_phase([&](auto x) {
    const double d = s.current_A[x] - p.settled_A[x], mean_A = p.settled_A[x] + d * p.mean_decay;
    square += p.settled_A[x] * (p.settled_A[x] * p.h_s + 2.0 * d * ring_s) + d * d * ring2_s;
    torque += constant[x] * mean_A;
    charge_C[x] = mean_A * p.h_s;
    flow.charge_C[x] += charge_C[x];
    bus_A += on.source[x]->bus_share * mean_A;
    drop_W += on.source[x]->drop_V * mean_A;
  });
  book_voltages(c, legs, on, constant, in, p, charge_C, flow);
  const double bus_C = bus_A * p.h_s, impulse_Nm_s = torque * p.h_s;
  flow.time_s += p.h_s;
  flow.square_A2_s += square;
  flow.bus_charge_C += bus_C;
  flow.bus_J += bus_C * in.bus_voltage_V;
  flow.drop_J += drop_W * p.h_s;
  flow.impulse_Nm_s += impulse_Nm_s;
  flow.mechanical_J += impulse_Nm_s * p.omega_mid_rad_s;
  flow.angle_rad += p.omega_mid_rad_s * p.h_s;
}

[[gnu::always_inline]] inline void finish(PhaseState& s, const PhaseInput& in, const Part& p) {
  each_phase([&](auto x) { s.current_A[x] = p.settled_A[x] + (s.current_A[x] - p.settled_A[x]) * p.decay; });
  s.theta_rotor_rad += p.omega_mid_rad_s * p.h_s;
  if (!in.speed_is_imposed) s.omega_rotor_rad_s = 2.0 * p.omega_mid_rad_s - s.omega_rotor_rad_s;
}

// The phase's current is exactly zero; the others keep their sum at zero.
void extinguish(PhaseState& s, std::size_t x) {
  const double rest_A = 0.5 * s.current_A[x];
  s.current_A[x] = 0.0;
  double& y = s.current_A[(x + 1) % 3];
  double& z = s.current_A[(x + 2) % 3];
  if (y == 0.0 || z == 0.0) {
    y = z = 0.0;
  } else {
    y += rest_A;
    z = -y;
  }
}

// One that floats within its diodes' voltages, while the other two carry the same current and nothing ends: apart because
// it costs a third. Does nothing and returns false if it is not that.
bool advance_pair(const PhaseCircuit& c, PhaseState& s, const std::array<Leg, 3>& legs, const Three& constant,
                  const PhaseInput& in, const PhaseStretch& p, std::size_t f, PhaseFlow& flow) {
  const Three& i = s.current_A;
  const std::size_t h = f == 0 ? 1 : 0, l = f == 2 ? 1 : 2;
  const LegSource& from = i[h] < 0.0 ? legs[h].backward : legs[h].forward;
  const LegSource& to = i[l] < 0.0 ? legs[l].backward : legs[l].forward;
  const double w = s.omega_rotor_rad_s, current_A = i[h];
  const double floating_V =
      0.5 * (from.volt_V + to.volt_V) + (constant[f] - 0.5 * (constant[h] + constant[l])) * w;
  if (floating_V > legs[f].backward.volt_V || floating_V < legs[f].forward.volt_V) return false;
  // L di/dt = drive - emf w - R i,   torque = 2 emf i
  const double drive_V = 0.5 * (from.volt_V - to.volt_V), emf = 0.5 * (constant[h] - constant[l]);
  double omega_mid = w;
  if (!in.speed_is_imposed) {
    const double gain = (1.0 - p.mean_decay) * c.conductance_per_ohm;
    const double torque = 2.0 * emf * (gain * drive_V + p.mean_decay * current_A);
    const double twice_inertia = 2.0 * c.inertia_kg_m2;
    omega_mid = (twice_inertia * w + p.h_s * (torque - in.tau_load_Nm)) /
                (twice_inertia + p.h_s * (2.0 * emf * emf * gain + c.viscous_Nm_s_per_rad));
  }
  const double settled_A = (drive_V - emf * omega_mid) * c.conductance_per_ohm, d = current_A - settled_A;
  const double end_A = settled_A + d * p.decay;
  if (!(legs[h].always && legs[l].always) && end_A * current_A < 0.0) return false;
  const double mean_A = settled_A + d * p.mean_decay, charge_C = mean_A * p.h_s;
  const double ring_s = p.mean_decay * p.h_s, impulse_Nm_s = 2.0 * emf * charge_C;
  const double bus_C = (from.bus_share - to.bus_share) * charge_C;
  flow.time_s += p.h_s;
  flow.charge_C[h] += charge_C;
  flow.charge_C[l] -= charge_C;
  flow.leg_V_s[h] += from.volt_V * p.h_s - c.device_ohm * charge_C;
  flow.leg_V_s[l] += to.volt_V * p.h_s + c.device_ohm * charge_C;
  flow.leg_V_s[f] += floating_V * p.h_s;
  flow.square_A2_s +=
      2.0 * (settled_A * (settled_A * p.h_s + 2.0 * d * ring_s) + 0.5 * d * d * (1.0 + p.decay) * ring_s);
  flow.bus_charge_C += bus_C;
  flow.bus_J += bus_C * in.bus_voltage_V;
  flow.drop_J += (from.drop_V - to.drop_V) * charge_C;
  flow.impulse_Nm_s += impulse_Nm_s;
  flow.mechanical_J += impulse_Nm_s * omega_mid;
  flow.angle_rad += omega_mid * p.h_s;
  s.current_A[h] = end_A;
  s.current_A[l] = -end_A;
  s.theta_rotor_rad += omega_mid * p.h_s;
  if (!in.speed_is_imposed) s.omega_rotor_rad_s = 2.0 * omega_mid - w;
  return true;
}

// All three carry current: most of the time, apart because it costs half. The same numbers as below, to the last bit.
// Whether a diode's current would turn is looked at if `turning` is given; then it is told, nothing done, false returned.
[[gnu::always_inline]] inline bool advance_three(const PhaseCircuit& c, PhaseState& s,
                                                 const std::array<Leg, 3>& legs, const Three& constants,
                                                 const PhaseInput& in, const PhaseStretch& p, PhaseFlow& flow,
                                                 Turning* turning) {
  const LegSource& a = source_of(legs[0], s.current_A[0]);
  const LegSource& b = source_of(legs[1], s.current_A[1]);
  const LegSource& z = source_of(legs[2], s.current_A[2]);
  const Lanes source_V({a.volt_V, b.volt_V, z.volt_V}), constant(constants), before_A(s.current_A);
  const Lanes volt_V = source_V - mean_of(source_V), emf = constant - mean_of(constant);
  const double w = s.omega_rotor_rad_s;
  double omega_mid = w;
  if (!in.speed_is_imposed) {
    const double gain = (1.0 - p.mean_decay) * c.conductance_per_ohm;
    const double torque = gain * sum_of(constant * volt_V) + p.mean_decay * sum_of(constant * before_A);
    const double twice_inertia = 2.0 * c.inertia_kg_m2;
    omega_mid = (twice_inertia * w + p.h_s * (torque - in.tau_load_Nm)) /
                (twice_inertia + p.h_s * (gain * sum_of(emf * emf) + c.viscous_Nm_s_per_rad));
  }
  const Lanes settled_A = (volt_V - emf * omega_mid) * c.conductance_per_ohm, d = before_A - settled_A;
  const Lanes end_A = settled_A + d * p.decay;
  if (turning != nullptr) {
    turning->turns = {has_turned(legs[0], s.current_A[0], end_A.two[0]),
                      has_turned(legs[1], s.current_A[1], end_A.two[1]),
                      has_turned(legs[2], s.current_A[2], end_A.third)};
    if (turning->any()) return settled_A.put(turning->settled_A), false;
  }
  const Lanes mean_A = settled_A + d * p.mean_decay, charge_C = mean_A * p.h_s;
  const double ring_s = p.mean_decay * p.h_s, ring2_s = 0.5 * (1.0 + p.decay) * ring_s;
  const double bus_C = sum_of(Lanes({a.bus_share, b.bus_share, z.bus_share}) * mean_A) * p.h_s;
  const double impulse_Nm_s = sum_of(constant * mean_A) * p.h_s;
  flow.time_s += p.h_s;
  (Lanes(flow.charge_C) + charge_C).put(flow.charge_C);
  (Lanes(flow.leg_V_s) + (source_V * p.h_s - c.device_ohm * charge_C)).put(flow.leg_V_s);
  flow.square_A2_s += sum_of(settled_A * (settled_A * p.h_s + 2.0 * d * ring_s) + d * d * ring2_s);
  flow.bus_charge_C += bus_C;
  flow.bus_J += bus_C * in.bus_voltage_V;
  flow.drop_J += sum_of(Lanes({a.drop_V, b.drop_V, z.drop_V}) * mean_A) * p.h_s;
  flow.impulse_Nm_s += impulse_Nm_s;
  flow.mechanical_J += impulse_Nm_s * omega_mid;
  flow.angle_rad += omega_mid * p.h_s;
  end_A.put(s.current_A);
  s.theta_rotor_rad += omega_mid * p.h_s;
  if (!in.speed_is_imposed) s.omega_rotor_rad_s = 2.0 * omega_mid - w;
  return true;
}

// The stretch, or as much of it as passes until a diode's current ends, with a conduction of its own. A barred phase has
// just been found not to conduct.
Rest advance_part(const PhaseCircuit& c, PhaseState& s, const std::array<Leg, 3>& legs, const Three& constant,
                  const PhaseInput& in, bool is_last, std::size_t barred, const PhaseStretch& stretch,
                  PhaseFlow& flow) {
  const double w = s.omega_rotor_rad_s;
  const Conduction on =
      conduction_of(s.current_A, legs, {constant[0] * w, constant[1] * w, constant[2] * w}, barred);
  const Drive drive = drive_of(on, constant, s.current_A);
  Part p{stretch};
  Rest rest;
  // First over all of it; once more, shorter, if a diode's current ends within.
  solve(c, s, drive, in, p);
  if (!is_last) {
    Turning turning{{}, p.settled_A};
    each_phase([&](auto x) {
      const double end_A = p.settled_A[x] + (s.current_A[x] - p.settled_A[x]) * p.decay;
      turning.turns[x] = on.direction[x] * end_A < 0.0;
    });
    if (turning.any()) {
      rest = shorten(c, s.current_A, turning, p);
      if (p.h_s > 0.0) solve(c, s, drive, in, p);
      ++flow.events;
    }
  }
  if (p.h_s > 0.0) {
    book(c, legs, s, on, constant, in, p, flow);
    finish(s, in, p);
  }
  return rest;
}

}  // namespace

PhaseCircuit make_phase_circuit(const PhaseMotor<double>& m, double switch_resistance_ohm, double step_s,
                                double extra_inertia_kg_m2) {
  PhaseCircuit c;
  c.winding_ohm = m.resistance_ohm;
  c.device_ohm = switch_resistance_ohm;
  c.inductance_H = 0.5 * (m.inductance_d_H + m.inductance_q_H);
  c.conductance_per_ohm = 1.0 / (c.winding_ohm + c.device_ohm);
  c.time_constant_s = c.inductance_H * c.conductance_per_ohm;
  set_length(c, c.step, step_s, std::exp(-step_s / c.time_constant_s));
  c.pole_pairs = m.pole_pairs;
  c.back_emf_V_s_per_rad = m.pole_pairs * m.flux_linkage_Wb;
  c.inertia_kg_m2 = m.rotor_inertia_kg_m2 + extra_inertia_kg_m2;
  c.viscous_Nm_s_per_rad = m.viscous_friction_Nm_s_per_rad;
  c.sine = m.back_emf.shape == BackEmfShape::kSine;
  c.trapezoid_slope = c.sine ? 0.0 : trapezoid_slope(m.back_emf);
  assert(step_s > 0.0 && c.time_constant_s > 0.0 && c.inertia_kg_m2 > 0.0);
  return c;
}

PhaseStretch stretch_of(const PhaseCircuit& c, double h_s) {
  if (h_s == c.step.h_s) return c.step;
  PhaseStretch stretch;
  set_length(c, stretch, h_s, std::exp(-h_s / c.time_constant_s));
  return stretch;
}

namespace {

void advance_stretch(const PhaseCircuit& c, PhaseState& s, const std::array<Leg, 3>& legs,
                     const Three& constant, const PhaseInput& in, const PhaseStretch& p, PhaseFlow& flow,
                     int part);

// On behind each diode's current that has ended.
void advance_parts(const PhaseCircuit& c, PhaseState& s, const std::array<Leg, 3>& legs, Three constant,
                   const PhaseInput& in, Rest rest, PhaseFlow& flow, int part) {
  for (;; ++part) {
    if (rest.phase == kNone) return;
    const std::size_t barred = rest.after_s > 0.0 ? kNone : rest.phase;
    extinguish(s, rest.phase);
    if (rest.left.h_s <= 0.0) return;
    constant = phase_constants(c, s.theta_rotor_rad + 0.5 * rest.left.h_s * s.omega_rotor_rad_s);
    if (barred == kNone) return advance_stretch(c, s, legs, constant, in, rest.left, flow, part + 1);
    rest = advance_part(c, s, legs, constant, in, part + 1 == kMaxParts, barred, rest.left, flow);
  }
}

// The unusual part of a stretch, and what is behind it.
[[gnu::noinline]] void advance_unusual(const PhaseCircuit& c, PhaseState& s, const std::array<Leg, 3>& legs,
                                       const Three& constant, const PhaseInput& in, const PhaseStretch& p,
                                       PhaseFlow& flow, int part) {
  const Rest rest = advance_part(c, s, legs, constant, in, part == kMaxParts, kNone, p, flow);
  advance_parts(c, s, legs, constant, in, rest, flow, part);
}

// All three carry current until one of a diode ends.
[[gnu::noinline]] void advance_turning(const PhaseCircuit& c, PhaseState& s, const std::array<Leg, 3>& legs,
                                       const Three& constant, const PhaseInput& in, PhaseStretch p,
                                       const Turning& turning, PhaseFlow& flow, int part) {
  if (part == kMaxParts) {
    advance_three(c, s, legs, constant, in, p, flow, nullptr);
    return;
  }
  const Rest rest = shorten(c, s.current_A, turning, p);
  if (p.h_s > 0.0) advance_three(c, s, legs, constant, in, p, flow, nullptr);
  ++flow.events;
  advance_parts(c, s, legs, constant, in, rest, flow, part);
}

// What usually happens first.
void advance_stretch(const PhaseCircuit& c, PhaseState& s, const std::array<Leg, 3>& legs,
                     const Three& constant, const PhaseInput& in, const PhaseStretch& p, PhaseFlow& flow,
                     int part) {
  const unsigned floating = without_current(s.current_A, legs);
  if (floating == 0) {
    Turning turning;
    if (!advance_three(c, s, legs, constant, in, p, flow, &turning))
      advance_turning(c, s, legs, constant, in, p, turning, flow, part);
    return;
  }
  const bool one = (floating & (floating - 1)) == 0;
  if (!one || !advance_pair(c, s, legs, constant, in, p, floating >> 1, flow))
    advance_unusual(c, s, legs, constant, in, p, flow, part);
}

}  // namespace

void advance_circuit(const PhaseCircuit& c, PhaseState& s, const std::array<Leg, 3>& legs,
                     const PhaseInput& in, const PhaseStretch& stretch, PhaseFlow& flow, int stretches) {
  for (int k = 0; k < stretches; ++k) {
    const Three constant = phase_constants(c, s.theta_rotor_rad + 0.5 * stretch.h_s * s.omega_rotor_rad_s);
    advance_stretch(c, s, legs, constant, in, stretch, flow, 1);
  }
}

}  // namespace omnihil
