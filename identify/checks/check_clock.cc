// Time stamps: gaps, jitter, and rows that were stamped late.
//
// A row stamped late shows as a long interval followed by short ones until the clock has caught up; a missing
// sample as a long interval alone.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "identify/checks/check_list.h"
#include "identify/record/statistics.h"

namespace omnihil {
namespace {

using Grade = DataFinding::Grade;

// A gap is nearer to two periods than to one (derived); a bunched row comes well before its time (tuned).
constexpr double kLong = 1.5, kShort = 0.6;  // of the median period; tuned
constexpr double kLateShare = 0.005;         // of the rows; tuned
constexpr double kCaughtUp = 0.5;            // of the time lost is regained by the rows after; tuned
constexpr double kJitterSaid = 0.05;         // of the period, robust 1-sigma; tuned
constexpr double kGapShareDoubtful = 0.02;   // of the duration; tuned

struct ClockShape {
  std::size_t gaps = 0, bunched = 0;
  double longest_s = 0.0, missing_s = 0.0, late_s = 0.0, regained_s = 0.0;
  double jitter = 0.0;  // over the median period
};

// Instants that belong together: of one sensor's rows, or of several that come in the same ones.
struct Clock {
  std::string name;  // of its first signal; "time": of all rows
  std::vector<double> time_s;
  double period_s = 0.0;  // median
};

// A record whose rows are of several clocks (telemetry and camera, each in its own rows) is looked at clock by clock; one
// with a signal in nearly every row has the rows' clock.
constexpr double kEveryRow = 0.95;  // of the rows; a choice
std::vector<Clock> clocks_of(const RunView& view) {
  const Run& run = *view.run;
  const auto rows = static_cast<double>(run.time_s.size());
  std::vector<Clock> clocks;
  for (const auto& [name, values] : run.signals) {
    // What is asked comes when the host asks, or stands in every row: no sensor's clock.
    if (name.starts_with("command_") || name == "dribbler") continue;
    Clock clock{name, {}, 0.0};
    for (std::size_t k = 0; k < values.size(); ++k) {
      if (std::isfinite(values[k])) clock.time_s.push_back(run.time_s[k]);
    }
    if (static_cast<double>(clock.time_s.size()) > kEveryRow * rows)
      return {{"time", run.time_s, view.period_s}};
    const bool known =
        std::any_of(clocks.begin(), clocks.end(), [&](const Clock& c) { return c.time_s == clock.time_s; });
    if (known || clock.time_s.size() < 20) continue;
    clock.period_s = median_period_s(clock.time_s);
    clocks.push_back(std::move(clock));
  }
  if (clocks.size() < 2) return {{"time", run.time_s, view.period_s}};
  return clocks;
}

ClockShape shape_of(const Clock& view) {
  ClockShape s;
  const std::vector<double>& t = view.time_s;
  std::vector<double> off;
  for (std::size_t k = 1; k < t.size(); ++k) {
    const double dt = t[k] - t[k - 1], extra = dt - view.period_s;
    if (dt > kLong * view.period_s) {
      ++s.gaps;
      s.longest_s = std::max(s.longest_s, dt);
      s.missing_s += extra;
      s.late_s = std::max(s.late_s, extra);
    } else {
      off.push_back(std::abs(extra));
      s.bunched += dt < kShort * view.period_s ? 1 : 0;
    }
    if (extra < 0.0) s.regained_s -= extra;
  }
  s.jitter = kSigmaPerMad * median_of(std::move(off)) / view.period_s;
  return s;
}

void check_one(const Run& run, const Clock& clock, std::vector<DataFinding>& findings) {
  const double duration_s = clock.time_s.back() - clock.time_s.front();
  const ClockShape s = shape_of(clock);
  const auto rows = static_cast<double>(clock.time_s.size());
  const bool late = static_cast<double>(s.bunched) > kLateShare * rows &&
                    s.regained_s > kCaughtUp * s.missing_s && s.gaps > 0;
  if (late) {
    const double share = static_cast<double>(s.bunched) / rows;
    findings.push_back(
        {share > 0.02 && s.late_s > 3.0 * clock.period_s ? Grade::kFault : Grade::kDoubt, "late_timestamps",
         run.file, clock.name, s.late_s,
         fmt::format("rows are stamped late, by up to {:.3g} ms, and those after them bunch up ({} intervals "
                     "shorter than {:.0f} % of the period of {:.4g} ms): the time stamps are those of a busy "
                     "host's clock, not of the measurement",
                     1e3 * s.late_s, s.bunched, 100.0 * kShort, 1e3 * clock.period_s)});
  } else if (s.gaps > 0) {
    const bool much = s.missing_s > kGapShareDoubtful * duration_s;
    findings.push_back({much ? Grade::kDoubt : Grade::kNote, "gaps", run.file, clock.name, s.longest_s,
                        fmt::format("{} gaps in time, the longest {:.3g} s, {:.1f} % of the record missing",
                                    s.gaps, s.longest_s, 100.0 * s.missing_s / duration_s)});
  }
  if (s.jitter > kJitterSaid && !late) {
    findings.push_back({Grade::kNote, "clock_jitter", run.file, clock.name, s.jitter * clock.period_s,
                        fmt::format("the clock jitters: intervals differ by {:.2g} ms (1 sigma) from their "
                                    "median of {:.4g} ms",
                                    1e3 * s.jitter * clock.period_s, 1e3 * clock.period_s)});
  }
}

}  // namespace

void check_clock(const CheckContext& data, std::vector<DataFinding>& findings) {
  for (const RunView& view : data.runs) {
    if (view.run->steady || view.run->time_s.size() < 20) continue;
    for (const Clock& clock : clocks_of(view)) check_one(*view.run, clock, findings);
  }
}

}  // namespace omnihil
