// Records that hardly move: they determine a bound of static friction and little else.
#include <fmt/format.h>

#include <cmath>

#include "identify/checks/check_list.h"

namespace omnihil {

void check_stall(const CheckContext& data, std::vector<DataFinding>& findings) {
  constexpr double kWindow_s = 0.05;                   // some mechanical time constants; a choice
  constexpr double kDriven = 0.05, kStanding = 0.005;  // of the largest drive, of the highest speed; tuned
  constexpr double kShare = 0.5;                       // of the driven windows: most of them; a choice
  for (const RunView& view : data.runs) {
    if (view.run->steady) continue;
    for (const DriveView& drive : view.drives) {
      const bool moves = drive.position != nullptr || drive.velocity != nullptr;
      if (drive.drive == nullptr || !moves || drive.drive_name == "position_target") continue;
      const WindowMeans w = window_means(view, drive, *drive.drive, kWindow_s);
      const double largest = largest_size(w.drive), highest = largest_size(w.speed);
      // A position that never changes beside a speed that does is a sensor that is not connected, not a drive that stands.
      const bool frozen = highest == 0.0 && drive.velocity != nullptr && largest_size(*drive.velocity) > 0.0;
      if (frozen) continue;
      double driven = 0.0, standing = 0.0;
      for (std::size_t k = 0; k < w.drive.size(); ++k) {
        if (std::abs(w.drive[k]) <= kDriven * largest) continue;
        driven += 1.0;
        standing += std::abs(w.speed[k]) <= kStanding * highest ? 1.0 : 0.0;
      }
      if (driven < 10.0 || standing < kShare * driven) continue;
      findings.push_back(
          {DataFinding::Grade::kDoubt, "near_stall", view.run->file, drive.drive_name, standing / driven,
           fmt::format("the drive stands still in {:.0f} % of the time in which {} asks it to move: "
                       "the record shows a limit of friction and little else",
                       100.0 * standing / driven, drive.drive_name)});
    }
  }
}

}  // namespace omnihil
