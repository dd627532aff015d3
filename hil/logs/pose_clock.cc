#include "hil/logs/pose_clock.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace omnihil {
namespace {

using Complex = std::complex<double>;

constexpr double kStep_s = 0.01;   // of the search; a sample of usual logs
constexpr double kSmooth_s = 0.2;  // encoders' noise goes, a drive's turns stay; a choice
constexpr double kOverlap = 0.5;   // of either one's motion, by its energy: less is another drive
constexpr double kAlike =
    0.6;  // least correlation; noise alone of n independent stretches has 1 / sqrt(n): 10 s, 0.14
constexpr double kKnown_s =
    0.2;  // sigma of a lag that is worth having: a fifth of a drive's usual second; a choice

std::vector<Complex> smoothed(const std::vector<Complex>& v) {
  const auto half = static_cast<std::ptrdiff_t>(0.5 * kSmooth_s / kStep_s),
             n = static_cast<std::ptrdiff_t>(v.size());
  std::vector<Complex> sum(v.size() + 1), out;
  for (std::size_t k = 0; k < v.size(); ++k) sum[k + 1] = sum[k] + v[k];
  for (std::ptrdiff_t k = 0; k < n; ++k) {
    const std::ptrdiff_t from = std::max<std::ptrdiff_t>(0, k - half), to = std::min(n, k + half + 1);
    out.push_back((sum[static_cast<std::size_t>(to)] - sum[static_cast<std::size_t>(from)]) /
                  static_cast<double>(to - from));
  }
  return out;
}

// Every kStep_s from the first instant, straight lines between samples.
std::vector<Complex> evenly(const MotionTrack& t) {
  std::vector<Complex> out;
  std::size_t k = 0;
  for (double at = t.time_s.front(); at <= t.time_s.back();
       at = t.time_s.front() + kStep_s * static_cast<double>(out.size())) {
    while (k + 2 < t.time_s.size() && t.time_s[k + 1] <= at) ++k;
    const double part = std::clamp((at - t.time_s[k]) / (t.time_s[k + 1] - t.time_s[k]), 0.0, 1.0);
    out.push_back(t.velocity_m_s[k] + (t.velocity_m_s[k + 1] - t.velocity_m_s[k]) * part);
  }
  return smoothed(out);
}

struct Match {
  Complex product = 0.0;
  double robot = 0.0, pose = 0.0;  // energies where both are
  double correlation() const {
    return robot > 0.0 && pose > 0.0 ? std::abs(product) / std::sqrt(robot * pose) : 0.0;
  }
};

// The pose's sample k + lag beside the robot's sample k, from <= k < to.
Match match(const std::vector<Complex>& robot, const std::vector<Complex>& pose, std::ptrdiff_t lag,
            std::ptrdiff_t from, std::ptrdiff_t to) {
  Match m;
  for (std::ptrdiff_t k = std::max(from, -lag);
       k < std::min(to, static_cast<std::ptrdiff_t>(pose.size()) - lag); ++k) {
    const Complex a = robot[static_cast<std::size_t>(k)], b = pose[static_cast<std::size_t>(k + lag)];
    m.product += std::conj(a) * b;
    m.robot += std::norm(a);
    m.pose += std::norm(b);
  }
  return m;
}

double energy(const std::vector<Complex>& v) {
  double sum = 0.0;
  for (const Complex& x : v) sum += std::norm(x);
  return sum;
}

// Of the lags from `low` to `high`, refined between steps; none: nowhere is enough of both.
std::optional<double> best_lag(const std::vector<Complex>& robot, const std::vector<Complex>& pose,
                               std::ptrdiff_t low, std::ptrdiff_t high, std::ptrdiff_t from,
                               std::ptrdiff_t to, double least_robot, double least_pose) {
  std::vector<double> score;
  for (std::ptrdiff_t lag = low; lag <= high; ++lag) {
    const Match m = match(robot, pose, lag, from, to);
    score.push_back(m.robot >= least_robot && m.pose >= least_pose ? m.correlation() : 0.0);
  }
  const auto top = std::max_element(score.begin(), score.end());
  if (top == score.end() || *top <= 0.0) return std::nullopt;
  const auto at = static_cast<double>(low + (top - score.begin()));
  if (top == score.begin() || top + 1 == score.end()) return at;
  const double curvature = top[-1] - 2.0 * top[0] + top[1];
  return curvature < 0.0 ? at + std::clamp(0.5 * (top[-1] - top[1]) / curvature, -0.5, 0.5) : at;
}

// What v_robot less v_pose / c leaves, c = scale exp(i frame), is noise of both components; with v = v_pose / c, d/dlag of the
// model is v', d/dframe is i v.
void add_sigmas(const std::vector<Complex>& robot, const std::vector<Complex>& pose, std::ptrdiff_t lag,
                PoseClock& out) {
  const Complex c = std::polar(out.scale, out.frame_rad);
  double of_lag = 0.0, of_frame = 0.0, of_both = 0.0, rest = 0.0, count = 0.0;
  // not at the ends, where the mean is of one side
  const auto half = static_cast<std::ptrdiff_t>(0.5 * kSmooth_s / kStep_s) + 1,
             n = static_cast<std::ptrdiff_t>(robot.size()), m = static_cast<std::ptrdiff_t>(pose.size());
  for (std::ptrdiff_t k = std::max(half, half - lag); k < std::min(n, m - lag) - half; ++k) {
    const auto at = static_cast<std::size_t>(k + lag);
    const Complex v = pose[at] / c, turn = Complex(0.0, 1.0) * v,
                  slope = (pose[at + 1] - pose[at - 1]) / (2.0 * kStep_s) / c;
    of_lag += std::norm(slope);
    of_frame += std::norm(turn);
    of_both += (std::conj(slope) * turn).real();
    rest += std::norm(robot[static_cast<std::size_t>(k)] - v);
    count += 1.0;
  }
  const double noise2 = count > 0.0 ? 0.5 * rest / count * kSmooth_s / kStep_s : 0.0;
  const double det = of_lag * of_frame - of_both * of_both;
  // Relative to its terms: below, rounding decides.
  const bool told = det > 1e-12 * of_lag * of_frame;
  out.sigma_s = told ? std::sqrt(noise2 * of_frame / det) : INFINITY;
  out.frame_sigma_rad = told ? std::sqrt(noise2 * of_lag / det) : INFINITY;
}

}  // namespace

MotionTrack track_of_path(const std::vector<double>& time_s, const std::vector<Complex>& place,
                          double span_s) {
  MotionTrack t;
  std::size_t from = 0, to = 0;
  for (std::size_t k = 0; k < time_s.size(); ++k) {
    while (time_s[k] - time_s[from] > 0.5 * span_s) ++from;
    while (to + 1 < time_s.size() && time_s[to] - time_s[k] < 0.5 * span_s) ++to;
    if (to == from) continue;
    const double middle_s = 0.5 * (time_s[from] + time_s[to]);  // at the ends the chord has one side only
    if (!t.time_s.empty() && middle_s <= t.time_s.back()) continue;
    t.time_s.push_back(middle_s);
    t.velocity_m_s.push_back((place[to] - place[from]) / (time_s[to] - time_s[from]));
  }
  return t;
}

PoseClock pose_clock(const MotionTrack& robot_track, const MotionTrack& pose_track) {
  PoseClock out;
  if (robot_track.time_s.size() < 2 || pose_track.time_s.size() < 2) {
    out.problem = "a track of less than two samples";
    return out;
  }
  const std::vector<Complex> robot = evenly(robot_track), pose = evenly(pose_track);
  const auto n = static_cast<std::ptrdiff_t>(robot.size()), m = static_cast<std::ptrdiff_t>(pose.size());
  const auto lag = best_lag(robot, pose, -n, m, 0, n, kOverlap * energy(robot), kOverlap * energy(pose));
  const Match at = lag ? match(robot, pose, std::llround(*lag), 0, n) : Match{};
  out.correlation = at.correlation();
  if (!lag || out.correlation < kAlike) {
    out.problem = fmt::format(
        "the two logs do not tell one motion at any lag: the best correlation is {:.2f}, needed is {:.2f}",
        out.correlation, kAlike);
    return out;
  }
  out.offset_s = pose_track.time_s.front() - robot_track.time_s.front() + *lag * kStep_s;
  out.frame_rad = std::arg(at.product);
  out.scale =
      at.pose /
      std::abs(at.product);  // the noise is the wheels': over their own energy it would come out too small
  add_sigmas(robot, pose, std::llround(*lag), out);
  if (!(out.sigma_s < kKnown_s))
    out.problem = fmt::format(
        "they agree at many lags: the best is known to {:.2g} s, needed is {:.1f} s; a drive whose velocity "
        "changes has one",
        out.sigma_s, kKnown_s);
  return out;
}

}  // namespace omnihil
