#include "sim/drive/averaged_drive.h"

#include <algorithm>
#include <cstddef>

namespace omnihil {
namespace {

// Switched between kHigh and kLow; `high` is the share of the period it is high.
Leg complementary_leg(const AveragedDrive& d, double high, double bus_V, double current_A) {
  const LegSource s = mean_leg(d, high, bus_V, current_A);
  return {s, s, true};
}

// A switch that is on for the share d, a diode for the rest.
Leg chopped_leg(const Inverter& inverter, LegState on, double d, double bus_V) {
  const Leg is_on = leg_of(inverter, on, bus_V), is_off = leg_of(inverter, LegState::kOff, bus_V);
  const auto mean = [d](const LegSource& a, const LegSource& b) {
    return LegSource{d * a.volt_V + (1.0 - d) * b.volt_V, d * a.bus_share + (1.0 - d) * b.bus_share,
                     d * a.drop_V + (1.0 - d) * b.drop_V};
  };
  return {mean(is_on.forward, is_off.forward), mean(is_on.backward, is_off.backward), false};
}

bool is_chopped(const LegCommand& c) { return c.off == LegState::kOff && c.on != LegState::kOff; }

// The share of the period for which a chopped pair's voltage acts as if on: its duty, or more where the
// current is discontinuous.
double effective_duty(const AveragedDrive& d, const PhaseState& s, std::size_t high, std::size_t low,
                      double duty, bool fast, double bus_V) {
  const PhaseCircuit& c = d.circuit;
  const auto k = phase_constants(c, s.theta_rotor_rad + 0.5 * c.step.h_s * s.omega_rotor_rad_s);
  const double emf_V = (k[high] - k[low]) * s.omega_rotor_rad_s;
  const double off_V = fast ? -(bus_V + 2.0 * d.inverter.diode_forward_V) : -d.inverter.diode_forward_V;
  if (emf_V >= bus_V || emf_V <= off_V) return duty;
  const double period_s = 1.0 / d.inverter.pwm_frequency_Hz;
  const double conducting = duty * (bus_V - off_V) / (emf_V - off_V);  // t_c / T
  const double peak_A = (bus_V - emf_V) * duty * period_s / (2.0 * c.inductance_H);
  if (conducting >= 1.0 || s.current_A[high] > 0.5 * peak_A) return duty;
  const double mean_A = 0.5 * peak_A * conducting;
  const double wanted_V = emf_V + 2.0 / c.conductance_per_ohm * mean_A;  // E + R_ll i
  return std::clamp((wanted_V - off_V) / (bus_V - off_V), duty, 1.0);
}

// As above for the pair that a command makes, or -1 if it makes none.
double chopped_duty(const AveragedDrive& d, const PhaseState& s, const BridgeCommand& command, double bus_V) {
  std::size_t high = 3, low = 3;
  for (std::size_t x = 0; x < 3; ++x) {
    if (command[x].on == LegState::kHigh && command[x].off == LegState::kOff) high = x;
    if (command[x].on == LegState::kLow) low = x;
  }
  if (high == 3 || low == 3 || command[high].duty_ratio <= 0.0) return -1.0;
  return effective_duty(d, s, high, low, std::min(command[high].duty_ratio, 1.0), is_chopped(command[low]),
                        bus_V);
}

}  // namespace

AveragedDrive make_averaged_drive(const PhaseMotor<double>& motor, const Inverter& inverter, double step_s,
                                  double extra_inertia_kg_m2) {
  AveragedDrive d;
  d.circuit = make_phase_circuit(motor, inverter.switch_resistance_ohm, step_s, extra_inertia_kg_m2);
  d.inverter = inverter;
  d.gap_ratio = inverter.pwm_frequency_Hz * inverter.dead_time_s;
  d.ripple_per_V_A = 1.0 / (2.0 * d.circuit.inductance_H * inverter.pwm_frequency_Hz);
  return d;
}

LegSource mean_leg(const AveragedDrive& d, double high, double bus_V, double current_A) {
  double gap = 0.0;
  if (d.gap_ratio > 0.0) {
    // s(i) f t_d, s from -1 to 1 within half the ripple
    const double half_ripple_A = 0.5 * d.ripple_per_V_A * bus_V * high * (1.0 - high);
    gap = current_A >= half_ripple_A
              ? d.gap_ratio
              : (current_A <= -half_ripple_A ? -d.gap_ratio : d.gap_ratio * current_A / half_ripple_A);
  }
  const double share = std::clamp(high - gap, 0.0, 1.0), drop_V = 2.0 * gap * d.inverter.diode_forward_V;
  return {share * bus_V - drop_V, share, drop_V};
}

void advance_averaged(const AveragedDrive& drive, PhaseState& state, const BridgeCommand& command,
                      const PhaseInput& input, PhaseFlow& flow) {
  const double bus_V = input.bus_voltage_V;
  double chopped = -1.0;  // the duty a chopped pair acts with
  if (is_chopped(command[0]) || is_chopped(command[1]) || is_chopped(command[2]))
    chopped = chopped_duty(drive, state, command, bus_V);
  const auto leg = [&](std::size_t x) {
    const LegCommand& c = command[x];
    const double d = c.duty_ratio;
    if (c.on == c.off || d >= 1.0) return leg_of(drive.inverter, c.on, bus_V);
    if (d <= 0.0) return leg_of(drive.inverter, c.off, bus_V);
    if (is_chopped(c)) return chopped_leg(drive.inverter, c.on, chopped >= 0.0 ? chopped : d, bus_V);
    return complementary_leg(drive, c.on == LegState::kHigh ? d : 1.0 - d, bus_V, state.current_A[x]);
  };
  const std::array<Leg, 3> legs = {leg(0), leg(1), leg(2)};
  advance_circuit(drive.circuit, state, legs, input, drive.circuit.step, flow);
}

}  // namespace omnihil
