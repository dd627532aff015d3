#include "identify/record/held_readings.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "identify/record/statistics.h"

namespace omnihil {
namespace {

constexpr std::size_t kFewest = 20;    // changes: a share of four in five is then known to a tenth; derived
constexpr double kOffStep = 1e-3;      // of the smallest change: decimals of a file; a choice
constexpr double kMostSteps = 2.0;     // of the smallest change, in those of a coarse sensor; a choice
constexpr double kStands = 3.0;        // medians; longer, nothing moves: a choice
constexpr double kRegularShare = 0.8;  // of the intervals; geometric ones reach 0.25 beyond one row: a choice
// Rows; from here on an interval may be off by one, for two clocks side by side.
constexpr double kExact = 4.0;   // a choice
constexpr double kWithin = 0.2;  // of the median: a slow sensor's jitter; a choice

struct Changes {
  std::vector<double> rows, size;  // from one change to the next; by how much
};

void add_changes(const std::vector<double>& x, Changes& out) {
  double last = std::numeric_limits<double>::quiet_NaN();
  std::size_t rows = 0, changes = 0;
  for (const double v : x) {
    if (!std::isfinite(v)) continue;
    ++rows;
    if (v == last) continue;
    if (changes++ > 1) {  // how long the first reading stood there already is not known
      out.rows.push_back(static_cast<double>(rows));
      out.size.push_back(std::abs(v - last));
    }
    last = v;
    rows = 0;
  }
}

// Most of the changes are one or two of the smallest, exactly.
bool is_coarse(const std::vector<double>& changes) {
  const double step = *std::min_element(changes.begin(), changes.end());
  const auto of_steps = [&](double change) {
    const double steps = std::round(change / step);
    return steps <= kMostSteps && std::abs(change / step - steps) <= kOffStep;
  };
  return 2 * std::count_if(changes.begin(), changes.end(), of_steps) >= std::ssize(changes);
}

}  // namespace

bool may_be_held(const SignalRow& row, bool imposed, bool has_halls) {
  if (imposed || (row.name == "velocity" && has_halls)) return false;
  return row.role == SignalRole::kMotion || row.role == SignalRole::kCounts ||
         row.name.starts_with("motor_current");
}

double rows_held(const std::vector<const std::vector<double>*>& runs) {
  Changes all;
  for (const std::vector<double>* run : runs) add_changes(*run, all);
  if (all.rows.size() < kFewest) return 0.0;
  const double middle = median(all.rows);
  if (middle < 2.0 || is_coarse(all.size)) return 0.0;
  const double off = middle < kExact ? 0.0 : std::max(1.0, kWithin * middle);
  double moving = 0.0, regular = 0.0;
  for (const double rows : all.rows) {
    if (rows > kStands * middle) continue;
    moving += 1.0;
    regular += std::abs(rows - middle) <= off ? 1.0 : 0.0;
  }
  return regular >= kRegularShare * moving ? middle : 0.0;
}

void empty_repeats(std::vector<double>& values) {
  double last = std::numeric_limits<double>::quiet_NaN();
  for (double& v : values) {
    if (v == last) {
      v = std::numeric_limits<double>::quiet_NaN();
    } else if (std::isfinite(v)) {
      last = v;
    }
  }
}

}  // namespace omnihil
