#include "sim/bench/axis_signal.h"

#include <cmath>
#include <numbers>

namespace omnihil {
namespace {

using Sample = AxisSample<double>;

constexpr AxisSignal kSignals[] = {
    {"time", "s", [](const Sample& s, const AxisInput&, std::size_t) { return s.time_s; }},
    {"command", "", [](const Sample&, const AxisInput& in, std::size_t k) { return in.command[k]; }},
    {"duty", "1", [](const Sample&, const AxisInput& in, std::size_t k) { return in.command[k]; }},
    {"position", "rad", [](const Sample& s, const AxisInput&, std::size_t) { return s.position_rad; }},
    {"velocity", "rad/s", [](const Sample& s, const AxisInput&, std::size_t) { return s.velocity_rad_s; }},
    {"motor_current", "A", [](const Sample& s, const AxisInput&, std::size_t) { return s.motor_current_A; }},
    {"motor_voltage", "V", [](const Sample& s, const AxisInput&, std::size_t) { return s.motor_voltage_V; }},
    {"bus_voltage", "V", [](const Sample& s, const AxisInput&, std::size_t) { return s.bus_voltage_V; }},
    {"load_torque", "N m", [](const Sample& s, const AxisInput&, std::size_t) { return s.load_torque_Nm; }},
    {"winding_rise", "K", [](const Sample& s, const AxisInput&, std::size_t) { return s.winding_rise_K; }},
    {"rotor_angle", "rad",
     [](const Sample& s, const AxisInput&, std::size_t) {
       const double turns = s.theta_rotor_rad / (2.0 * std::numbers::pi);
       return 2.0 * std::numbers::pi * (turns - std::floor(turns));
     }},
    {"encoder_error", "rad",
     [](const Sample& s, const AxisInput&, std::size_t) { return s.position_rad - s.theta_rotor_rad; }},
};

}  // namespace

std::span<const AxisSignal> axis_signals() { return kSignals; }

const AxisSignal* find_axis_signal(std::string_view name) {
  for (const AxisSignal& s : kSignals) {
    if (s.name == name) return &s;
  }
  return nullptr;
}

std::string_view command_name(CommandKind kind) {
  switch (kind) {
    case CommandKind::kDuty:
      return "duty";
    case CommandKind::kMotorVoltage:
      return "motor_voltage";
    case CommandKind::kMotorCurrent:
      return "motor_current";
    case CommandKind::kMotorTorque:
      return "motor_torque";
    case CommandKind::kPositionTarget:
      return "position_target";
  }
  return "";
}

std::string_view command_unit(CommandKind kind) {
  switch (kind) {
    case CommandKind::kDuty:
      return "1";
    case CommandKind::kMotorVoltage:
      return "V";
    case CommandKind::kMotorCurrent:
      return "A";
    case CommandKind::kMotorTorque:
      return "N m";
    case CommandKind::kPositionTarget:
      return "rad";
  }
  return "";
}

}  // namespace omnihil
