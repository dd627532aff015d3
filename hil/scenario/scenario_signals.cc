#include "hil/scenario/scenario_signals.h"

#include <algorithm>
#include <cmath>

namespace omnihil {
namespace {

using S = const ScenarioSample&;
using W = std::size_t;

constexpr ScenarioSignal kSignals[] = {
    {"omega_wheel_rad_s", "rad_s", "rad/s", true, "omega_wheel_commanded_rad_s", "true wheel speed",
     [](S s, W w) { return s.robot.truth.omega_wheel_rad_s[w]; }},
    {"omega_wheel_commanded_rad_s", "rad_s", "rad/s", true, "",
     "what the command means for this wheel, by eq. (5)", [](S s, W w) { return s.wanted_wheel_rad_s[w]; }},
    {"omega_wheel_reported_rad_s", "rad_s", "rad/s", true, "omega_wheel_commanded_rad_s",
     "wheel speed that the firmware reports", [](S s, W w) { return s.robot.feedback.omega_wheel_rad_s[w]; }},
    {"duty_ratio", "ratio", "", true, "", "duty that the firmware asks for",
     [](S s, W w) { return s.robot.drive.duty_ratio[w]; }},
    {"driven_count", "count", "", true, "", "1 while the wheel's bridge is on",
     [](S s, W w) { return s.robot.drive.mode[w] == OMNIHIL_DRIVE_COAST ? 0.0 : 1.0; }},
    {"motor_current_A", "A", "A", true, "", "true motor current at the control period's start",
     [](S s, W w) { return s.robot.truth.motor_current_A[w]; }},
    {"slip_ratio", "ratio", "", true, "", "true slip of the wheel",
     [](S s, W w) { return s.robot.truth.slip_longitudinal_ratio[w]; }},
    {"v_forward_m_s", "m_s", "m/s", false, "v_forward_commanded_m_s", "true velocity, body frame",
     [](S s, W) { return s.robot.truth.v_forward_m_s; }},
    {"v_left_m_s", "m_s", "m/s", false, "v_left_commanded_m_s", "the same, to the left",
     [](S s, W) { return s.robot.truth.v_left_m_s; }},
    {"omega_body_rad_s", "rad_s", "rad/s", false, "omega_body_commanded_rad_s", "true yaw rate",
     [](S s, W) { return s.robot.truth.omega_body_rad_s; }},
    {"v_forward_commanded_m_s", "m_s", "m/s", false, "", "as commanded",
     [](S s, W) { return s.wanted_body.v_forward_m_s; }},
    {"v_left_commanded_m_s", "m_s", "m/s", false, "", "as commanded",
     [](S s, W) { return s.wanted_body.v_left_m_s; }},
    {"omega_body_commanded_rad_s", "rad_s", "rad/s", false, "", "as commanded",
     [](S s, W) { return s.wanted_body.omega_body_rad_s; }},
    {"yaw_rad", "rad", "rad", false, "", "true heading", [](S s, W) { return s.robot.truth.yaw_rad; }},
    {"bus_voltage_V", "V", "V", false, "", "at the bridges, as measured",
     [](S s, W) { return s.robot.sensors.bus_voltage_V; }},
    {"missed_periods_count", "count", "", false, "", "control periods that did not run, so far",
     [](S s, W) { return s.missed_periods; }},
    {"refused_requests_count", "count", "", false, "", "bridge requests that no bridge can take, so far",
     [](S s, W) { return s.refused_requests; }},
    {"x_m", "m", "m", false, "", "true position in the field", [](S s, W) { return s.robot.truth.x_m; }},
    {"y_m", "m", "m", false, "", "the same, to the left", [](S s, W) { return s.robot.truth.y_m; }},
    {"capacitor_V", "V", "V", false, "", "of the kicker", [](S s, W) { return s.robot.sensors.capacitor_V; }},
    {"ball_seen_count", "count", "", false, "", "1 while the break beam says so",
     [](S s, W) { return static_cast<double>(s.robot.sensors.ball_seen); }},
    {"ball_x_m", "m", "m", false, "", "true place of the ball", [](S s, W) { return s.ball_m.x(); }},
    {"ball_y_m", "m", "m", false, "", "the same, to the left", [](S s, W) { return s.ball_m.y(); }},
    {"ball_z_m", "m", "m", false, "", "its middle above the carpet", [](S s, W) { return s.ball_m.z(); }},
    {"ball_speed_m_s", "m_s", "m/s", false, "", "its true speed", [](S s, W) { return s.ball_m_s.norm(); }},
    {"ball_distance_m", "m", "m", false, "", "from the robot's middle to the ball's, seen from above",
     [](S s, W) { return std::hypot(s.ball_m.x() - s.robot.truth.x_m, s.ball_m.y() - s.robot.truth.y_m); }},
    {"goals_count", "count", "", false, "", "times that the ball went into a goal, so far",
     [](S s, W) { return s.goals; }},
    {"kicks_count", "count", "", false, "", "kicks that met the ball, so far",
     [](S s, W) { return s.kicks; }},
    {"ball_touches_count", "count", "", false, "", "times that the ball met a robot's hull, so far",
     [](S s, W) { return s.ball_touches; }},
    {"robot_touches_count", "count", "", false, "", "times that two robots met, so far",
     [](S s, W) { return s.robot_touches; }},
    {"tips_count", "count", "", false, "", "times that a robot fell over, so far (physics simbody-free)",
     [](S s, W) { return s.tips; }},
};

constexpr ScenarioSignal kVariable = {
    kVariablePrefix, "value", "", false, "", "a variable of the firmware", [](S, W) { return 0.0; }};

}  // namespace

std::span<const ScenarioSignal> scenario_signals() { return kSignals; }

const ScenarioSignal* find_scenario_signal(std::string_view name) {
  if (name.starts_with(kVariablePrefix)) return &kVariable;
  const auto found = std::ranges::find(kSignals, name, &ScenarioSignal::name);
  return found == std::end(kSignals) ? nullptr : found;
}

ScenarioTrace::ScenarioTrace(std::vector<std::string> variables)
    : columns_(std::size(kSignals) * kWheels + variables.size()), variables_(std::move(variables)) {}

void ScenarioTrace::add(double now_s, const ScenarioSample& sample) {
  time_s_.push_back(now_s);
  for (std::size_t n = 0; n < std::size(kSignals); ++n) {
    const std::size_t count = kSignals[n].of_wheels ? kWheels : 1;
    for (std::size_t w = 0; w < count; ++w) {
      columns_[n * kWheels + w].push_back(kSignals[n].value(sample, w));
    }
  }
  const std::size_t first = std::size(kSignals) * kWheels;
  for (std::size_t i = 0; i < std::min(variables_.size(), sample.robot.watched.size()); ++i)
    columns_[first + i].push_back(sample.robot.watched[i]);
}

std::span<const double> ScenarioTrace::column(std::string_view signal, std::size_t wheel) const {
  const ScenarioSignal* row = find_scenario_signal(signal);
  if (row == nullptr) return {};
  if (row == &kVariable) {
    const auto found = std::ranges::find(variables_, signal.substr(kVariablePrefix.size()));
    if (found == variables_.end()) return {};
    return columns_[std::size(kSignals) * kWheels + static_cast<std::size_t>(found - variables_.begin())];
  }
  const auto n = static_cast<std::size_t>(row - kSignals);
  return columns_[n * kWheels + (row->of_wheels ? wheel : 0)];
}

}  // namespace omnihil
