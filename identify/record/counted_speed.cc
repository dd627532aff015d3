#include "identify/record/counted_speed.h"

#include <algorithm>
#include <cmath>

namespace omnihil {
namespace {

constexpr double kLongest_s = 0.05;   // of a window: slower than any speed loop that uses it; a choice
constexpr double kFewestPeriods = 2;  // shorter, the reading is the difference of two samples: derived
constexpr double kOffStep = 0.02;     // of a step: rounding; a choice, below the 0.5 of a wrong step
constexpr int kFewestSteps = 3;       // different readings; fewer fit any step: derived

// A window that slides changes its reading by each pulse that comes in and by each that goes out, and by
// nothing else: 2 |omega| T / pulse changes per sample of T where the motion is slow and even, less those
// where both fall into one sample (a quarter, measured on simulated Halls: 0.72 to 0.83 remain). A speed
// differenced from an encoder changes at every sample (1.0 to 2.4 times as often), one rounded to a number
// format wherever its noise or the motion crosses a rounding limit.
bool slides(const std::vector<double>& values, double step, double window_samples) {
  constexpr double kLeast = 0.6,
                   kMost = 0.9;  // of the expected changes: a choice between the measured ranges above
  // Changes per sample: "slow" of the law above; tuned on it.
  constexpr double kSlowest = 0.05, kFastest = 0.6;  // tuned
  constexpr double kUneven = 0.5;    // change of speed over a window, of the speed: "even"; tuned
  constexpr double kFewest = 100.0;  // expected changes: their number is then within 10 % (Poisson), a choice
  const std::size_t n = values.size();
  std::vector<double> sum(n + 1, 0.0), missing(n + 1, 0.0);
  for (std::size_t k = 0; k < n; ++k) {
    const bool known = std::isfinite(values[k]);
    sum[k + 1] = sum[k] + (known ? values[k] : 0.0);
    missing[k + 1] = missing[k] + (known ? 0.0 : 1.0);
  }
  const auto reach = static_cast<std::size_t>(std::lround(1.5 * window_samples));
  double expected = 0.0, changes = 0.0;
  for (std::size_t k = reach + 1; k + reach < n; ++k) {
    if (missing[k + reach] != missing[k - reach - 1]) continue;
    const double before = (sum[k] - sum[k - reach]) / static_cast<double>(reach);
    const double after = (sum[k + reach] - sum[k]) / static_cast<double>(reach);
    const double mean = 0.5 * std::abs(before + after);
    // a step is a pulse over the window
    const double rate = 2.0 * mean / step / window_samples;
    if (rate < kSlowest || rate > kFastest || std::abs(before - after) > kUneven * mean) continue;
    expected += rate;
    if (std::abs(values[k] - values[k - 1]) > 0.5 * step) changes += 1.0;
  }
  return expected >= kFewest && changes >= kLeast * expected && changes <= kMost * expected;
}

// A window that is held: the reading stays for whole windows and changes at multiples of the window alone.
bool is_held(const std::vector<double>& values, double step, double window_samples) {
  constexpr double kOff = 0.02;     // of the changes, off the window's clock: jitter of time stamps; a choice
  constexpr double kFewest = 50.0;  // changes: one of them off is 2 %, which kOff allows: derived
  // Samples, of which ±1 is allowed: shorter, any change would do.
  constexpr double kShortest = 4.0;  // derived
  if (window_samples < kShortest) return false;
  std::size_t last = 0;
  double changes = 0.0, off = 0.0;
  for (std::size_t k = 1; k < values.size(); ++k) {
    if (!(std::abs(values[k] - values[k - 1]) > 0.5 * step)) continue;
    const double windows = static_cast<double>(k - last) / window_samples;
    const double away_samples = std::abs(windows - std::round(windows)) * window_samples;
    // a window that is no whole number of samples ends at one of two
    if (changes > 0.0 && (std::round(windows) < 1.0 || away_samples > 1.0)) off += 1.0;
    changes += 1.0;
    last = k;
  }
  return changes >= kFewest && off <= kOff * changes;
}

// What all values are whole multiples of: the last decimal of a file, in the channel's unit (Euclid's algorithm). 0: nothing
// that is not lost beside the quantum.
double common_unit(const std::vector<double>& values, double quantum) {
  constexpr double kSame = 1e-6,
                   kLost = 1e-3;  // of the quantum: doubles of a text; decimals beyond any step; choices
  double unit = 0.0;
  for (const double v : values) {
    double rest = std::isfinite(v) ? std::abs(v) : 0.0;
    while (rest > kSame * quantum) {
      const double next = unit > 0.0 ? std::fmod(unit, rest) : 0.0;
      unit = rest;
      rest = rest - next < kSame * quantum ? 0.0 : next;
    }
    if (unit > 0.0 && unit < kLost * quantum) return 0.0;
  }
  return unit;
}

// The step whose multiples, rounded to `unit`, all the values are; 0: there is none. `about`: the smallest difference between two
// of them, which two roundings make wrong by a unit. Each value narrows what the step may be, the small ones first.
double step_behind_rounding(const std::vector<double>& values, double about, double unit) {
  constexpr double kCoarse = 4.0;  // units in a step, or too many steps fit; a choice
  if (unit <= 0.0 || about < kCoarse * unit) return 0.0;
  std::vector<double> sizes;
  for (const double v : values) {
    if (std::isfinite(v) && std::abs(v) > 0.5 * about) sizes.push_back(std::abs(v));
  }
  std::ranges::sort(sizes);
  double low = about - unit, high = about + unit;
  for (const double size : sizes) {
    const double steps = std::round(size / (0.5 * (low + high)));
    low = std::max(low, (size - 0.5 * unit) / steps);
    high = std::min(high, (size + 0.5 * unit) / steps);
    if (low > high) return 0.0;
  }
  return 0.5 * (low + high);
}

// The step whose multiples all the values are; 0: there is none.
double step_of(const std::vector<double>& values, double quantum) {
  double largest = 0.0;
  for (const double v : values) largest = std::isfinite(v) ? std::max(largest, std::abs(v)) : largest;
  if (std::round(largest / quantum) < kFewestSteps - 1) return 0.0;
  const double rounded = step_behind_rounding(values, quantum, common_unit(values, quantum));
  if (rounded > 0.0) return rounded;
  const double step = largest / std::round(largest / quantum);
  const auto is_off = [step](double v) {
    return std::isfinite(v) && std::abs(v / step - std::round(v / step)) > kOffStep;
  };
  return std::ranges::any_of(values, is_off) ? 0.0 : step;
}

// Rounding error of an angle counted in whole pulses, in rad: -pulse_rad to 0.
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
  const double step = step_of(values, quantum);
  if (step <= 0.0) return {};
  const double window_s = pulse_rad / step;
  if (window_s < kFewestPeriods * period_s || window_s > kLongest_s) return {};
  const double window_samples = window_s / period_s;
  if (!slides(values, step, window_samples) && !is_held(values, step, window_samples)) return {};
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
