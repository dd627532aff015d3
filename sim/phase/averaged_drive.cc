#include "sim/phase/averaged_drive.h"

#include <algorithm>
#include <cstddef>

namespace omnihil {
namespace {

// Switched between kHigh and kLow; `high` is the share of the period it is high.
Leg complementary_leg(const AveragedDrive& d, double high, double bus_V, double current_A) {
  LegSource s{high * bus_V, high, 0.0};
  if (d.inverter.dead_time_s > 0.0) {
    const double half_ripple_A =
        0.5 * ripple_A(bus_V, high, 2.0 * d.circuit.inductance_H, d.inverter.pwm_frequency_Hz);
    const double sign = half_ripple_A > 0.0 ? std::clamp(current_A / half_ripple_A, -1.0, 1.0) : 0.0;
    const double gap = sign * d.inverter.pwm_frequency_Hz * d.inverter.dead_time_s;
    s.bus_share = std::clamp(high - gap, 0.0, 1.0);
    s.drop_V = 2.0 * gap * d.inverter.diode_forward_V;
    s.volt_V = s.bus_share * bus_V - s.drop_V;
  }
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
  const double theta_mid = s.theta_rotor_rad + 0.5 * c.step_s * s.omega_rotor_rad_s;
  const auto f = back_emf_shape(c.shape, c.pole_pairs * theta_mid);
  const double emf_V = c.back_emf_V_s_per_rad * s.omega_rotor_rad_s * (f[high] - f[low]);
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

}  // namespace

AveragedDrive make_averaged_drive(const PhaseMotor<double>& motor, const Inverter& inverter, double step_s,
                                  double extra_inertia_kg_m2) {
  return {make_phase_circuit(motor, inverter.switch_resistance_ohm, step_s, extra_inertia_kg_m2), inverter};
}

void advance_averaged(const AveragedDrive& drive, PhaseState& state, const BridgeCommand& command,
                      const PhaseInput& input, PhaseFlow& flow) {
  const double bus_V = input.bus_voltage_V;
  std::size_t high = 3, low = 3;
  for (std::size_t x = 0; x < 3; ++x) {
    if (command[x].on == LegState::kHigh && command[x].off == LegState::kOff) high = x;
    if (command[x].on == LegState::kLow) low = x;
  }
  double chopped = -1.0;
  if (high < 3 && low < 3 && command[high].duty_ratio > 0.0)
    chopped = effective_duty(drive, state, high, low, std::min(command[high].duty_ratio, 1.0),
                             is_chopped(command[low]), bus_V);
  std::array<Leg, 3> legs;
  for (std::size_t x = 0; x < 3; ++x) {
    const LegCommand& c = command[x];
    const double d = std::clamp(c.duty_ratio, 0.0, 1.0);
    if (c.on == c.off || d >= 1.0)
      legs[x] = leg_of(drive.inverter, c.on, bus_V);
    else if (d <= 0.0)
      legs[x] = leg_of(drive.inverter, c.off, bus_V);
    else if (is_chopped(c))
      legs[x] = chopped_leg(drive.inverter, c.on, chopped >= 0.0 ? chopped : d, bus_V);
    else
      legs[x] = complementary_leg(drive, c.on == LegState::kHigh ? d : 1.0 - d, bus_V, state.current_A[x]);
  }
  advance_circuit(drive.circuit, state, legs, input, drive.circuit.step_s, flow);
}

}  // namespace omnihil
