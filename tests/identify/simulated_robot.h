// A simulated robot's recording: a model file's text, duties that excite all axes, and sensors that a model
// fills.
#pragma once
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "identify/predict/predictor.h"
#include "identify/record/rig.h"
#include "sim/law/effect_registry.h"

namespace omnihil::test {

inline constexpr const char* kRobotModel = R"(
format = "omnihil-model/1"
rig = "robot"
[motor]
resistance_ohm = { value = 0.464, tolerance = 0.08 }
inductance_H = 0.0003
torque_constant_Nm_per_A = { value = 0.0335, tolerance = 0.04 }
pole_pairs = 8
slots = 12
rotor_inertia_kg_m2 = 1.35e-5
viscous_friction_Nm_s_per_rad = { value = 4e-6, tolerance = 0.5 }
[gear]
ratio = 3.0
[supply]
voltage_V = { value = 22.2, tolerance = 0.005 }
[robot]
mass_kg = { value = 2.4, tolerance = 0.02 }
yaw_inertia_kg_m2 = { value = 0.012, tolerance = 0.15 }
center_of_mass_height_m = 0.045
wheel_center_radius_m = 0.0805
wheel_radius_m = { value = 0.027, tolerance = 0.01 }
wheel_inertia_kg_m2 = 2.2e-5
wheel_angle_deg = [55, 135, 225, 305]
rollers_per_wheel = 15
[effects.coulomb_friction]
torque_Nm = { value = 0.0027, tolerance = 0.1 }
)";

inline Candidate robot_candidate() {
  const ModelReading reading = read_model(kRobotModel, "model.toml", nullptr);
  for (const ModelProblem& p : reading.problems) ADD_FAILURE() << p.text();
  return candidate_of(*reading.model);
}

// Random-looking duties, smooth within 80 ms; measured signals zero, camera frames every 16 ms.
inline Dataset blank_robot(double duration_s, bool bus) {
  Dataset d;
  d.rig = &rig_robot();
  Run run;
  run.file = "drive.csv";
  const auto channel = [&](const std::string& signal, const char* unit, double sigma, double counts = 0.0) {
    d.channels.push_back(
        {.signal = signal, .column = signal, .unit = unit, .sigma = sigma, .counts_per_rev = counts});
  };
  const auto n = static_cast<std::size_t>(duration_s * 1000.0);
  for (std::size_t k = 0; k < n; ++k) run.time_s.push_back(1e-3 * static_cast<double>(k));
  for (int i = 1; i <= kWheels; ++i) {
    const std::string wheel = "_" + std::to_string(i);
    channel("duty" + wheel, "1", 0.0);
    channel("motor_current" + wheel, "A", 0.05);
    channel("encoder" + wheel, "counts", 0.0, 16384.0);
    run.signals["motor_current" + wheel].assign(n, 0.0);
    run.signals["encoder" + wheel].assign(n, 0.0);
    std::vector<double>& duty = run.signals["duty" + wheel];
    for (const double t : run.time_s) {
      duty.push_back(0.14 * std::sin(2.3 * t + 1.9 * i) + 0.08 * std::sin(9.1 * t * (1.0 + 0.1 * i)) +
                     0.03 * std::sin(41.0 * t + i));
    }
  }
  channel("gyro_z", "rad/s", 0.01);
  run.signals["gyro_z"].assign(n, 0.0);
  if (bus) {
    channel("bus_voltage", "V", 0.02);
    run.signals["bus_voltage"].assign(n, 22.1);
  }
  for (const char* name : {"vision_x", "vision_y", "vision_theta"}) {
    channel(name, name == std::string("vision_theta") ? "rad" : "m",
            name == std::string("vision_theta") ? 0.004 : 0.0008);
    std::vector<double>& seen = run.signals[name];
    seen.assign(n, std::numeric_limits<double>::quiet_NaN());
    for (std::size_t k = 0; k < n; k += 16) seen[k] = 0.0;
  }
  d.runs.push_back(run);
  d.runs.push_back(run);
  d.runs[1].split = Split::kValidation;
  return d;
}

// The dataset with what a simulated predictor of it measured: speeds summed up to counts.
inline Dataset measured(Dataset d, const Predictor& simulated) {
  for (std::size_t r = 0; r < d.runs.size(); ++r) {
    Run& run = d.runs[r];
    for (const ComparedSignal& c : simulated.compared(static_cast<int>(r))) {
      std::string name = c.name;
      const bool speed = name.starts_with("velocity");
      if (speed) name.replace(0, 8, "encoder");
      std::vector<double>& out = run.signals[name];
      const Channel* channel = d.channel(name);
      double counts = 0.0;
      for (std::size_t k = 0; k < out.size(); ++k) {
        const double v = std::isfinite(c.measured[k]) ? c.measured[k] : 0.0;
        if (speed && k > 0) {
          counts +=
              v * (run.time_s[k] - run.time_s[k - 1]) * channel->counts_per_rev / (2.0 * std::numbers::pi);
        }
        if (std::isfinite(out[k]) && name != "bus_voltage") out[k] = speed ? std::floor(counts + 0.5) : v;
      }
    }
  }
  return d;
}

// The record of a robot with these effects hidden in it: {{"payload.mass_kg", 0.2}, …}.
inline Dataset robot_record(const std::vector<std::pair<std::string, double>>& hidden, double duration_s) {
  const Candidate nominal = robot_candidate();
  Candidate truth = nominal;
  for (const auto& [path, value] : hidden) {
    truth = with_effect(truth, *find_effect(path.substr(0, path.find('.'))));
    EXPECT_EQ(set_value(truth, path, value), "");
  }
  const Dataset blank = blank_robot(duration_s, true);
  return measured(blank, *make_predictor(blank, nominal, {})->simulated(truth, 7));
}

}  // namespace omnihil::test
