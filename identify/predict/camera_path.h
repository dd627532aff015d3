// A camera beside a robot: the heading that it gives the body, and what it makes of the model's path.
//
//   std::vector<Jet> heading = headings<Jet>(record, camera_age_s);        // of the body in the field, per sample
//   see_path<Jet>(record, {.follow = true, .age_s = camera_age_s, .heading = heading}, samples);
//
// Law: path and heading by the trapezoidal rule over the body's speeds. Where the camera is followed, the path is moved
// towards its frames by a first order filter of their difference: an error of speed dv appears as 0.5 s dv and does not grow.
// Cannot: lens errors; a clock of its own is own_clock.h's.
#pragma once
#include <vector>

#include "identify/predict/robot_record.h"

namespace omnihil {

template <typename T>
struct RollingSample;

// Time constant of the model path's correction towards the camera: above a camera's millimetres for 10 mm/s. A choice;
// sensitivity not measured.
inline constexpr double kFollowCamera_s = 0.5;  // a choice

// Heading of the body in rad, n samples, as measured; empty where neither gyro nor camera give one: the gyro's integral,
// corrected to the camera's over a second. A camera's frame is `age` older than its stamp.
template <typename T>
std::vector<T> headings(const RobotRecord& record, const T& camera_age_s);

template <typename T>
struct CameraView {
  bool follow = true;             // the path is corrected by the frames, and told at them alone
  const T& age_s;                 // of a frame at its stamp
  const std::vector<T>& heading;  // measured; empty: the path's own
};

// Fills the poses of the samples, whose speeds are known.
template <typename T>
void see_path(const RobotRecord& record, const CameraView<T>& camera, std::vector<RollingSample<T>>& samples);

}  // namespace omnihil
