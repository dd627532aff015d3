// Counters that wrap around or are set back: the format asks for cumulative counts.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "identify/checks/check_list.h"

namespace omnihil {

void check_counter(const CheckContext& data, std::vector<DataFinding>& findings) {
  using Grade = DataFinding::Grade;
  // Turns of common encoders and the ranges of 8 to 32 bit counters.
  constexpr double kWraps[] = {256, 1024, 4096, 16384, 32768, 65536, 4294967296.0};  // as above: a choice
  for (const RunView& view : data.runs) {
    for (const DriveView& drive : view.drives) {
      if (drive.position == nullptr || drive.quantum == 0.0) continue;
      std::vector<double> steps;
      for (std::size_t k = 1; k < drive.position->size(); ++k)
        steps.push_back(std::abs((*drive.position)[k] - (*drive.position)[k - 1]) / drive.quantum);
      const double usual = quantile_of(steps, 0.95), largest = largest_size(steps);
      const Channel& channel = *data.dataset.channel(drive.position_name);
      for (const double wrap : {kWraps[0], kWraps[1], kWraps[2], kWraps[3], kWraps[4], kWraps[5], kWraps[6],
                                channel.counts_per_rev}) {
        // A wrap shows as a step of nearly the counter's range, which the counts then never exceed. Nearly:
        // more than 3/4 of it, where usual steps stay below 1/4: neither passes for the other (derived).
        const double range =
            (quantile_of(*drive.position, 1.0) - quantile_of(*drive.position, 0.0)) / drive.quantum;
        const bool wraps = usual < 0.25 * wrap && largest > 0.75 * wrap && largest <= wrap && range <= wrap;
        if (!wraps) continue;
        findings.push_back(
            {Grade::kFault, "counter_wraps", view.run->file, drive.position_name, wrap,
             fmt::format("{} jumps by {:.0f} counts and never leaves a range of {:.0f}: the counter "
                         "wraps around; counts have to be cumulative",
                         drive.position_name, largest, wrap)});
        break;
      }
    }
  }
}

}  // namespace omnihil
