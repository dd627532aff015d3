// One run of rig "robot" as the simulation needs it: inputs of the bridges, measured angles and headings,
// velocity at the start. n samples each, at the units of the names.
//
//   RobotRecord r = robot_record(dataset, run, nominal);
//   r.duty_ratio[k];                    // held from sample k to the next
//
// Signals of one wheel alone have no number ("duty"), those of several have theirs ("duty_1").
// An empty duty is a bridge that is off. A missing sample of an input holds the one before.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "identify/predict/channel.h"
#include "sim/rolling/rolling_robot.h"

namespace omnihil {

struct CameraFrame {
  std::size_t sample = 0;
  std::array<double, 3> pose{};  // x and y in m, heading in rad, unwrapped; NaN: not seen
  bool sees() const {
    return std::any_of(pose.begin(), pose.end(), [](double v) { return std::isfinite(v); });
  }
};

// What the radio said, where the record has no duties: NaN where nothing new was said; all numbers of a command together.
struct RadioCommands {
  CommandFrame frame = CommandFrame::kBodyVelocity;
  std::size_t count = 3;                // of numbers in a command
  std::vector<PerWheel<double>> value;  // n samples; of a body three: m/s, m/s, rad/s; of wheels rad/s

  bool said(std::size_t k) const {
    return std::all_of(value[k].begin(), value[k].begin() + static_cast<std::ptrdiff_t>(count),
                       [](double v) { return std::isfinite(v); });
  }
};
RadioCommands radio_commands(const Run& run, std::size_t wheels);

// Rows of a sensor that repeated its last value while the robot drove on (silent_frames.h): not among the frames.
struct SilentStretch {
  std::string signal;
  std::size_t from = 0, to = 0;     // rows, both of them in it
  double value = 0.0, moved = 0.0;  // what it repeats, how far the wheels moved: rad or m
};

struct RobotRecord {
  std::size_t wheels = kWheels;  // of lists per wheel the first so many count
  std::vector<double> time_s;
  std::vector<PerWheel<double>> duty_ratio;  // 0 where `radio` drives
  std::optional<RadioCommands> radio;
  double loop_period_s = 0.0;  // of the [controller] that stands in for the firmware; 0: none does
  std::vector<PerWheel<bool>> enabled;
  BusReading bus;
  double duty_quantum = 0.0;  // step that the record's duties are rounded to; 0: none found
  std::vector<double> dribbler_rad_s;
  PerWheel<double> counts_per_rotor_turn{};         // 0: no encoder there
  std::vector<PerWheel<double>> encoder_rotor_rad;  // as counted
  std::vector<PerWheel<double>> theta_rotor_rad;    // the same without gaps
  bool has_all_encoders = false;
  std::vector<double> turned_rad;  // integral of the gyro; empty: none
  std::vector<CameraFrame> frames;
  std::vector<std::array<double, 3>> imposed_velocity;  // of the body, by the bench; empty: it moves freely
  std::vector<SilentStretch> silent;
  BodyVelocity<double> start_velocity;
  std::vector<BodyVelocity<double>>
      settled;  // of settled points (settled_points.h), each row's; empty: a series in time

  std::size_t size() const { return time_s.size(); }
  std::size_t inputs() const { return radio ? radio->count : wheels; }
};

// "encoder" of a wheel alone, else "encoder_1" of wheel 0 …
std::string numbered(std::string_view name, std::size_t wheel, std::size_t wheels);

// gear_ratio, wheel_radius_m and the wheels' places of the nominal model: for the start alone, and for
// encoders on the wheel.
RobotRecord robot_record(const Dataset& dataset, const Run& run, const RollingParams<double>& nominal);

// Rows from .. to, both of them, as a record that goes on where one that ends at `from` was. Without frames of a camera.
RobotRecord rows_of(const RobotRecord& record, std::size_t from, std::size_t to);

// One of a record's settled points, as a record in time: its inputs held until all has settled, the last row after that.
RobotRecord settled_point(const RobotRecord& record, std::size_t row);

// The record with another draw of its inputs' noise: uniform rounding error of the duties, the bus sensor's
// normal one.
RobotRecord with_input_noise(const RobotRecord& record, std::uint64_t seed);

}  // namespace omnihil
