#include "sim/field/dribbler.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace omnihil {

DribblerStep drive_bar(const DribblerModel& d, double omega_rad_s, double duty_ratio, double bus_voltage_V,
                       double step_s) {
  const double k = d.torque_constant_Nm_per_A, g = d.gear_ratio;
  const double u_V = std::clamp(duty_ratio, 0.0, 1.0) * bus_voltage_V;
  const auto current_A = [&](double w) {
    const double i_A = (u_V - k * g * w) / d.resistance_ohm;
    // Off: the bridge is open and the bar runs out by itself.
    return duty_ratio > 0.0 ? std::clamp(i_A, -d.current_limit_A, d.current_limit_A) : 0.0;
  };
  const double drag_Nm = omega_rad_s == 0.0 ? 0.0 : std::copysign(d.friction_Nm, omega_rad_s);
  DribblerStep step;
  const double i_A = current_A(omega_rad_s);
  const bool linear = duty_ratio > 0.0 && std::abs(i_A) < d.current_limit_A;
  if (linear) {
    // J dw/dt = a - b w
    const double b = k * k * g * g / d.resistance_ohm, a = g * k * u_V / d.resistance_ohm - drag_Nm;
    const double settled = a / b, decay = std::exp(-b * step_s / d.inertia_kg_m2);
    step.omega_bar_rad_s = settled + (omega_rad_s - settled) * decay;
  } else {
    step.omega_bar_rad_s = omega_rad_s + step_s * (g * k * i_A - drag_Nm) / d.inertia_kg_m2;
  }
  // Friction stops, it does not turn round.
  if (omega_rad_s * step.omega_bar_rad_s < 0.0 && u_V == 0.0) step.omega_bar_rad_s = 0.0;
  step.motor_current_A = 0.5 * (i_A + current_A(step.omega_bar_rad_s));
  step.bus_current_A = std::clamp(duty_ratio, 0.0, 1.0) * step.motor_current_A;
  return step;
}

double held_acceleration_m_s2(const DribblerModel& d, double r_m, double mu_f) {
  const double s = (d.bar_z_m - r_m) / (d.bar_radius_m + r_m), c = std::sqrt(std::max(0.0, 1.0 - s * s));
  const double left = 1.0 - mu_f * (c + s / d.friction);
  if (left <= 0.0) return std::numeric_limits<double>::infinity();
  const double f_per_m = mu_f * kGravity_m_s2 / left;
  return std::max(0.0, f_per_m * (1.0 + s) - f_per_m * c / d.friction);
}

}  // namespace omnihil
