// Samples that jump away and back, as no inertia can.
//
// A sample's distance from the middle of its neighbours is half the second difference: acceleration * T^2
// / 2. To pass for a glitch it must exceed what a drive that went from standstill to its highest sustained
// speed within one period would show, and stand far out of the record's own second differences.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "identify/checks/check_list.h"
#include "identify/record/signal_list.h"
#include "identify/record/statistics.h"

namespace omnihil {
namespace {

// All tuned (check_list.h): no smooth or quantised motion of the sound records passes for a glitch.
constexpr double kOutstanding = 12.0;  // robust sigmas of the second difference; tuned
constexpr double kQuanta =
    4.0;  // of a counter: its rounding alone makes second differences of up to two; twice that, a choice
constexpr std::size_t kSustained = 4;  // samples before and after that a speed must last; tuned
constexpr double kFarBeyond = 2.5;     // times the bound: less may be a late time stamp; tuned
constexpr double kShareFault = 5e-4;   // of the rows; tuned

struct Samples {
  std::vector<double> t, x;
};

Samples known_samples(const Run& run, const std::vector<double>& values, bool is_angle) {
  Samples out;
  double turns = 0.0;
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (!std::isfinite(values[k])) continue;
    double v = values[k] + turns;
    if (is_angle && !out.x.empty()) {  // an angle that wraps is no jump
      const double step = std::remainder(v - out.x.back(), 2.0 * std::numbers::pi) - (v - out.x.back());
      turns += step;
      v += step;
    }
    out.t.push_back(run.time_s[k]);
    out.x.push_back(v);
  }
  return out;
}

// Highest |x'| that lasts: of the medians over nine samples.
double sustained_speed(const Samples& s) {
  double highest = 0.0;
  std::vector<double> near;
  for (std::size_t k = kSustained; k + kSustained + 1 < s.x.size(); ++k) {
    near.clear();
    for (std::size_t i = k - kSustained; i <= k + kSustained; ++i)
      near.push_back(std::abs((s.x[i + 1] - s.x[i]) / (s.t[i + 1] - s.t[i])));
    highest = std::max(highest, median_in_place(near));  // of 2 kSustained + 1 sizes
  }
  return highest;
}

void check_signal(const RunView& view, const std::string& name, const std::vector<double>& values,
                  double quantum, std::vector<DataFinding>& findings) {
  const Samples s = known_samples(*view.run, values, name == "vision_theta");
  if (s.x.size() < 50) return;
  std::vector<double> second(s.x.size(), 0.0);
  std::vector<double> sizes;
  for (std::size_t k = 1; k + 1 < s.x.size(); ++k) {
    const double share = (s.t[k] - s.t[k - 1]) / (s.t[k + 1] - s.t[k - 1]);
    second[k] = s.x[k] - (s.x[k - 1] + share * (s.x[k + 1] - s.x[k - 1]));
    sizes.push_back(std::abs(second[k]));
  }
  const double robust = kSigmaPerMad * median_of(sizes), highest = sustained_speed(s);
  std::size_t count = 0, first = 0;
  double largest = 0.0;
  bool far = false;
  for (std::size_t k = 1; k + 1 < s.x.size(); ++k) {
    const double period = std::max(s.t[k] - s.t[k - 1], s.t[k + 1] - s.t[k]);
    const double bound = std::max({kOutstanding * robust, kQuanta * quantum, highest * period});
    if (std::abs(second[k]) <= bound) continue;
    // a single spike makes second differences of minus half its size at its neighbours
    if (std::abs(second[k - 1]) > std::abs(second[k]) || std::abs(second[k + 1]) > std::abs(second[k]))
      continue;
    if (count++ == 0) first = k;
    largest = std::max(largest, std::abs(second[k]));
    far = far || std::abs(second[k]) > kFarBeyond * bound;
  }
  if (count == 0) return;
  const bool many =
      far && count >= 3 && static_cast<double>(count) > kShareFault * static_cast<double>(s.x.size());
  findings.push_back(
      {many ? DataFinding::Grade::kFault : DataFinding::Grade::kDoubt, "glitch", view.run->file, name,
       largest,
       fmt::format("{} has {} glitch{}: it jumps by up to {:.4g} as no inertia can (first at {:.4f} "
                   "s): faults of the sensor or of its transfer",
                   name, count, count == 1 ? "" : "es", largest, s.t[first])});
}

// The highest speed that anything in the record speaks for: one that lasts, in any run, or what the highest voltage asked
// gives without load. 0: nothing does.
double highest_speed(const CheckContext& data) {
  double highest = 0.0, voltage_V = 0.0;
  for (const RunView& view : data.runs) {
    for (const DriveView& drive : view.drives) {
      if (drive.velocity == nullptr || view.run->steady) continue;
      const Samples s = known_samples(*view.run, *drive.velocity, false);
      std::vector<double> near;
      for (std::size_t k = kSustained; k + kSustained < s.x.size(); ++k) {
        near.clear();
        for (std::size_t i = k - kSustained; i <= k + kSustained; ++i) near.push_back(std::abs(s.x[i]));
        highest = std::max(highest, median_in_place(near));
      }
      for (const double v : asked_voltage(data, view, drive)) voltage_V = std::max(voltage_V, std::abs(v));
    }
  }
  const double k = nominal_value(data.nominal, "motor.torque_constant_Nm_per_A").value_or(0.0);
  const double gear = nominal_value(data.nominal, "gear.ratio").value_or(1.0);
  return k > 0.0 ? std::max(highest, voltage_V / k / gear) : highest;
}

// A speed that stands alone: far above any that lasts, and gone in the rows before and after it.
void check_speed(const RunView& view, const std::vector<double>& values, double highest,
                 std::vector<DataFinding>& findings) {
  const Samples s = known_samples(*view.run, values, false);
  if (s.x.size() < 50 || !(highest > 0.0)) return;
  std::size_t count = 0, first = 0;
  double largest = 0.0, of_glitches = 0.0, of_all = 0.0;
  for (std::size_t k = 0; k < s.x.size(); ++k) {
    of_all += s.x[k] * s.x[k];
    const double before = k > 0 ? std::abs(s.x[k - 1]) : 0.0;
    const double after = k + 1 < s.x.size() ? std::abs(s.x[k + 1]) : 0.0;
    if (std::abs(s.x[k]) <= kFarBeyond * std::max({highest, before, after})) continue;
    if (count++ == 0) first = k;
    of_glitches += s.x[k] * s.x[k];
    if (std::abs(s.x[k]) > std::abs(largest)) largest = s.x[k];
  }
  if (count == 0) return;
  const bool outweighs = of_glitches > 0.5 * of_all;  // any error of the run is then theirs
  findings.push_back(
      {outweighs ? DataFinding::Grade::kFault : DataFinding::Grade::kDoubt, "glitch", view.run->file,
       "velocity", largest,
       fmt::format("velocity reads {:.4g} in {} row{} (first at {:.4f} s), {:.3g} times what it ever "
                   "reaches for longer: a counter that overflowed, or a fault of the transfer{}",
                   largest, count, count == 1 ? "" : "s", s.t[first], std::abs(largest) / highest,
                   outweighs ? "; it outweighs all other rows: empty the cell" : "")});
}

}  // namespace

void check_glitches(const CheckContext& data, std::vector<DataFinding>& findings) {
  const double highest = highest_speed(data);
  for (const RunView& view : data.runs) {
    if (view.run->steady) continue;
    for (const DriveView& drive : view.drives) {
      if (drive.position != nullptr && !data.rows_held.contains(drive.position_name))
        check_signal(view, drive.position_name, *drive.position, drive.quantum, findings);
      if (drive.velocity != nullptr) check_speed(view, *drive.velocity, highest, findings);
    }
    for (const char* name : {"vision_x", "vision_y", "vision_theta"}) {
      if (const auto* values = view.run->signal(name)) check_signal(view, name, *values, 0.0, findings);
    }
  }
}

}  // namespace omnihil
