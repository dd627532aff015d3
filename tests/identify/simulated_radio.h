// A robot of which the radio's commands are known and no duties: its model with a controller, and a drive at 60 Hz.
#pragma once
#include <cmath>
#include <string>

#include "identify/record/rig.h"
#include "tests/identify/simulated_robot.h"

namespace omnihil::test {

inline Candidate radio_candidate() {
  const std::string text = std::string(kRobotModel) + R"(
[controller]
kp_V_s_per_rad = { value = 0.03, tolerance = 0.2 }
ki_V_per_rad = { value = 0.3, tolerance = 0.2 }
feedforward_V_s_per_rad = 0.0335
speed_filter_s = 0.002
latency_s = { value = 0.02, tolerance = 0.5 }
acceleration_limit_m_s2 = 6.0
yaw_acceleration_limit_rad_s2 = 60.0
wheel_radius_m = 0.027
wheel_center_radius_m = 0.0805
)";
  const ModelReading reading = read_model(text, "model.toml", nullptr);
  for (const ModelProblem& p : reading.problems) ADD_FAILURE() << p.text();
  return candidate_of(*reading.model);
}

// Rows at 60 Hz: a command, four wheel speeds, gyro and camera in each.
inline Dataset blank_radio(double duration_s, bool wheels_commanded = false) {
  Dataset d;
  d.rig = &rig_robot();
  Run run;
  run.file = "drive.csv";
  const auto channel = [&](const std::string& signal, const char* unit, double sigma) {
    d.channels.push_back({.signal = signal, .column = signal, .unit = unit, .sigma = sigma});
  };
  const auto n = static_cast<std::size_t>(duration_s * 60.0);
  for (std::size_t k = 0; k < n; ++k) run.time_s.push_back(static_cast<double>(k) / 60.0);
  const auto asked = [&](const std::string& name, const char* unit, double size, double rate) {
    channel(name, unit, 0.0);
    for (const double t : run.time_s)
      run.signals[name].push_back(
          t < 0.3 ? 0.0 : size * std::copysign(1.0, std::sin(rate * t)) * (std::sin(0.7 * rate * t) > -0.5));
  };
  if (wheels_commanded) {
    for (int i = 1; i <= kWheels; ++i)
      asked("command_wheel_" + std::to_string(i), "rad/s", 20.0, 1.7 + 0.4 * i);
  } else {
    asked("command_vx", "m/s", 0.8, 2.1);
    asked("command_vy", "m/s", 0.6, 2.9);
    asked("command_w", "rad/s", 3.0, 1.3);
  }
  for (int i = 1; i <= kWheels; ++i) {
    channel("wheel_speed_" + std::to_string(i), "rad/s", 0.3);
    run.signals["wheel_speed_" + std::to_string(i)].assign(n, 0.0);
  }
  channel("gyro_z", "rad/s", 0.02);
  run.signals["gyro_z"].assign(n, 0.0);
  for (const char* name : {"vision_x", "vision_y", "vision_theta"}) {
    channel(name, name == std::string("vision_theta") ? "rad" : "m",
            name == std::string("vision_theta") ? 0.004 : 0.001);
    run.signals[name].assign(n, 0.0);
  }
  d.runs.push_back(run);
  d.runs.push_back(run);
  d.runs[1].split = Split::kValidation;
  return d;
}

// A host that says something new in most packets: a staircase along two axes.
inline Dataset staircase(double duration_s) {
  Dataset d = blank_radio(duration_s);
  for (Run& run : d.runs) {
    for (std::size_t k = 0; k < run.time_s.size(); ++k) {
      const double t = run.time_s[k];
      run.signals["command_vx"][k] = t < 0.3 ? 0.0 : 0.02 * std::round(40.0 * std::sin(2.1 * t));
      run.signals["command_vy"][k] = t < 0.3 ? 0.0 : 0.02 * std::round(30.0 * std::sin(2.9 * t));
      run.signals["command_w"][k] = 0.0;
    }
  }
  return d;
}

// What a robot did that did not hear the commands of `lost`; the file says what was sent.
inline Dataset measured_without(const Dataset& sent, const std::vector<std::size_t>& lost,
                                const Candidate& truth) {
  Dataset heard = sent;
  for (Run& run : heard.runs)
    for (const std::size_t k : lost)
      for (const char* name : {"command_vx", "command_vy", "command_w"}) run.signals[name][k] = kMissing;
  Dataset out = measured(heard, *make_predictor(heard, radio_candidate(), {})->simulated(truth, 3));
  for (std::size_t r = 0; r < out.runs.size(); ++r)
    for (const char* name : {"command_vx", "command_vy", "command_w"})
      out.runs[r].signals[name] = sent.runs[r].signals.at(name);
  return out;
}

// The wheels tell speeds to 0.05 rad/s; blank_radio's 0.3 hides a command that is one packet late.
inline Dataset with_quiet_wheels(Dataset d) {
  for (Channel& c : d.channels)
    if (c.signal.starts_with("wheel_speed")) c.sigma = 0.05;
  return d;
}

}  // namespace omnihil::test
