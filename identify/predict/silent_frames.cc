#include "identify/predict/silent_frames.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <string>

#include "identify/predict/channel.h"

namespace omnihil {
namespace {

constexpr double kSilent_s = 0.5;        // longer than a camera loses a robot and a filter holds it; a choice
constexpr std::size_t kSilentRows = 10;  // as above: a choice
constexpr double kTurned_rad = 0.3;      // least, by the wheels: 17 degrees no heading misses; a choice
constexpr double kDriven_m = 0.1;        // half a robot; a choice
constexpr double kSure_sigmas = 3.0;     // of a sum, beyond which it is a motion: p = 0.3 %, a choice

// Of the body by the wheels, a value a row: m/s, m/s, rad/s; NaN where a wheel is not known. Empty: not measured.
using Track = std::vector<double>;
std::array<Track, 3> motion_by_wheels(const Run& run, const RollingParams<double>& nominal,
                                      const RobotRecord& r) {
  const WheelGeometry<double> g = wheel_geometry(nominal);
  PerWheel<const Track*> reported{};
  for (std::size_t i = 0; i < r.wheels; ++i) {
    reported[i] = run.signal(numbered("wheel_speed", i, r.wheels));
    if (reported[i] == nullptr && !r.has_all_encoders) return {};
  }
  std::array<Track, 3> out;
  for (std::size_t k = 0; k < r.size(); ++k) {
    PerWheel<double> omega{};
    for (std::size_t i = 0; i < r.wheels; ++i) {
      const std::size_t before = k > 0 ? k - 1 : 0;
      omega[i] = reported[i] != nullptr ? (*reported[i])[k]
                 : k > 0                ? (r.theta_rotor_rad[k][i] - r.theta_rotor_rad[before][i]) /
                               (r.time_s[k] - r.time_s[before]) / nominal.drive.gear_ratio
                         : 0.0;
    }
    const BodyVelocity<double> v = body_velocity(g, omega);
    out[0].push_back(v.v_forward_m_s), out[1].push_back(v.v_left_m_s), out[2].push_back(v.omega_body_rad_s);
  }
  return out;
}

// The sum of a speed over rows (from, to], and three of its sigmas.
std::pair<double, double> moved(const RobotRecord& r, const Track& speed, double sigma, std::size_t from,
                                std::size_t to) {
  double sum = 0.0, dt2 = 0.0;
  for (std::size_t k = from + 1; k <= to; ++k) {
    const double dt_s = r.time_s[k] - r.time_s[k - 1];
    if (std::isfinite(speed[k])) sum += speed[k] * dt_s;
    dt2 += dt_s * dt_s;
  }
  return {sum, kSure_sigmas * sigma * std::sqrt(dt2)};
}

// Index of the last of the frames from `first` on that say the same; frames that do not see it are passed over.
template <typename Same>
std::size_t last_same(const std::vector<CameraFrame>& frames, std::size_t first, Same same) {
  std::size_t last = first;
  for (std::size_t n = first + 1; n < frames.size() && same(frames[first], frames[n]); ++n) last = n;
  return last;
}

// Calls silent(first, last) for all stretches of frames that are long enough to be a silence.
template <typename Same, typename Silent>
void for_stretches(const RobotRecord& r, Same same, Silent silent) {
  for (std::size_t first = 0; first < r.frames.size();) {
    const std::size_t last = last_same(r.frames, first, same);
    const double long_s = r.time_s[r.frames[last].sample] - r.time_s[r.frames[first].sample];
    if (last - first >= kSilentRows && long_s >= kSilent_s) silent(first, last);
    first = last + 1;
  }
}

}  // namespace

void drop_silent_frames(const Run& run, const RollingParams<double>& nominal, RobotRecord& r) {
  if (r.frames.size() <= kSilentRows) return;
  const std::array<Track, 3> speed = motion_by_wheels(run, nominal, r);
  if (speed[0].empty()) return;
  std::array<double, 3> sigma{};
  for (std::size_t a = 0; a < 3; ++a) sigma[a] = estimate_noise(speed[a]).sigma;
  // Coordinates that a frame has together.
  const auto drop = [&](const char* signal, std::initializer_list<std::size_t> axes, double least) {
    const auto same = [&](const CameraFrame& x, const CameraFrame& y) {
      return std::ranges::all_of(axes, [&](std::size_t a) { return x.pose[a] == y.pose[a]; });
    };
    for_stretches(r, same, [&](std::size_t first, std::size_t last) {
      const std::size_t from = r.frames[first].sample, to = r.frames[last].sample;
      double way = 0.0, least_sure = 0.0;
      for (const std::size_t a : axes) {
        const auto [along, sure] = moved(r, speed[a], sigma[a], from, to);
        way = std::hypot(way, along), least_sure = std::hypot(least_sure, sure);
      }
      if (way < std::max(least, least_sure)) return;
      r.silent.push_back({signal, from, to, r.frames[first].pose[*axes.begin()], way});
      for (std::size_t n = first; n <= last; ++n) {
        for (const std::size_t a : axes) r.frames[n].pose[a] = kMissing;
      }
    });
  };
  drop("vision_theta", {2}, kTurned_rad);
  drop("vision_x", {0, 1}, kDriven_m);
  std::erase_if(r.frames, [](const CameraFrame& f) { return !f.sees(); });
}

}  // namespace omnihil
