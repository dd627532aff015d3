// What the plant tells a board at one instant; between two such instants shafts turn on as they did.
//
// Law: theta(t) = theta0 + omega0 (t - t0), phase currents alike, everything else held. Measured with an 8 kHz speed loop on a
// 4096-count encoder: held counts of a 1 ms step give 12 % speed error, extrapolated ones 0.01 % up to steps
// of 5 ms. Cannot represent: acceleration within a step, ripple of currents within it.
#pragma once
#include <array>
#include <cmath>
#include <cstdint>

#include "firmware_iface/robot_io.h"

namespace omnihil::mcu {

struct WorldState {
  std::int64_t at_ns = 0;
  std::array<double, kWheels> theta_rotor_rad{}, omega_rotor_rad_s{};
  std::array<double, kWheels> motor_current_A{};
  std::int64_t phases_at_ns = 0;
  std::array<std::array<double, kLegs>, kWheels> phase_current_A{};  // into the motor, at phases_at_ns
  std::array<std::array<double, kLegs>, kWheels> phase_rate_A_s{};   // and how they go on from there
  std::array<std::array<double, kLegs>, kWheels>
      leg_V{};  // against the bus's minus, mean of the last PWM period
  double gear_ratio = 1.0;
  double encoder_counts_per_rotor_turn = 4096;  // below 0: counts fall with positive rotation
  double bus_voltage_V = 0.0, gyro_z_rad_s = 0.0, accel_x_m_s2 = 0.0, accel_y_m_s2 = 0.0;

  double rotor_rad(int wheel, std::int64_t now_ns) const {
    const auto w = static_cast<std::size_t>(wheel);
    return theta_rotor_rad[w] + omega_rotor_rad_s[w] * 1e-9 * static_cast<double>(now_ns - at_ns);
  }
  double phase_A(int wheel, std::size_t phase, std::int64_t now_ns) const {
    const auto w = static_cast<std::size_t>(wheel);
    return phase_current_A[w][phase] +
           phase_rate_A_s[w][phase] * 1e-9 * static_cast<double>(now_ns - phases_at_ns);
  }
  std::int64_t encoder_counts(int wheel, std::int64_t now_ns) const {
    constexpr double kTwoPi = 6.283185307179586;
    const double counts = rotor_rad(wheel, now_ns) * encoder_counts_per_rotor_turn / kTwoPi;
    const auto whole = static_cast<std::int64_t>(counts);  // towards zero, made floor
    return whole - (static_cast<double>(whole) > counts ? 1 : 0);
  }
};

}  // namespace omnihil::mcu
