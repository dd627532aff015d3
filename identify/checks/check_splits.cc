// The runs held out against those to fit: is it the same kind of motion?
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "identify/checks/check_list.h"

namespace omnihil {
namespace {

struct Range {
  double largest = 0.0;
  std::size_t runs = 0;
};

Range range_of(const CheckContext& data, const std::string& signal, Split split) {
  Range range;
  for (const RunView& view : data.runs) {
    const std::vector<double>* values = view.run->signal(signal);
    if (values == nullptr || view.run->split != split || view.run->steady) continue;
    std::vector<double> sizes;
    for (const double v : *values) sizes.push_back(std::abs(v));
    range.largest = std::max(range.largest, quantile_of(std::move(sizes), 0.98));
    ++range.runs;
  }
  return range;
}

}  // namespace

void check_splits(const CheckContext& data, std::vector<DataFinding>& findings) {
  constexpr double kBeyond = 1.5, kWithin = 0.25;  // held-out range over fitted range (98 % quantiles); tuned
  std::vector<std::string> seen;
  for (const RunView& view : data.runs) {
    for (const DriveView& drive : view.drives) {
      for (const std::string& signal :
           {drive.drive_name, std::string(drive.velocity != nullptr ? "velocity" : "")}) {
        if (signal.empty() || std::find(seen.begin(), seen.end(), signal) != seen.end()) continue;
        seen.push_back(signal);
        const Range fit = range_of(data, signal, Split::kTraining),
                    held = range_of(data, signal, Split::kValidation);
        if (fit.runs == 0 || held.runs == 0 || fit.largest <= 0.0) continue;
        const double ratio = held.largest / fit.largest;
        if (ratio > kBeyond || ratio < kWithin) {
          findings.push_back(
              {DataFinding::Grade::kNote, "holdout_differs", "", signal, ratio,
               fmt::format("{} reaches {:.3g} in the runs held out and {:.3g} in those to fit: the "
                           "holdout is another kind of motion and judges {}",
                           signal, held.largest, fit.largest,
                           ratio > 1.0 ? "beyond what was fitted" : "a small part of what was fitted")});
        }
      }
    }
  }
}

}  // namespace omnihil
