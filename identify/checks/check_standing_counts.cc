// Positions that stand still in full motion: counts that were dropped, or rows that repeat an old value.
//
// From one row to the next the position stops, stays exactly the same for at least three rows, and goes on as
// fast as before: a drive cannot brake to nothing and start again within a period. Where it catches up at
// once the rows repeated an old value; where it goes on from where it stood, counts were lost. A drive that turns back
// stands in between, as long as friction and play hold it.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "identify/checks/check_list.h"

namespace omnihil {
namespace {

// All tuned (check_list.h): stick-slip, backlash and coarse encoders of the sound records bring none.
constexpr std::size_t kLeastRows = 3, kMostRows = 100;  // of the same count: longer is a stop; tuned
constexpr std::size_t kLongHold =
    5;  // rows: shorter ones may be a slow drive that sticks for a moment; a choice
constexpr double kLeastCounts =
    4.0;  // per row, before and after: a row without a count is then no rounding; a choice
constexpr double kShareOfHighest = 0.1;  // of the highest speed; tuned
constexpr std::size_t kAround = 3;       // rows looked at on either side; tuned

// Mean of |step| over rows [from, to).
double mean_step(const std::vector<double>& x, std::size_t from, std::size_t to) {
  return std::abs(x[to] - x[from]) / static_cast<double>(to - from);
}

void check_drive(const RunView& view, const DriveView& drive, std::vector<DataFinding>& findings) {
  const std::vector<double>& x = *drive.position;
  std::vector<double> steps;
  for (std::size_t k = 1; k < x.size(); ++k) steps.push_back(std::abs(x[k] - x[k - 1]));
  const double highest = quantile_of(steps, 0.98);
  const double least = std::max(kLeastCounts * drive.quantum, kShareOfHighest * highest);
  if (highest <= 0.0) return;
  std::size_t holds = 0, rows = 0, first = 0, lost = 0;
  for (std::size_t k = kAround; k + kAround + kLeastRows < x.size();) {
    std::size_t end = k;
    while (end + 1 < x.size() && x[end + 1] == x[k]) ++end;
    const std::size_t stood = end - k;
    if (stood >= kLeastRows && stood <= kMostRows && end + kAround < x.size()) {
      const double before = mean_step(x, k - kAround, k), after = mean_step(x, end + 1, end + kAround);
      const bool turns_back = (x[k] - x[k - kAround]) * (x[end + kAround] - x[end + 1]) < 0.0;
      const bool in_motion = !turns_back && std::min(before, after) > least &&
                             std::abs(x[k] - x[k - 1]) > 0.5 * least &&
                             std::max(before, after) < 2.0 * std::min(before, after);
      const double caught_up = std::abs(x[end + 1] - x[end]) / before;
      if (in_motion) {
        if (holds++ == 0) first = k;
        rows += stood;
        lost += caught_up < 0.5 * static_cast<double>(stood + 1) ? 1 : 0;
      }
    }
    k = end + 1;
  }
  if (holds == 0) return;
  const bool dropped = lost >= 3 && 2 * lost > holds && rows > kLongHold * holds;
  findings.push_back(
      {dropped ? DataFinding::Grade::kFault : DataFinding::Grade::kDoubt,
       2 * lost > holds ? "dropped_counts" : "old_values", view.run->file, drive.position_name,
       static_cast<double>(rows),
       fmt::format("{} stands still {} times in full motion, {} rows in all (first at {:.4f} s), and {}",
                   drive.position_name, holds, rows, view.run->time_s[first],
                   2 * lost > holds ? "goes on from there as fast as before: counts were dropped"
                                    : "then catches up: rows repeat an old value")});
}

}  // namespace

void check_standing_counts(const CheckContext& data, std::vector<DataFinding>& findings) {
  for (const RunView& view : data.runs) {
    if (view.run->steady || view.run->time_s.size() < 50) continue;
    for (const DriveView& drive : view.drives) {
      if (drive.position != nullptr && !data.rows_held.contains(drive.position_name))
        check_drive(view, drive, findings);
    }
  }
}

}  // namespace omnihil
