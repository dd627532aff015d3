// The speed loop of one wheel as firmware runs it, on double and with derivatives: what makes duties of radio commands.
//
//   SpeedLoopState<double> state;
//   double u_V = speed_loop_voltage(params, state, {.reference_rad_s = 300, .omega_rad_s = 280, .bus_voltage_V = 24, .dt_s = 1e-3});
//   double duty = u_V / 24;
//
// All at the rotor:
//   w'   = mean speed over the period, through a first-order low pass of speed_filter_s as firmware runs it (low_pass_share)
//   u    = feedforward r + acceleration_feedforward dr/dt + kp (r - w') + I,     |u| <= limit bus
//   I   += ki (r - w') dt,  |I| <= integral_limit bus; while u is at its limit only what leads away from it (clamping)
// Source: Astrom and Murray, Feedback Systems, 2008, sect. 10.4 (PI with feed-forward and anti-windup).
// Cannot: control the body's heading or path, know of a current limit, schedule gains.
#pragma once
#include "sim/law/scalar.h"

namespace omnihil {

template <typename T>
struct SpeedLoopParams {
  T kp_V_s_per_rad = T(0), ki_V_per_rad = T(0);
  T feedforward_V_s_per_rad = T(0), acceleration_feedforward_V_s2_per_rad = T(0);
  T integral_limit_ratio = T(1);  // of the bus
  T speed_filter_s = T(0);
};

template <typename T>
struct SpeedLoopState {
  T reference_rad_s = T(0), filtered_rad_s = T(0), integral_V = T(0);
};

template <typename T>
struct SpeedLoopInput {
  T reference_rad_s = T(0);
  T omega_rad_s = T(0);
  T bus_voltage_V = T(0);
  double dt_s = 0.0;
  double limit_ratio = 1.0;  // of the bus
};

// Share a of the newest value in a firmware's first-order low pass, y += a (x - y) once per period: dt / (tau + dt), the backward
// Euler step (Astrom, Wittenmark, Computer-Controlled Systems, 1997, sect. 8.3). Its derivative by tau is -1 / dt at tau = 0;
// that of the exact solution, 1 - exp(-dt / tau), is zero there, so that data which know of no filter could not say so.
template <typename T>
T low_pass_share(const T& time_constant_s, double dt_s) {
  return T(dt_s / (time_constant_s + dt_s));
}

template <typename T>
T speed_loop_voltage(const SpeedLoopParams<T>& p, SpeedLoopState<T>& s, const SpeedLoopInput<T>& in) {
  const auto within = [](const T& x, const T& limit) {
    if (value_of(x) > value_of(limit)) return limit;
    return value_of(x) < -value_of(limit) ? T(-limit) : x;
  };
  const T change = in.reference_rad_s - s.reference_rad_s;
  s.reference_rad_s = in.reference_rad_s;
  s.filtered_rad_s += (in.omega_rad_s - s.filtered_rad_s) * low_pass_share(p.speed_filter_s, in.dt_s);
  const T error = s.reference_rad_s - s.filtered_rad_s;
  const T rest = p.feedforward_V_s_per_rad * s.reference_rad_s +
                 p.acceleration_feedforward_V_s2_per_rad * change * (1.0 / in.dt_s) +
                 p.kp_V_s_per_rad * error;
  const T integral = within(T(s.integral_V + p.ki_V_per_rad * error * in.dt_s),
                            T(p.integral_limit_ratio * in.bus_voltage_V));
  const T wanted = rest + integral;
  const T given = within(wanted, T(in.limit_ratio * in.bus_voltage_V));
  const bool deeper =
      (value_of(wanted) - value_of(given)) * (value_of(integral) - value_of(s.integral_V)) > 0.0;
  if (!deeper) s.integral_V = integral;
  return given;
}

}  // namespace omnihil
