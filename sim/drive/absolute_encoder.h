// Absolute magnetic encoder at the rotor's end: a magnet not quite over the chip, read a little late.
//
//   std::uint32_t code = absolute_encoder_code({.bits = 14, .latency_s = 100e-6, …}, theta, omega);
//   double angle = absolute_encoder_rad(params, code);         // 0 .. 2 pi, the code's lower edge
//
// Law: theta_m = direction * theta(t - latency) + zero + e1 sin(theta + p1) + e2 sin(2 theta + p2),
//      theta(t - latency) = theta - omega latency;   code = floor(theta_m 2^bits / 2 pi) mod 2^bits
// e1: magnet off the axis of rotation, order 1; e2: chip off the axis or a tilted magnet, order 2.
// Source: data sheets of on-axis magnetic encoders (integral non-linearity over displacement, pipeline
// delay). The angle law is a template on the scalar; the code is its rounding. Cannot: noise (add it before
// rounding), speed that changes within the latency, missing frames.
#pragma once
#include <cmath>
#include <cstdint>
#include <numbers>

namespace omnihil {

struct AbsoluteEncoderParams {
  int bits = 14;      // 8 to 24
  int direction = 1;  // +1 or -1
  double zero_rad = 0.0;
  double eccentricity_rad = 0.0;  // e1
  double eccentricity_phase_rad = 0.0;
  double second_order_rad = 0.0;  // e2
  double second_order_phase_rad = 0.0;
  double latency_s = 0.0;
};

// Before rounding, not wrapped.
template <typename T>
T absolute_encoder_angle_rad(const AbsoluteEncoderParams& p, const T& theta_rotor_rad,
                             const T& omega_rotor_rad_s) {
  using std::sin;
  const T then_rad = theta_rotor_rad - omega_rotor_rad_s * p.latency_s;
  T angle_rad = static_cast<double>(p.direction) * then_rad + p.zero_rad;
  angle_rad += p.eccentricity_rad * sin(then_rad + p.eccentricity_phase_rad);
  angle_rad += p.second_order_rad * sin(2.0 * then_rad + p.second_order_phase_rad);
  return angle_rad;
}

inline std::uint32_t absolute_encoder_code(const AbsoluteEncoderParams& p, double theta_rotor_rad,
                                           double omega_rotor_rad_s) {
  const double codes = std::ldexp(1.0, p.bits);
  const double angle_rad = absolute_encoder_angle_rad(p, theta_rotor_rad, omega_rotor_rad_s);
  const auto code = static_cast<std::int64_t>(std::floor(angle_rad * (codes / (2.0 * std::numbers::pi))));
  return static_cast<std::uint32_t>(code & (static_cast<std::int64_t>(codes) - 1));
}

inline double absolute_encoder_rad(const AbsoluteEncoderParams& p, std::uint32_t code) {
  return std::ldexp(2.0 * std::numbers::pi, -p.bits) * code;
}

}  // namespace omnihil
