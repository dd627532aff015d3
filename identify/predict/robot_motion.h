// Simulated motion of a robot's run: the record's inputs through rolling_robot.h, sample by sample, and the
// outputs of its sensors.
//
//   RobotModelValues<Jet> m = rolling_values<Jet>({candidate, unknowns});     // unknown n is the Jet's component n
//   RobotMotion<Jet> y = run_robot(m, record, {});
//   y.samples[k].encoder_rad[i], y.samples[k].gyro_rad_s, y.samples[k].pose[0] …
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

struct RobotMotionOptions {
  bool slave_angle = true;    // laws of the angle take the measured angle
  bool follow_camera = true;  // false: heading and path are the model's own, from the record's start
  bool rough = false;         // on tyres, too, in steps of kRollingStep_s
  std::optional<std::uint64_t> noise_seed;  // for effects that draw random numbers; none: expected values
  // In the loop in place of the model's [controller] (firmware_loop.h): a motion of numbers alone, a Jet's derivatives are
  // not followed through it. Not owned; null: none.
  const FirmwareSource* firmware = nullptr;
};

// Where a motion is: at its record's last row, for the next record to go on from.
template <typename T>
struct RobotCarry {
  bool begun = false;
  RollingState<T> state;
  std::optional<RadioController<T>> controller;
  PerWheel<T> duty{}, turned_rad{};
  double last_control_s = 0.0, next_control_s = 0.0;
  T heading = T(0);
};

template <typename T>
struct RollingSample {
  // as measured (through sensor and timing effects)
  PerWheel<T> encoder_rad{};  // unrounded, at the rotor
  PerWheel<T> wheel_rad_s{};  // at the wheel; of a controller: as it measures them
  PerWheel<T> current_A{};    // mean over the period that ends at the sample
  T gyro_rad_s = T(0);
  std::array<T, 2> accel_m_s2{}, force_N{};  // along x and y; force: of the floor on the wheels
  // x and y in m, heading in rad as the camera reports them, the corrections of follow_camera included; NaN between
  // frames (follow_camera) or where the record has none.
  std::array<T, 3> pose{};
  // true
  T bus_voltage_V = T(0), supply_voltage_V = T(0);  // RollingState
  T temperature_rise_K = T(0);                      // mean of the windings
  std::array<T, 3> velocity{};                      // body frame; m/s, m/s, rad/s
};

template <typename T>
struct RobotMotion {
  std::vector<RollingSample<T>> samples;  // one per sample of the record
  bool finite = true;                     // false: the run diverged; samples after that are NaN
};

// `carry`: gone on from and left at the end; not owned; null: from the record's own start. A motion that is not finite
// leaves none.
template <typename T>
RobotMotion<T> run_robot(const RobotModelValues<T>& model, const RobotRecord& record,
                         const RobotMotionOptions& options, RobotCarry<T>* carry = nullptr);

}  // namespace omnihil
