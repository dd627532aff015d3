#include "sim/model/model_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/robot/geometry.h"
#include "sim/robot/wheel_load.h"

namespace omnihil {
namespace {

constexpr double kRpm_rad_s = 2.0 * std::numbers::pi / 60.0;

// Where winding and friction balance: (k/R)(u - k omega) = c + b omega.
double no_load_speed_rad_s(const MotorParams& m, double voltage_V) {
  const double k = m.torque_constant_Nm_per_A, r = m.resistance_ohm;
  return std::max(
      0.0, (k / r * voltage_V - m.coulomb_friction_Nm) / (k * k / r + m.viscous_friction_Nm_s_per_rad));
}

double stall_current_A(const MotorParams& m, double voltage_V) {
  const double current_A = voltage_V / m.resistance_ohm;
  return m.current_limit_A > 0.0 ? std::min(current_A, m.current_limit_A) : current_A;
}

// A wheel with less of a direction than rounding leaves has nothing of it.
constexpr double kAcross = 1e-9;

// Longest push along a direction with every wheel at most `force_N`: the wheels share by the transpose of
// eq. (5), so the one that lies best decides.
double push_N(const WheelGeometry<double>& g, double force_N, bool forward) {
  double sum = 0.0, largest = 0.0;
  for (std::size_t i = 0; i < g.wheels; ++i) {
    const double share = forward ? g.sin_angle[i] : g.cos_angle[i];
    sum += share * share;
    largest = std::max(largest, std::abs(share));
  }
  return largest > kAcross ? force_N * sum / largest : 0.0;
}

// Top speed along a direction: the wheel that must turn fastest decides.
double top_speed_m_s(const WheelGeometry<double>& g, double omega_wheel_rad_s, bool forward) {
  double largest = 0.0;
  for (std::size_t i = 0; i < g.wheels; ++i) {
    largest = std::max(largest, std::abs(forward ? g.sin_angle[i] : g.cos_angle[i]));
  }
  return largest > kAcross ? omega_wheel_rad_s * g.wheel_radius_m / largest : 0.0;
}

}  // namespace

std::vector<ModelFigure> motor_figures(const MotorParams& m, double voltage_V) {
  const double k = m.torque_constant_Nm_per_A, r = m.resistance_ohm, u = voltage_V * m.duty_limit_ratio;
  const double speed = no_load_speed_rad_s(m, u), stall_A = stall_current_A(m, u);
  std::vector<ModelFigure> out = {
      {"voltage at full duty", u, "V", "duty limit * supply"},
      {"no-load speed", speed / kRpm_rad_s, "rpm", "winding's torque = friction"},
      {"no-load speed", speed, "rad/s", ""},
      {"no-load current", (u - k * speed) / r, "A", "(u - k omega) / R"},
      {"stall current", stall_A, "A", m.current_limit_A > 0.0 ? "u / R, or the limit" : "u / R"},
      {"stall torque", k * stall_A, "N m", "k i"},
      {"speed constant", 1.0 / k / kRpm_rad_s, "rpm/V", "1 / k"},
      {"electrical time constant", 1e3 * m.inductance_H / r, "ms", "L / R"}};
  if (m.rotor_inertia_kg_m2 > 0.0) {
    out.push_back({"mechanical time constant", 1e3 * m.rotor_inertia_kg_m2 * r / (k * k), "ms",
                   "J R / k^2, rotor alone"});
  }
  return out;
}

std::vector<ModelFigure> robot_figures(const RobotModel& m) {
  const WheelGeometry<double> g = wheel_geometry(m);
  const auto loads =
      wheel_load_law(g, m.mass_kg, m.center_of_mass_x_m, m.center_of_mass_y_m, m.center_of_mass_height_m);
  const double u = m.bus_voltage_V * m.motor.duty_limit_ratio;
  const double omega_wheel = no_load_speed_rad_s(m.motor, u) / m.gear_ratio;
  const double pull_N = std::max(0.0, m.motor.torque_constant_Nm_per_A * stall_current_A(m.motor, u) -
                                          m.motor.coulomb_friction_Nm) *
                        m.gear_ratio / m.wheel_radius_m;
  const double grip_N =
      m.tyre_longitudinal.extremum_value * *std::min_element(loads.at_rest_N.begin(), loads.at_rest_N.end());
  const double wheel_N = std::min(pull_N, grip_N);
  const char* decides = pull_N < grip_N ? "decided by the motor" : "decided by the tyre";
  const double rotors_kg_m2 = m.gear_ratio * m.gear_ratio * m.motor.rotor_inertia_kg_m2;
  std::vector<ModelFigure> out = {
      {"top speed forward", top_speed_m_s(g, omega_wheel, true), "m/s",
       "eq. (5), slip and roller drag left out"},
      {"top speed sideways", top_speed_m_s(g, omega_wheel, false), "m/s", ""},
      {"top turning speed", omega_wheel * m.wheel_radius_m / m.wheel_center_radius_m, "rad/s",
       "omega r / R_b"},
      {"push forward from rest", push_N(g, wheel_N, true), "N", decides},
      {"acceleration forward from rest", push_N(g, wheel_N, true) / m.mass_kg, "m/s2",
       "push / mass, wheels' own inertia left out"},
      {"acceleration sideways from rest", push_N(g, wheel_N, false) / m.mass_kg, "m/s2", ""},
      {"wheel's mass at its rim",
       (m.wheel_inertia_kg_m2 + rotors_kg_m2) / (m.wheel_radius_m * m.wheel_radius_m), "kg",
       "(J_wheel + gear^2 J_rotor) / r^2"},
      {"encoder counts per wheel turn", m.encoder.counts_per_turn * m.gear_ratio, "counts",
       "rotor counts * gear"},
      {"way per encoder count",
       1e3 * 2.0 * std::numbers::pi * m.wheel_radius_m / (m.encoder.counts_per_turn * m.gear_ratio), "mm",
       ""}};
  for (std::size_t i = 0; i < m.wheels; ++i) {
    out.push_back({fmt::format("load on wheel {}", i + 1), loads.at_rest_N[i], "N", "at rest"});
  }
  return out;
}

std::vector<ModelFigure> model_figures(const ModelFile& model) {
  const ParameterTable& table = model.parameters;
  const double voltage_V =
      table.value_or("supply.voltage_V", table.value_or("datasheet.nominal_voltage_V", 0.0));
  std::vector<ModelFigure> out;
  if (voltage_V > 0.0 && model.motor.resistance_ohm > 0.0 && model.motor.torque_constant_Nm_per_A > 0.0) {
    out = motor_figures(model.motor, voltage_V);
  }
  if (model.robot) {
    const std::vector<ModelFigure> robot = robot_figures(*model.robot);
    out.insert(out.end(), robot.begin(), robot.end());
  }
  return out;
}

}  // namespace omnihil
