#include "sim/bench/axis_signal.h"

#include <cmath>
#include <numbers>

#include "sim/drive/sensor_chain.h"

namespace omnihil {
namespace {

using Sample = AxisSample<double>;

constexpr double kAmbient_degC = 25.0;  // of a bench: a choice

constexpr AxisSignal kSignals[] = {
    {"time", "s", [](const Sample& s, const AxisInput&, std::size_t) { return s.time_s; }},
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
    {"encoder", "counts",
     [](const Sample& s, const AxisInput&, std::size_t) { return encoder_reading(s.encoder_counts); }},
    {"winding_temperature", "degC",
     [](const Sample& s, const AxisInput&, std::size_t) { return kAmbient_degC + s.winding_rise_K; }},
};

constexpr std::string_view kCommands[] = {"duty", "motor_voltage", "motor_current", "motor_torque",
                                          "position_target"};  // in the order of CommandKind

}  // namespace

const AxisSignal* find_axis_signal(std::string_view name) {
  for (const AxisSignal& s : kSignals) {
    if (s.name == name) return &s;
  }
  return nullptr;
}

std::string_view command_name(CommandKind kind) { return kCommands[static_cast<std::size_t>(kind)]; }

}  // namespace omnihil
