// What the firmware first did otherwise: the earliest sample at which it asks something else of its bridges.
//
//   if (const auto difference = first_drive_difference(recorded, replayed)) difference->text();
//   // "robot 0, 0.0400 s, wheel 3: duty -0.312 instead of 0.312; wheels 1 to 4 1.000, 1.000, -1.000, 1.000 times …: a sign"
//
// Compared are the duties and drive modes of the samples. What comes of it depends on how close the samples lie:
// after some ticks wheels, encoders and duties all differ, and the ratio of the duties is no longer that of the gains.
// Cannot: name a gain (control_law.h does), or see what phases ask.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "hil/recording/recording.h"
#include "sim/robot/plant.h"

namespace omnihil {

struct DriveDifference {
  std::int64_t now_ns = 0;
  int robot_id = -1;
  int wheel = 0;  // from 0, with the largest difference of this sample
  double recorded_duty = 0.0, replayed_duty = 0.0;
  bool mode_differs = false;            // bridges on or off, too
  std::array<double, kWheels> ratio{};  // replayed by recorded duty of each wheel; NaN below 1 % of duty
  double host_silent_s = 0.0;           // since the host's last byte
  double host_interval_s = 0.0;         // median time between the host's writes up to then
  bool sensors_differ = false;          // in this sample or before it

  std::string text() const;
};

// Differences of duty up to `tolerance` (ratio) do not count.
std::optional<DriveDifference> first_drive_difference(const Recording& recorded, const Recording& replayed,
                                                      double tolerance = 1e-9);

}  // namespace omnihil
