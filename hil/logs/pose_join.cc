#include "hil/logs/pose_join.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "hil/logs/pose_clock.h"

namespace omnihil {
namespace {

using Complex = std::complex<double>;
constexpr double kEmpty = std::numeric_limits<double>::quiet_NaN();
constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr double kChord_s =
    0.1;  // over which a path's speed is taken: a camera's millimetres are centimetres a second

std::vector<ColumnMap> asked_of(const LogTable& table, const std::vector<ColumnMap>& asked) {
  std::vector<ColumnMap> out;
  for (const ColumnMap& a : asked) {
    const bool here = std::any_of(table.series.begin(), table.series.end(),
                                  [&](const LogSeries& s) { return s.name == a.column; });
    if (here) out.push_back(a);
  }
  return out;
}

// In the signal's own unit; empty: not there.
std::vector<double> values_of(const LogTable& table, const LogMeaning& meaning, std::string_view signal) {
  const ColumnMeaning* m = meaning.of(signal);
  if (m == nullptr) return {};
  std::vector<double> out = table.series[m->series].value;
  for (double& v : out) v = v * m->scale.scale + m->scale.offset;
  return out;
}

void need_clock(const LogTable& table, const std::vector<double>& time_s, const std::string& name) {
  if (!table.by_rows())
    throw BadLog(name + ": --pose takes tables whose rows have a time; this log has topics");
  if (time_s.size() < 2) throw BadLog(name + ": no column is the time; give --map \"COLUMN=time:s\"");
}

// Wheels' speeds, rad/s; rows by wheel. Empty: not measured.
std::vector<std::vector<double>> wheel_speeds_of(const LogTable& log, const LogMeaning& meaning,
                                                 const std::vector<double>& time_s, const PoseGeometry& g) {
  std::vector<std::vector<double>> out;
  for (std::size_t i = 1; i <= g.wheels.wheels; ++i) {
    std::vector<double> speed = values_of(log, meaning, fmt::format("wheel_speed_{}", i));
    if (speed.empty() && g.counts_per_rotor_turn > 0.0) {
      const std::vector<double> counts = values_of(log, meaning, fmt::format("encoder_{}", i));
      const double rad = kTurn / g.counts_per_rotor_turn / g.gear_ratio;
      for (std::size_t k = 0; k < counts.size(); ++k)
        speed.push_back(k == 0 ? 0.0 : (counts[k] - counts[k - 1]) * rad / (time_s[k] - time_s[k - 1]));
    }
    if (speed.empty()) return {};
    out.push_back(std::move(speed));
  }
  return out;
}

// Body velocity by the wheels, turned by the robot's own heading: measured, else by the gyro, else by the wheels.
MotionTrack robot_track(const LogTable& log, const LogMeaning& meaning, const PoseGeometry& g,
                        bool turn_alone, const std::string& name) {
  const std::vector<double> time_s = values_of(log, meaning, "time");
  need_clock(log, time_s, name);
  const auto speeds = wheel_speeds_of(log, meaning, time_s, g);
  if (speeds.empty())
    throw BadLog(fmt::format("{}: --pose needs the speeds of all {} wheels: wheel_speed_1 … or encoder_1 …",
                             name, g.wheels.wheels));
  const std::vector<double> theta = values_of(log, meaning, "vision_theta"),
                            gyro = values_of(log, meaning, "gyro_z");
  MotionTrack out;
  double heading = 0.0;
  for (std::size_t k = 0; k < time_s.size(); ++k) {
    PerWheel<double> omega{};
    for (std::size_t i = 0; i < g.wheels.wheels; ++i)
      omega[i] = std::isfinite(speeds[i][k]) ? speeds[i][k] : 0.0;
    const BodyVelocity<double> v = body_velocity(g.wheels, omega);
    const double turn = !gyro.empty() && std::isfinite(gyro[k]) ? gyro[k] : v.omega_body_rad_s;
    if (k > 0) heading += turn * (time_s[k] - time_s[k - 1]);
    if (!theta.empty() && std::isfinite(theta[k])) heading = theta[k];
    if (k > 0 && !(time_s[k] > time_s[k - 1])) continue;
    out.time_s.push_back(time_s[k]);
    out.velocity_m_s.push_back(
        turn_alone ? Complex(turn, 0.0) : Complex(v.v_forward_m_s, v.v_left_m_s) * std::polar(1.0, heading));
  }
  return out;
}

// A place is moved by distance from the start times the angle's sigma, half of its square along an axis.
double moved_by_frame_m(const std::vector<Complex>& seen, const PoseClock& clock) {
  double far2 = 0.0;
  for (const Complex& p : seen) far2 += std::norm(p - seen.front());
  return clock.frame_sigma_rad * std::sqrt(0.5 * far2 / static_cast<double>(seen.size()));
}
// The same of the lag's: speed times it.
double moved_by_clock_m(const std::vector<double>& seen_s, const std::vector<Complex>& seen,
                        const PoseClock& clock) {
  const MotionTrack way = track_of_path(seen_s, seen, kChord_s);
  double rate2 = 0.0;
  for (const Complex& v : way.velocity_m_s) rate2 += std::norm(v);
  rate2 /= static_cast<double>(std::max<std::size_t>(1, way.velocity_m_s.size()));
  return clock.sigma_s * std::sqrt(0.5 * rate2);
}

std::vector<double> unwrapped(std::vector<double> angle) {
  double last = kEmpty;
  for (double& a : angle) {
    if (!std::isfinite(a)) continue;
    if (std::isfinite(last)) a = last + std::remainder(a - last, kTurn);
    last = a;
  }
  return angle;
}

}  // namespace

JoinedPose join_pose(const LogTable& log, const LogTable& pose, const std::vector<ColumnMap>& asked,
                     const PoseGeometry& geometry, const MeaningContext& context, const std::string& log_name,
                     const std::string& pose_name) {
  JoinedPose out{.table = log, .asked = asked_of(log, asked), .columns = {}, .note = {}};
  const LogMeaning of_log = recognise(log, context, out.asked),
                   of_pose = recognise(pose, context, asked_of(pose, asked));
  const std::vector<double> time_s = values_of(pose, of_pose, "time"),
                            x = values_of(pose, of_pose, "vision_x"),
                            y = values_of(pose, of_pose, "vision_y"),
                            theta = values_of(pose, of_pose, "vision_theta");
  need_clock(pose, time_s, pose_name);
  const bool places = !x.empty() && !y.empty();
  if (!places && theta.empty())
    throw BadLog(pose_name + ": no pose: give --map \"COLUMN=vision_x:m\" and vision_y, or vision_theta");
  // A frame in which the camera did not see the robot tells nothing.
  std::vector<double> seen_s;
  std::vector<Complex> seen;
  std::vector<std::size_t> frame;
  const std::vector<double> heading = unwrapped(theta);
  for (std::size_t k = 0; k < time_s.size(); ++k) {
    const Complex at = places ? Complex(x[k], y[k]) : Complex(heading[k], 0.0);
    if (!std::isfinite(time_s[k]) || !std::isfinite(at.real()) || !std::isfinite(at.imag())) continue;
    seen_s.push_back(time_s[k]), seen.push_back(at), frame.push_back(k);
  }
  const PoseClock clock = pose_clock(robot_track(log, of_log, geometry, !places, log_name),
                                     track_of_path(seen_s, seen, kChord_s));
  if (!clock.problem.empty())
    throw BadLog(fmt::format("{} beside {}: {}", pose_name, log_name, clock.problem));
  const std::vector<double> rows_s = values_of(log, of_log, "time");
  const double half_s = 0.5 * median_period_s(rows_s);
  // One frame for place and heading: the robot's own, where its log has a heading.
  const bool own_heading = !theta.empty() && of_log.of("vision_theta") == nullptr;
  const Complex turned = own_heading ? Complex(1.0, 0.0) : std::polar(1.0, -clock.frame_rad);
  std::vector<double> distance(rows_s.size(), INFINITY), px(rows_s.size(), kEmpty), py = px, ptheta = px;
  for (std::size_t k = 0; k < seen_s.size(); ++k) {
    const double t = seen_s[k] - clock.offset_s;
    auto it = std::lower_bound(rows_s.begin(), rows_s.end(), t);
    if (it == rows_s.end() || (it != rows_s.begin() && t - *(it - 1) <= *it - t)) --it;
    const auto at = static_cast<std::size_t>(it - rows_s.begin());
    const double off = std::abs(*it - t);
    if (off > half_s || off >= distance[at]) continue;
    distance[at] = off;
    const Complex place = seen[k] * turned;
    if (places) px[at] = place.real(), py[at] = place.imag();
    if (own_heading) ptheta[at] = theta[frame[k]];
  }
  const auto add = [&](const char* signal, const char* unit, std::vector<double> values) {
    const std::string name = std::string("pose_") + signal;
    out.table.series.push_back({name, "", std::move(values), nullptr});
    out.asked.push_back({name, signal, unit});
    out.columns.push_back(name);
  };
  if (places) add("vision_x", "m", std::move(px)), add("vision_y", "m", std::move(py));
  if (own_heading) add("vision_theta", "rad", std::move(ptheta));
  out.clock_sigma_s = clock.sigma_s;
  if (places && !own_heading) out.place_sigma_m = moved_by_frame_m(seen, clock);
  out.note = fmt::format("{} beside {}: its clock is {:.3f} s +- {:.3f} s ahead (correlation {:.2f})",
                         pose_name, log_name, clock.offset_s, clock.sigma_s, clock.correlation);
  if (places)
    out.note += fmt::format(
        "; its frame stands at {:.1f} +- {:.1f} degrees to the robot's heading{}; it goes {:.2f} times the "
        "way "
        "that the wheels say; so a place is known to {:.1f} mm",
        clock.frame_rad * 360.0 / kTurn, clock.frame_sigma_rad * 360.0 / kTurn,
        own_heading ? "" : ", turned back", clock.scale,
        1000.0 * std::hypot(out.place_sigma_m, moved_by_clock_m(seen_s, seen, clock)));
  return out;
}

}  // namespace omnihil
