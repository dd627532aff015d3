// What the sensors of a robot with effects show: encoders through the effects of Place::kSensor, everything
// as old as the effects of Place::kTiming make it.
//
//   PlantSensors s = read_sensors(effects, memory, history, model, {now, now_ns, seed, robot});
//   RobotInstant seen = seen_by_camera(effects, memory, history, {now, now_ns, seed, robot});
//
// Random numbers are a function of seed, robot, wheel and time, not of how often one asks.
// Cannot represent: ages beyond kLongestAge_s, noise of gyro and accelerometer.
#pragma once
#include "sim/robot/robot_effects.h"
#include "sim/robot/robot_history.h"

namespace omnihil {

inline constexpr double kLongestAge_s = 1.0;

struct Sensing {
  RobotInstant now;
  std::int64_t now_ns = 0;
  std::uint64_t seed = 0;
  std::size_t robot = 0;
  PerWheel<double> current_A{};  // at this instant
};

PlantSensors read_sensors(const RobotEffects& effects, RobotEffectMemory& memory, const RobotHistory& history,
                          const RobotModel& model, const Sensing& at);
RobotInstant seen_by_camera(const RobotEffects& effects, RobotEffectMemory& memory,
                            const RobotHistory& history, const Sensing& at);

}  // namespace omnihil
