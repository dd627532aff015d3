#include "sim/robot/robot_sensing.h"

#include <cmath>

#include "sim/drive/encoder.h"
#include "sim/law/random.h"
#include "sim/law/sensor_reading.h"

namespace omnihil {
namespace {

ReadingStamp stamp(std::string_view stream, std::size_t which, const Sensing& at,
                   const RobotEffectMemory& memory) {
  return {.time_s = at.now.time_s,
          .dt_s = at.now.time_s - memory.read_s,
          .noise = NoiseKey{at.seed, stream_of(stream) + which, static_cast<std::uint64_t>(at.now_ns)}};
}

// Four to a robot; a fifth and sixth wheel have theirs far behind all robots' (2^20: no bench has so many).
std::size_t wheel_stream(std::size_t robot, std::size_t wheel) {
  constexpr std::size_t kFar = 1u << 20;
  return wheel < kWheels ? kWheels * robot + wheel : kFar + kWheels * robot + wheel - kWheels;
}

// How much older than its stamp a measurement of now is.
double age_s(const RobotEffects& effects, RobotEffectMemory& memory, Stamped what, const Sensing& at) {
  return reading_age(effects.set(), memory.timing.data(), what, stamp("timing", at.robot, at, memory));
}

// What a wheel's sensors make of its angle and of the mean current since the last read.
SensorPort<double> sense(const RobotEffects& effects, RobotEffectMemory& memory, const RobotModel& model,
                         std::size_t i, const RobotInstant& seen, double current_A, const Sensing& at) {
  SensorPort<double> port;
  port.theta_rotor_rad = port.encoder_angle_rad = seen.theta_rotor_rad[i];
  port.omega_rotor_rad_s = port.measured_speed_rad_s = seen.omega_rotor_rad_s[i];
  port.measured_current_A = current_A;
  port.counts_per_turn = model.encoder.counts_per_turn;
  read_encoder(effects.set(), memory.drive[i].effects.data(),
               stamp("sensor", wheel_stream(at.robot, i), at, memory),
               seen.theta_rotor_rad[i] - memory.seen_theta_rotor_rad[i], port);
  return port;
}

}  // namespace

PlantSensors read_sensors(const RobotEffects& effects, RobotEffectMemory& memory, const RobotHistory& history,
                          const RobotModel& model, const Sensing& at) {
  RobotInstant seen = at.now;
  if (effects.looks_back()) {
    seen = history.at(at.now.time_s - age_s(effects, memory, Stamped::kDriveSensors, at));
  }
  PlantSensors s;
  s.board.now_us = static_cast<std::uint64_t>(at.now_ns / 1000);
  const double span_s = seen.time_s - memory.seen_s;
  for (std::size_t i = 0; i < model.wheels; ++i) {
    // mean since what the last read showed
    const double current_A =
        span_s > 0.0 ? (seen.charge_C[i] - memory.seen_charge_C[i]) / span_s : at.current_A[i];
    const SensorPort<double> port = sense(effects, memory, model, i, seen, current_A, at);
    const double theta_rad = port.encoder_angle_rad;
    if (std::isfinite(theta_rad)) s.encoder_counts[i] = encoder_counts(model.encoder, theta_rad);
    s.motor_current_A[i] = port.measured_current_A;
    memory.seen_theta_rotor_rad[i] = seen.theta_rotor_rad[i];
    memory.seen_charge_C[i] = seen.charge_C[i];
  }
  memory.seen_s = seen.time_s;
  memory.read_s = at.now.time_s;
  s.board.bus_voltage_V = seen.bus_voltage_V;
  s.board.gyro_z_rad_s = seen.gyro_rad_s;
  s.board.accel_x_m_s2 = seen.accel_x_m_s2;
  s.board.accel_y_m_s2 = seen.accel_y_m_s2;
  return s;
}

RobotInstant seen_by_camera(const RobotEffects& effects, RobotEffectMemory& memory,
                            const RobotHistory& history, const Sensing& at) {
  if (!effects.looks_back()) return at.now;
  return history.at(at.now.time_s - age_s(effects, memory, Stamped::kVision, at));
}

}  // namespace omnihil
