// The signals a scenario's checks and plots look at, and the record of a run: one row per control period.
//
//   ScenarioTrace trace;
//   trace.add(now_s, sample);
//   std::span<const double> y = trace.column("omega_wheel_rad_s", 2);
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hil/loop/session.h"
#include "sim/robot/geometry.h"

namespace omnihil {

// One control period, as the bench saw it.
struct ScenarioSample {
  RobotSample robot;
  bool commanded = false;  // a command was sent already
  BodyVelocity<double> wanted_body;
  PerWheel<double> wanted_wheel_rad_s{};
  double missed_periods = 0, refused_requests = 0;                             // so far
  Vector3 ball_m{0, 0, 0}, ball_m_s{0, 0, 0};                                  // without a ball: zero
  double goals = 0, kicks = 0, ball_touches = 0, robot_touches = 0, tips = 0;  // so far
};

struct ScenarioSignal {
  std::string_view name;    // ends in the unit's suffix
  std::string_view suffix;  // "rad_s"
  std::string_view unit;    // "rad/s"
  bool of_wheels;
  std::string_view target;  // the signal that a command sets for it; empty: none
  std::string_view what;
  double (*value)(const ScenarioSample& sample, std::size_t wheel);
};

// "var:wheel[2].integral": a variable of the firmware, by name (hil/variables/); its row is the same for all.
inline constexpr std::string_view kVariablePrefix = "var:";

std::span<const ScenarioSignal> scenario_signals();
const ScenarioSignal* find_scenario_signal(std::string_view name);

class ScenarioTrace {
 public:
  // `variables`: names of what RobotSample::watched holds.
  explicit ScenarioTrace(std::vector<std::string> variables = {});
  void add(double now_s, const ScenarioSample& sample);
  std::span<const double> time_s() const { return time_s_; }
  std::span<const double> column(std::string_view signal, std::size_t wheel = 0) const;
  const std::vector<std::string>& variables() const { return variables_; }

 private:
  std::vector<double> time_s_;
  std::vector<std::vector<double>> columns_;  // signal by signal, four each; then a variable each
  std::vector<std::string> variables_;
};

}  // namespace omnihil
