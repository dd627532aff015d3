// Signals that never change: a cable not plugged in, a column of a wrong name, a drive that was never moved.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "identify/checks/check_list.h"
#include "identify/record/rig.h"
#include "identify/record/signal_list.h"

namespace omnihil {
namespace {

bool is_constant(const std::vector<double>& values) {
  const auto first = std::find_if(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
  return std::all_of(first, values.end(), [&](double v) { return !std::isfinite(v) || v == *first; });
}

// One straight drive of a robot leaves a wheel, a coordinate or the heading as they are; that its sensor works another
// run shows.
bool moves_elsewhere(const CheckContext& data, const std::string& name) {
  return std::ranges::any_of(data.runs, [&](const RunView& view) {
    const std::vector<double>* values = view.run->signal(name);
    return values != nullptr && !is_constant(*values);
  });
}

// Of an axis: is the drive asked for so little, beside what it is in other runs, that it may stand below its breakaway?
bool may_stand(const CheckContext& data, const RunView& view) {
  constexpr double kOfLargest = 0.3;  // of the largest command: half more than bad gears need; a choice
  const auto asked = [](const RunView& of) {
    double most = 0.0;
    for (const DriveView& drive : of.drives) {
      if (drive.drive == nullptr) return std::numeric_limits<double>::infinity();
      most = std::max(most, largest_size(*drive.drive));
    }
    return most;
  };
  double most = 0.0;
  for (const RunView& other : data.runs) most = std::max(most, asked(other));
  return !data.dataset.rig->whole_robot && std::isfinite(most) && asked(view) <= kOfLargest * most;
}

// Does the run pass through speeds, though it asks for one thing all the time? A drive that runs down shows them all.
bool passes_through_speeds(const Run& run) {
  constexpr double kOfTop = 0.5;  // of the top speed, between the 5 and 95 % quantiles; a choice
  const std::vector<double>* speed = run.signal("velocity");
  if (speed == nullptr) return false;
  const double low = quantile_of(*speed, 0.05), high = quantile_of(*speed, 0.95);
  return high - low > kOfTop * std::max(std::abs(low), std::abs(high));
}

}  // namespace

void check_constant(const CheckContext& data, std::vector<DataFinding>& findings) {
  using Grade = DataFinding::Grade;
  for (const RunView& view : data.runs) {
    const Run& run = *view.run;
    if (run.steady || run.time_s.size() < 20) continue;
    for (const auto& [name, values] : run.signals) {
      const SignalRow& row = *find_signal(*data.dataset.rig, name);
      if (!is_constant(values)) continue;
      const double value =
          *std::find_if(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
      const bool moves = (row.role == SignalRole::kMotion || row.role == SignalRole::kCounts) &&
                         !data.dataset.channel(name)->imposed;
      const bool elsewhere = moves && moves_elsewhere(data, name);
      if (elsewhere && may_stand(data, view)) {
        findings.push_back(
            {Grade::kDoubt, "constant", run.file, name, value,
             fmt::format("{} is {:g} throughout: below the drive's breakaway, or its sensor was "
                         "not connected; in other runs it moves",
                         name, value)});
      } else if (elsewhere && data.dataset.rig->whole_robot) {
        const bool of_wheel = name.starts_with("encoder") || name.starts_with("wheel_speed");
        findings.push_back({of_wheel ? Grade::kDoubt : Grade::kNote, "constant", run.file, name, value,
                            fmt::format("{} is {:g} throughout, and moves in other runs", name, value)});
      } else if (moves) {
        findings.push_back(
            {Grade::kFault, "constant", run.file, name, value,
             fmt::format("{} is {:g} throughout: nothing moved, or its sensor was not connected", name,
                         value)});
      } else if (name.starts_with("motor_current") || name == "load_torque" || name.starts_with("accel")) {
        findings.push_back({Grade::kDoubt, "constant", run.file, name, value,
                            fmt::format("{} is {:g} throughout: was its sensor connected?", name, value)});
      } else if (row.role == SignalRole::kDrive && !passes_through_speeds(run)) {
        findings.push_back(
            {Grade::kNote, "constant", run.file, name, value,
             fmt::format("{} is {:g} throughout: the run shows one working point only", name, value)});
      }
    }
  }
}

}  // namespace omnihil
