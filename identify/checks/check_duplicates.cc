// One thing that stands in the data twice: a load torque that the drive's torque contains already, one column
// under two names.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "identify/checks/check_list.h"

namespace omnihil {
namespace {

using Grade = DataFinding::Grade;

// Where the load torque jumps (by 0.3 of its largest jump or more), does the drive's torque jump by as much:
// slope within 15 % of ±1, 80 % of the jumps' squares explained? All three tuned (check_list.h).
void load_in_torque(const RunView& view, std::vector<DataFinding>& findings) {
  const std::vector<double>* load = view.run->signal("load_torque");
  const std::vector<double>* torque = view.run->signal("motor_torque");
  if (load == nullptr || torque == nullptr) return;
  std::vector<double> load_step, torque_step;
  double largest = 0.0;
  for (std::size_t k = 1; k < load->size(); ++k)
    largest = std::max(largest, std::abs((*load)[k] - (*load)[k - 1]));
  for (std::size_t k = 1; k < load->size(); ++k) {
    const double step = (*load)[k] - (*load)[k - 1];
    if (!(std::abs(step) > 0.3 * largest)) continue;
    load_step.push_back(step);
    torque_step.push_back((*torque)[k] - (*torque)[k - 1]);
  }
  const LineFit line = fit_line({load_step}, torque_step);
  if (line.coefficient.empty() || line.explained < 0.8 ||
      std::abs(std::abs(line.coefficient[0]) - 1.0) > 0.15)
    return;
  findings.push_back(
      {Grade::kFault, "duplicate_force", view.run->file, "load_torque", line.coefficient[0],
       "motor_torque jumps by as much as load_torque wherever that jumps: the load is contained in "
       "it already and would be counted twice"});
}

bool drives_a_wheel(const CheckContext& data, const std::string& signal) {
  return !data.runs.empty() && std::ranges::any_of(data.runs.front().drives, [&](const DriveView& drive) {
    return drive.drive_name == signal;
  });
}

}  // namespace

void check_duplicates(const CheckContext& data, std::vector<DataFinding>& findings) {
  for (const RunView& view : data.runs) load_in_torque(view, findings);
  const std::vector<Channel>& channels = data.dataset.channels;
  std::string alike;
  for (std::size_t i = 0; i < channels.size(); ++i) {
    for (std::size_t j = i + 1; j < channels.size(); ++j) {
      if (channels[i].column != channels[j].column) continue;
      if (drives_a_wheel(data, channels[i].signal) && drives_a_wheel(data, channels[j].signal)) {
        if (alike.empty()) alike = channels[i].column;
        continue;
      }
      findings.push_back({Grade::kDoubt, "same_column", "", channels[j].signal, 0.0,
                          fmt::format("{} and {} are the same column \"{}\": it counts twice",
                                      channels[i].signal, channels[j].signal, channels[i].column)});
    }
  }
  if (alike.empty()) return;
  findings.push_back({Grade::kNote, "driven_alike", "", alike, 0.0,
                      fmt::format("several wheels are driven by one column \"{}\": what only their "
                                  "differences show is not excited",
                                  alike)});
}

}  // namespace omnihil
