// Simulated motion of a robot's run: the record's inputs through rolling_robot.h, sample by sample, and the
// outputs of its sensors.
//
//   RobotModelValues<Jet> m = robot_values<Jet>(candidate, unknowns, 0);      // unknown n is the Jet's component n
//   RobotMotion<Jet> y = run_robot(m, record, {});
//   y.encoder_rad[k][i], y.current_A[k][i], y.gyro_rad_s[k], y.x_m[k] …
//
// A record that goes on where another ended is run from where that one's motion was, by a RobotCarry: its first row is the
// last row of the one before, on the same clock. Cut anywhere, the motion is the whole record's (but for states of
// sensors' and timing's effects, which begin anew).
//
// Sensors as in robot_sensing.h: effects of Place::kSensor on the encoders, of Place::kTiming on the age of
// drive sensors and of camera frames; looked up on straight lines between samples.
#pragma once
#include <optional>

#include "identify/predict/candidate.h"
#include "identify/predict/firmware_source.h"
#include "identify/predict/rig_values.h"
#include "identify/predict/robot_record.h"

namespace omnihil {

template <typename T>
using RobotModelValues = RigValues<T, RollingParams>;

// For Jet: unknown `first` + n is the Jet's component n. Parameters that a run states as known have no
// derivative.
template <typename T>
RobotModelValues<T> robot_values(const Candidate& candidate, std::span<const Unknown> unknowns,
                                 std::size_t first);

struct RobotMotionOptions {
  double step_s = 1e-3;       // at most; a sample period is parted into equal steps
  bool slave_angle = true;    // laws of the angle take the measured angle
  bool follow_camera = true;  // false: heading and path are the model's own, from the record's start
  std::optional<std::uint64_t> noise_seed;  // for effects that draw random numbers; none: expected values
  // In the loop in place of the model's [controller] (firmware_loop.h): a motion of numbers alone, a Jet's derivatives are
  // not followed through it. Not owned; null: none.
  const FirmwareSource* firmware = nullptr;
};

// Where a motion was at its record's last row.
template <typename T>
struct RobotCarry {
  bool begun = false;
  RollingState<T> state;
  std::optional<RadioController<T>> controller;
  PerWheel<T> duty{}, turned_rad{};
  double last_control_s = 0.0, next_control_s = 0.0;
  T heading = T(0);
};

// n samples of the record each.
template <typename T>
struct RobotMotion {
  std::vector<PerWheel<T>> encoder_rad;  // unrounded, at the rotor
  std::vector<PerWheel<T>> wheel_rad_s;  // at the wheel; of a controller: as it measures them
  std::vector<PerWheel<T>> current_A;    // mean over the period that ends at the sample
  std::vector<T> gyro_rad_s, accel_x_m_s2, accel_y_m_s2;
  std::vector<T> force_x_N,
      force_y_N;  // of the floor on the wheels; empty unless the body's velocity is imposed
  std::vector<T> bus_voltage_V, supply_voltage_V;  // RollingState
  std::vector<T> temperature_rise_K;               // mean of the windings
  std::vector<std::array<T, 3>> velocity;          // body frame, true: without sensor; m/s, m/s, rad/s
  // Pose as the camera reports it, the corrections of follow_camera included; NaN between frames
  // (follow_camera) or where the record has none.
  std::vector<T> x_m, y_m, theta_rad;
  bool finite = true;
};

// `carry`: gone on from and left at the end; not owned; null: from the record's own start. A motion that is not finite
// leaves none.
template <typename T>
RobotMotion<T> run_robot(const RobotModelValues<T>& model, const RobotRecord& record,
                         const RobotMotionOptions& options, RobotCarry<T>* carry = nullptr);

}  // namespace omnihil
