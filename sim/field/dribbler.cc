#include "sim/field/dribbler.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace omnihil {
namespace {
constexpr double kLook_m = 1e-5;  // a hundredth of a millimetre
}

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

double held_acceleration_m_s2(const DribblerModel& d, double front_m, double r_m, double mass_kg,
                              double mu_f) {
  const double above_m = d.bar_z_m - r_m, apart_m = d.bar_radius_m + r_m;
  double most_m_s2 = 0.0;
  // From where they just touch to where the ball stands against the front.
  for (double x_m = d.bar_x_m + std::sqrt(std::max(0.0, apart_m * apart_m - above_m * above_m));
       x_m > front_m + r_m; x_m -= kLook_m) {
    const double distance_m = std::hypot(x_m - d.bar_x_m, above_m);
    const double s = above_m / distance_m, c = (x_m - d.bar_x_m) / distance_m;
    const double n_N = d.mount_stiffness_N_per_m * (apart_m - distance_m);
    if (mu_f * c >= 1.0) return std::numeric_limits<double>::infinity();
    const double f_N = mu_f * (mass_kg * kGravity_m_s2 + n_N * s) / (1.0 - mu_f * c);
    if (f_N > d.friction * n_N) continue;  // the bar cannot keep it spinning
    most_m_s2 = std::max(most_m_s2, (f_N * (1.0 + s) - n_N * c) / mass_kg);
  }
  return most_m_s2;
}

}  // namespace omnihil
