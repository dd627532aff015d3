#include "sim/drive/switched_drive.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>

namespace omnihil {
namespace {

// A leg's on-time within the period.
struct OnTime {
  double begin_s, end_s;
};

OnTime on_time(const LegCommand& c, double period_s) {
  const double d = std::clamp(c.duty_ratio, 0.0, 1.0);
  // full duty has no edge: open the interval beyond the period
  if (d >= 1.0) return {-period_s, 2.0 * period_s};
  return {0.5 * (1.0 - d) * period_s, 0.5 * (1.0 + d) * period_s};
}

bool opposite(LegState a, LegState b) {
  return (a == LegState::kHigh && b == LegState::kLow) || (a == LegState::kLow && b == LegState::kHigh);
}

// Earliest of the instants that is after t, or `best`.
double earlier(double t_s, double instant_s, double best_s) {
  return instant_s > t_s && instant_s < best_s ? instant_s : best_s;
}

}  // namespace

SwitchedDrive make_switched_drive(const PhaseMotor<double>& motor, const Inverter& inverter,
                                  const SwitchedOptions& options) {
  SwitchedDrive d;
  d.inverter = inverter;
  d.period_s = 1.0 / inverter.pwm_frequency_Hz;
  d.max_step_s = options.max_step_s;
  d.circuit = make_phase_circuit(motor, inverter.switch_resistance_ohm, options.max_step_s,
                                 options.extra_inertia_kg_m2);
  return d;
}

PeriodSample advance_period(const SwitchedDrive& drive, SwitchedState& state, const BridgeCommand& command,
                            const PhaseInput& input, double sample_ratio, PhaseFlow& flow,
                            SwitchingListener* listener) {
  assert(sample_ratio >= 0.0 && sample_ratio <= 1.0);
  const double sample_s = sample_ratio * drive.period_s;
  std::array<OnTime, 3> on{};
  std::array<double, 3> free_at_s = state.blocked_s;
  for (std::size_t x = 0; x < 3; ++x) on[x] = on_time(command[x], drive.period_s);
  std::array<LegState, 3> state_of{};
  const Leg off = leg_of(drive.inverter, LegState::kOff, input.bus_voltage_V);
  std::array<Leg, 3> legs = {off, off, off};
  PeriodSample sample;
  bool sampled = false;
  double t = 0.0;
  const auto take_sample = [&] {
    sample = {state.motor.current_A, state_of, state.motor.theta_rotor_rad, state.motor.omega_rotor_rad_s};
    sampled = true;
  };
  while (t < drive.period_s) {
    double next = drive.period_s;
    for (std::size_t x = 0; x < 3; ++x) {
      const bool is_on = t >= on[x].begin_s && t < on[x].end_s;
      const LegState wanted = is_on ? command[x].on : command[x].off;
      if (opposite(wanted, state.wanted[x])) free_at_s[x] = t + drive.inverter.dead_time_s;
      state.wanted[x] = wanted;
      const LegState now = free_at_s[x] > t ? LegState::kOff : wanted;
      if (now != state_of[x]) legs[x] = leg_of(drive.inverter, now, input.bus_voltage_V);
      state_of[x] = now;
      if (command[x].on != command[x].off) {
        next = earlier(t, on[x].begin_s, next);
        next = earlier(t, on[x].end_s, next);
      }
      next = earlier(t, free_at_s[x], next);
    }
    if (!sampled) {
      if (t >= sample_s)
        take_sample();
      else
        next = earlier(t, sample_s, next);
    }
    if (listener) listener->piece(t, state_of, state.motor);
    const int pieces = std::max(1, static_cast<int>(std::ceil((next - t) / drive.max_step_s - 1e-9)));
    const PhaseStretch piece = stretch_of(drive.circuit, (next - t) / pieces);
    advance_circuit(drive.circuit, state.motor, legs, input, piece, flow, pieces);
    t = next;
  }
  if (!sampled) take_sample();
  for (std::size_t x = 0; x < 3; ++x) state.blocked_s[x] = std::max(0.0, free_at_s[x] - drive.period_s);
  return sample;
}

}  // namespace omnihil
