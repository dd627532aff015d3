#include "identify/predict/camera_path.h"

#include <algorithm>
#include <cmath>

#include "identify/predict/interpolation.h"
#include "identify/predict/own_clock.h"
#include "identify/predict/robot_motion.h"

namespace omnihil {
namespace {

// Time constant of the correction of the gyro's integral to the camera's heading.
constexpr double kHeadingMemory_s = 1.0;  // a choice; sensitivity not measured

// Means over both sides, weighted by exp(-|dt| / memory).
template <typename T>
std::vector<T> smoothed(const std::vector<double>& time_s, const std::vector<T>& values, double memory_s) {
  const std::size_t n = values.size();
  std::vector<T> sum = values;
  std::vector<double> weight(n, 1.0);
  for (const bool forward : {true, false}) {
    T carried = T(0);
    double carried_weight = 0.0;
    for (std::size_t i = 1; i < n; ++i) {
      const std::size_t k = forward ? i : n - 1 - i, last = forward ? k - 1 : k + 1;
      const double keep = std::exp(-std::abs(time_s[k] - time_s[last]) / memory_s);
      carried = (carried + values[last]) * keep;
      carried_weight = (carried_weight + 1.0) * keep;
      sum[k] += carried;
      weight[k] += carried_weight;
    }
  }
  for (std::size_t k = 0; k < n; ++k) sum[k] /= weight[k];
  return sum;
}

// One coordinate of the path as the camera says it: as old as its frames, and at the frames alone (NaN between),
// corrected by the camera's earlier ones where they are followed: first order filter of its difference to the path.
template <typename T>
void report(const RobotRecord& r, const CameraView<T>& camera, std::size_t axis,
            std::vector<RollingSample<T>>& samples) {
  std::vector<T> path;
  for (const RollingSample<T>& s : samples) path.push_back(s.pose[axis]);
  const auto there_at = [&](std::size_t k) {
    if (is_exactly(camera.age_s, 0.0)) return path[k];
    return instant(r.time_s, T(r.time_s[k] - camera.age_s)).of([&](std::size_t j) { return path[j]; });
  };
  for (std::size_t k = 0; k < path.size(); ++k)
    samples[k].pose[axis] = camera.follow ? T(kMissing) : there_at(k);
  if (!camera.follow) return;
  T correction = T(0);
  double last_s = kMissing, frames = 0.0;
  for (const CameraFrame& f : r.frames) {
    if (!std::isfinite(f.pose[axis])) continue;
    const double now_s = r.time_s[f.sample];
    const T there = there_at(f.sample);
    T& out = samples[f.sample].pose[axis];
    if (!std::isfinite(last_s)) {
      correction = f.pose[axis] - there;  // the first frame is the path's origin, and is not compared
    } else {
      out = there + correction;
      correction += (f.pose[axis] - out) * follow_gain(now_s - last_s, kFollowCamera_s, frames);
    }
    last_s = now_s;
    frames += 1.0;
  }
}

}  // namespace

template <typename T>
void see_path(const RobotRecord& r, const CameraView<T>& camera, std::vector<RollingSample<T>>& samples) {
  using std::cos;
  using std::sin;
  T vx = T(0), vy = T(0);
  const auto seen =
      std::ranges::find_if(r.frames, [](const CameraFrame& f) { return std::isfinite(f.pose[2]); });
  if (!camera.follow && seen != r.frames.end()) samples[0].pose[2] = T(seen->pose[2]);
  for (std::size_t k = 0; k < r.size(); ++k) {
    RollingSample<T>& s = samples[k];
    const RollingSample<T>& before = samples[k > 0 ? k - 1 : 0];
    const double half_s = k > 0 ? 0.5 * (r.time_s[k] - r.time_s[k - 1]) : 0.0;
    if (k > 0) s.pose[2] = before.pose[2] + half_s * (before.velocity[2] + s.velocity[2]);
    const T& heading = camera.heading.empty() ? s.pose[2] : camera.heading[k];
    const T cosine = cos(heading), sine = sin(heading);
    const T wx = cosine * s.velocity[0] - sine * s.velocity[1];
    const T wy = sine * s.velocity[0] + cosine * s.velocity[1];
    s.pose[0] = before.pose[0] + half_s * (vx + wx);
    s.pose[1] = before.pose[1] + half_s * (vy + wy);
    vx = wx;
    vy = wy;
  }
  for (std::size_t axis = 0; axis < 3; ++axis) report(r, camera, axis, samples);
}

template <typename T>
std::vector<T> headings(const RobotRecord& r, const T& camera_age_s) {
  std::vector<double> seen_s, seen_rad;
  for (const CameraFrame& f : r.frames) {
    if (!std::isfinite(f.pose[2])) continue;
    seen_s.push_back(r.time_s[f.sample]);
    seen_rad.push_back(f.pose[2]);
  }
  const auto at = [](const std::vector<double>& clock_s, const T& at_s, const auto& values) {
    return instant(clock_s, at_s).of([&](std::size_t k) { return T(values[k]); });
  };
  std::vector<T> heading, offset;
  if (r.turned_rad.empty()) {
    for (std::size_t k = 0; k < r.size() && !seen_s.empty(); ++k)
      heading.push_back(at(seen_s, T(r.time_s[k] + camera_age_s), seen_rad));
    return heading;
  }
  for (std::size_t n = 0; n < seen_s.size(); ++n)
    offset.push_back(seen_rad[n] - at(r.time_s, T(seen_s[n] - camera_age_s), r.turned_rad));
  if (!offset.empty()) offset = smoothed(seen_s, offset, kHeadingMemory_s);
  for (std::size_t k = 0; k < r.size(); ++k) {
    heading.push_back(T(r.turned_rad[k]));
    if (!offset.empty()) heading[k] += at(seen_s, T(r.time_s[k]), offset);
  }
  return heading;
}

template std::vector<double> headings(const RobotRecord&, const double&);
template std::vector<Jet> headings(const RobotRecord&, const Jet&);
template void see_path(const RobotRecord&, const CameraView<double>&, std::vector<RollingSample<double>>&);
template void see_path(const RobotRecord&, const CameraView<Jet>&, std::vector<RollingSample<Jet>>&);

}  // namespace omnihil
