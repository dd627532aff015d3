// The flag `enable`: does the drive follow its input where the flag says it is released?
#include <fmt/format.h>

#include <cmath>

#include "identify/checks/check_list.h"

namespace omnihil {
namespace {

// How well the motion follows the input over the rows where the flag is `state`: 1 exactly, 0 not at all.
struct Following {
  double score = 0.0;
  std::size_t rows = 0;
};

Following following(const DriveView& drive, const std::vector<double>& enable, double state) {
  const bool servo = drive.drive_name == "position_target";
  const std::vector<double>* motion = servo ? drive.position : drive.velocity;
  Following out;
  if (motion == nullptr) return out;
  double uw = 0.0, uu = 0.0, ww = 0.0;
  for (std::size_t k = 1; k < enable.size(); ++k) {
    const double u = (*drive.drive)[k - 1], w = (*motion)[k];
    if (enable[k] != state || !std::isfinite(u) || !std::isfinite(w)) continue;
    ++out.rows;
    uw += u * w, uu += u * u, ww += w * w;
  }
  out.score = uu > 0.0 && ww > 0.0 ? uw / std::sqrt(uu * ww) : 0.0;
  return out;
}

}  // namespace

void check_flags(const CheckContext& data, std::vector<DataFinding>& findings) {
  constexpr std::size_t kLeastRows = 30;            // with each state of the flag; a choice
  constexpr double kFollows = 0.8, kDoesNot = 0.4;  // correlation of motion and input about zero; tuned
  for (const RunView& view : data.runs) {
    const std::vector<double>* enable = view.run->signal("enable");
    if (enable == nullptr || view.run->steady) continue;
    for (const DriveView& drive : view.drives) {
      if (drive.drive == nullptr) continue;
      const Following on = following(drive, *enable, 1.0), off = following(drive, *enable, 0.0);
      const bool released_drives = off.rows > kLeastRows && off.score > kFollows;
      const bool driven_does_not = on.rows < kLeastRows || on.score < kDoesNot;
      if (!released_drives || !driven_does_not) continue;
      findings.push_back(
          {DataFinding::Grade::kFault, "opposite_flag", view.run->file, "enable", off.score,
           fmt::format("the drive follows {} where enable is 0{}: the flag has the opposite meaning "
                       "here (1 is driven)",
                       drive.drive_name, on.rows < kLeastRows ? "" : " and not where it is 1")});
    }
  }
}

}  // namespace omnihil
