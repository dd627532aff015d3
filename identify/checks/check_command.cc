// What was asked of the drive: beyond its range, at its limit most of the time, or in another unit.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "identify/checks/check_list.h"

namespace omnihil {
namespace {

using Grade = DataFinding::Grade;

void check_duty(const RunView& view, const DriveView& drive, std::vector<DataFinding>& findings) {
  constexpr double kPercent = 2.5;    // duty: nobody asks for this much by mistake; a choice
  constexpr double kSaturated = 0.3;  // of the rows at full duty; tuned
  const std::vector<double>& duty = *drive.drive;
  const double largest = largest_size(duty);
  const auto rows = static_cast<double>(duty.size());
  const auto count = [&](auto&& is) {
    return static_cast<double>(std::count_if(duty.begin(), duty.end(), is)) / rows;
  };
  const double beyond = count([](double d) { return std::abs(d) > 1.0; });
  const double full = count([](double d) { return std::abs(d) >= 0.999; });
  if (largest > kPercent) {
    findings.push_back(
        {Grade::kFault, "wrong_scale", view.run->file, drive.drive_name, largest,
         fmt::format("{} reaches {:g}: it looks like {}; 1 is full duty (use the channel's scale)",
                     drive.drive_name, largest, largest <= 100.0 ? "per cent" : "timer counts")});
  } else if (beyond > 0.0) {
    findings.push_back(
        {Grade::kNote, "over_range_command", view.run->file, drive.drive_name, largest,
         fmt::format("{} asks for more than full duty in {:.1f} % of the rows, up to {:g}: the "
                     "bridge cannot follow there",
                     drive.drive_name, 100.0 * beyond, largest)});
  }
  if (full > kSaturated && largest <= kPercent) {
    findings.push_back(
        {Grade::kDoubt, "saturated_command", view.run->file, drive.drive_name, full,
         fmt::format("{} is at full duty in {:.0f} % of the rows: what the drive does in between is "
                     "hardly seen",
                     drive.drive_name, 100.0 * full)});
  }
}

// An input that is cut off at one value, both ways or one.
void check_clipped(const RunView& view, const DriveView& drive, std::vector<DataFinding>& findings) {
  constexpr double kClipped = 0.2;        // of the rows at the largest value; tuned
  constexpr std::size_t kDifferent = 50;  // values below the limit: else it is a staircase; tuned
  std::vector<double> sizes;
  for (const double v : *drive.drive) {
    if (std::isfinite(v)) sizes.push_back(std::abs(v));
  }
  const double largest = largest_size(sizes);
  if (largest == 0.0) return;
  const auto at_limit = static_cast<double>(
      std::count_if(sizes.begin(), sizes.end(), [&](double v) { return v > 0.9999 * largest; }));
  std::sort(sizes.begin(), sizes.end());
  const auto different = static_cast<std::size_t>(std::unique(sizes.begin(), sizes.end()) - sizes.begin());
  const double share = at_limit / static_cast<double>(drive.drive->size());
  if (share < kClipped || different < kDifferent) return;
  findings.push_back(
      {Grade::kDoubt, "saturated_command", view.run->file, drive.drive_name, share,
       fmt::format("{} is cut off at {:.4g} in {:.0f} % of the rows: was that what the drive got?",
                   drive.drive_name, largest, 100.0 * share)});
}

}  // namespace

void check_command(const CheckContext& data, std::vector<DataFinding>& findings) {
  for (const RunView& view : data.runs) {
    for (const DriveView& drive : view.drives) {
      if (drive.drive == nullptr) continue;
      if (drive.drive_name.starts_with("duty")) {
        check_duty(view, drive, findings);
      } else if (drive.drive_name != "position_target") {
        check_clipped(view, drive, findings);
      }
    }
  }
}

}  // namespace omnihil
