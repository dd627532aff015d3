#include "sim/identify/counted_speed.h"

#include <algorithm>
#include <cmath>

namespace omnihil {
namespace {

constexpr double kLongest_s = 0.2;    // of a window: slower than any loop that lives on it
constexpr double kFewestPeriods = 2;  // shorter, the reading is the difference of two samples
constexpr double kOffStep = 0.02;     // of a step: digits that a file was written with
constexpr int kFewestSteps = 3;       // different readings

// Rounded down to pulses, less itself.
double rounding(double angle_rad, double pulse_rad, double start) {
  const double pulses = angle_rad / pulse_rad + start;
  return (std::floor(pulses) - pulses) * pulse_rad;
}

}  // namespace

// two roundings, each uniform over a pulse
double CountedSpeed::noise_sigma() const { return pulse_rad / window_s * std::sqrt(2.0 / 12.0); }
double CountedSpeed::integrated_sigma_rad() const { return pulse_rad / std::sqrt(12.0); }

CountedSpeed counted_speed(const std::vector<double>& values, double quantum, double period_s,
                           double pulse_rad) {
  if (quantum <= 0.0 || pulse_rad <= 0.0 || period_s <= 0.0) return {};
  double largest = 0.0;
  for (const double v : values) largest = std::isfinite(v) ? std::max(largest, std::abs(v)) : largest;
  const double steps = std::round(largest / quantum);
  if (steps < kFewestSteps - 1) return {};
  const double step = largest / steps;
  for (const double v : values) {
    if (std::isfinite(v) && std::abs(v / step - std::round(v / step)) > kOffStep) return {};
  }
  const double window_s = pulse_rad / step;
  if (window_s < kFewestPeriods * period_s || window_s > kLongest_s) return {};
  return {.window_s = window_s, .pulse_rad = pulse_rad};
}

void add_counting_noise(const CountedSpeed& counted, const std::vector<double>& time_s,
                        std::vector<double>& values, double start) {
  std::vector<double> angle(values.size(), 0.0);
  for (std::size_t k = 1; k < values.size(); ++k) {
    const double speed = std::isfinite(values[k]) ? values[k] : 0.0;
    angle[k] = angle[k - 1] + speed * (time_s[k] - time_s[k - 1]);
  }
  std::size_t j = 0;  // last sample at or before the window's beginning
  for (std::size_t k = 0; k < values.size(); ++k) {
    const double from_s = time_s[k] - counted.window_s;
    while (j + 1 < k && time_s[j + 1] <= from_s) ++j;
    const bool within = from_s > time_s[j] && j + 1 < time_s.size();
    const double part = within ? (from_s - time_s[j]) / (time_s[j + 1] - time_s[j]) : 0.0;
    const double then = within ? angle[j] + part * (angle[j + 1] - angle[j]) : angle[j];
    values[k] += (rounding(angle[k], counted.pulse_rad, start) - rounding(then, counted.pulse_rad, start)) /
                 counted.window_s;
  }
}

}  // namespace omnihil
