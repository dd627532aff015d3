// Position against the integral of the speed: two sensors of one motion must agree.
//
// Over windows, displacement = s * integral of v dt. s far from 1 is a wrong scale (a unit, counts_per_rev, a
// gear ratio); s near 1 with windows that do not fit is a speed that is old, filtered or made up in places.
// What the speed did between two samples nobody knows: the trapezoid of a window is uncertain by as much as half of each
// change of speed, times the period. A displacement that differs by less (a kick between two rows) says nothing of scales.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "identify/checks/check_list.h"

namespace omnihil {
namespace {

using Grade = DataFinding::Grade;

constexpr double kWindow_s = 0.1;    // many samples, so that noise and rounding average out; a choice
constexpr double kScaleSaid = 0.05;  // departure of s from 1; tuned
constexpr double kLeastMoments =
    5.0;  // windows that carry the line, as in check_direction; fewer are chance: a choice
constexpr double kMisfit = 0.25;       // of the range of the windows' displacements; tuned
constexpr double kMisfitShare = 0.02;  // of the windows; tuned

struct Windows {
  std::vector<double> displacement, integral, time_s;
  double apart = 0.0;       // sum over the windows of |displacement - integral|
  double unresolved = 0.0;  // ... of how far the integral may be off for what lies between the samples
};

// Half of each change of speed to the next sample: its integral is the largest error of the trapezoid where the speed
// stays between its samples.
std::vector<double> half_changes(const std::vector<double>& speed) {
  std::vector<double> out(speed.size(), 0.0);
  for (std::size_t k = 0; k + 1 < speed.size(); ++k) out[k] = 0.5 * std::abs(speed[k + 1] - speed[k]);
  return out;
}

Windows windows_of(const RunView& view, const DriveView& drive) {
  DriveView by_position = drive, by_speed = drive;
  by_position.velocity = nullptr;
  by_speed.position = nullptr;
  const std::vector<double> changes = half_changes(*drive.velocity);
  const WindowMeans displacement = window_means(view, by_position, changes, kWindow_s);
  const WindowMeans integral = window_means(view, by_speed, changes, kWindow_s);
  Windows out;
  std::size_t j = 0;
  for (std::size_t i = 0; i < displacement.time_s.size(); ++i) {
    while (j < integral.time_s.size() && integral.time_s[j] < displacement.time_s[i]) ++j;
    if (j == integral.time_s.size() || integral.time_s[j] != displacement.time_s[i]) continue;
    out.displacement.push_back(displacement.speed[i]);
    out.integral.push_back(integral.speed[j]);
    out.time_s.push_back(displacement.time_s[i]);
    out.apart += std::abs(displacement.speed[i] - integral.speed[j]);
    out.unresolved += integral.drive[j];
  }
  return out;
}

// How many windows carry the sum of squares: n of equal size count as n, one that outweighs all others as one.
double moments_of(const std::vector<double>& x) {
  double squares = 0.0, fourths = 0.0;
  for (const double v : x) squares += v * v, fourths += v * v * v * v;
  return fourths > 0.0 ? squares * squares / fourths : 0.0;
}

// What a factor between two measurements of one thing usually is.
std::string usual_cause(double factor, double gear) {
  struct Cause {
    double factor;
    std::string what;
  };
  const double turn = 2.0 * std::numbers::pi;
  const Cause causes[] = {{gear, fmt::format("the gear ratio, {:g}", gear)},
                          {4.0, "counts before and after quadrature"},
                          {2.0, "counts of one edge or of both"},
                          {turn, "turns for radians"},
                          {60.0 / turn, "rpm for rad/s"},
                          {180.0 / std::numbers::pi, "degrees for radians"},
                          {1000.0, "a unit's thousand"}};
  const double size = std::max(factor, 1.0 / factor);
  for (const Cause& cause : causes) {
    const double expected = std::max(cause.factor, 1.0 / std::max(cause.factor, 1e-12));
    if (expected > 1.2 && std::abs(size / expected - 1.0) < 0.03)
      return "; the factor is that of " + cause.what;
  }
  return "";
}

}  // namespace

void check_position_against_speed(const CheckContext& data, std::vector<DataFinding>& findings) {
  const double gear = nominal_value(data.nominal, "gear.ratio").value_or(1.0);
  for (const RunView& view : data.runs) {
    for (const DriveView& drive : view.drives) {
      if (drive.position == nullptr || drive.velocity == nullptr || view.run->steady) continue;
      const Windows w = windows_of(view, drive);
      const LineFit line = fit_line({w.integral}, w.displacement);
      if (line.coefficient.empty() || line.explained < 0.5) continue;
      const double s = line.coefficient[0],
                   highest = quantile_of(w.displacement, 1.0) - quantile_of(w.displacement, 0.0);
      if (s < 0.0) continue;  // said by check_direction
      const bool resolved = w.apart > w.unresolved && moments_of(w.integral) >= kLeastMoments;
      if (resolved && std::abs(s - 1.0) > std::max(kScaleSaid, 5.0 * line.sigma[0])) {
        findings.push_back(
            {std::abs(s - 1.0) > 0.15 ? Grade::kFault : Grade::kDoubt, "position_against_speed",
             view.run->file, drive.position_name, s,
             fmt::format(
                 "{} moves {:.4g} times as far as the integral of velocity: one of the two has a wrong "
                 "scale (unit, counts_per_rev or gear ratio){}",
                 drive.position_name, s, usual_cause(s, gear))});
        continue;
      }
      std::size_t misfits = 0, first = 0;
      for (std::size_t i = 0; i < w.displacement.size(); ++i) {
        if (std::abs(w.displacement[i] - s * w.integral[i]) < kMisfit * highest) continue;
        if (misfits++ == 0) first = i;
      }
      if (misfits == 0 ||
          static_cast<double>(misfits) < kMisfitShare * static_cast<double>(w.displacement.size()))
        continue;
      findings.push_back(
          {Grade::kDoubt, "position_against_speed", view.run->file, "velocity",
           static_cast<double>(misfits) / static_cast<double>(w.displacement.size()),
           fmt::format("velocity does not fit {} in {:.0f} % of the time (first at {:.3f} s): the "
                       "speed reported there is old or made up",
                       drive.position_name,
                       100.0 * static_cast<double>(misfits) / static_cast<double>(w.displacement.size()),
                       w.time_s[first])});
    }
  }
}

}  // namespace omnihil
