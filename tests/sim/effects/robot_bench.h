// One robot on the floor with effects, for the signatures that only a robot shows; and single calls of laws.
#pragma once
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "sim/law/effect_registry.h"
#include "sim/model/effect_reader.h"
#include "tests/sim/robot/sample_robot.h"

namespace omnihil::test {

// "floor_tilt", "payload.mass_kg=0.5"
inline RobotModel robot_with(RobotModel model, const std::vector<std::string>& effects) {
  std::vector<EffectUse> uses;
  for (const std::string& text : effects) EXPECT_EQ(add_override(text, {}, uses), "");
  model.effects = std::make_shared<const std::vector<EffectUse>>(std::move(uses));
  return model;
}

inline Plant floor_with(const RobotModel& model, const std::vector<std::string>& effects,
                        Physics physics = Physics::kPlanar) {
  PlantOptions o = planar_options(500'000);
  o.physics = physics;
  return one_robot(effects.empty() ? model : robot_with(model, effects), o);
}

// Duties that roll a mirror-symmetric robot straight ahead: eq. (5) for v_forward alone.
inline RobotDrive forward(const RobotModel& m, double duty) {
  PerWheel<double> d{};
  for (std::size_t i = 0; i < kWheels; ++i) d[i] = -duty * std::sin(m.wheel_angle_rad[i]);
  return duty_drive(d);
}
inline RobotDrive sideways(const RobotModel& m, double duty) {
  PerWheel<double> d{};
  for (std::size_t i = 0; i < kWheels; ++i) d[i] = duty * std::cos(m.wheel_angle_rad[i]);
  return duty_drive(d);
}

inline void drive_for(Plant& plant, const RobotDrive& drive, double time_s) {
  plant.write(0, drive);
  plant.advance(std::llround(time_s * 1e3) * 1'000'000);
}

// One call of a law.
template <typename Port>
Port called(const char* id, const std::vector<double>& params, Port port) {
  const EffectEntry& entry = *find_effect(id);
  const auto& f = entry.simulate;
  if constexpr (std::is_same_v<Port, ContactPort<double>>) f.contact(nullptr, params.data(), nullptr, port);
  if constexpr (std::is_same_v<Port, BodyPort<double>>) f.body(nullptr, params.data(), nullptr, port);
  if constexpr (std::is_same_v<Port, WindingPort<double>>) f.winding(nullptr, params.data(), nullptr, port);
  return port;
}

}  // namespace omnihil::test
