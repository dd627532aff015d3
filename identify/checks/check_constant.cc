// Signals that never change: a cable not plugged in, a column of a wrong name, a drive that was never moved.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

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
  return data.dataset.rig->whole_robot && std::ranges::any_of(data.runs, [&](const RunView& view) {
           const std::vector<double>* values = view.run->signal(name);
           return values != nullptr && !is_constant(*values);
         });
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
      if (moves && moves_elsewhere(data, name)) {
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
      } else if (row.role == SignalRole::kDrive) {
        findings.push_back(
            {Grade::kNote, "constant", run.file, name, value,
             fmt::format("{} is {:g} throughout: the run shows one working point only", name, value)});
      }
    }
  }
}

}  // namespace omnihil
