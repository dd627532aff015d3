// What was asked of the drive: beyond its range, at its limit most of the time, in another unit, or faster than the rows.
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

// Half a second at a time: an input of which two rows have less than half of their variance in common changes as fast as
// it is logged. Where the rows come at odd times as well they are not the controller's own ticks, and what the drive was
// asked in between is not known (a chirp beyond the rows' Nyquist frequency, noise made in the firmware).
void check_between_rows(const RunView& view, const DriveView& drive, std::vector<DataFinding>& findings) {
  constexpr double kBlock_s = 0.5;    // a choice
  constexpr double kOddTimes = 0.05;  // 1-sigma jitter over the period; tuned
  constexpr double kLively = 0.05;    // of the liveliest block's variance: quieter ones do not count; tuned
  constexpr double kShare = 0.25;     // of the variance; tuned
  constexpr double kLeastBlocks = 4;  // one step alone is in one; a choice
  constexpr double kLeastChanging = 0.25;    // of a block's rows: one step at its end is as unlike; a choice
  constexpr std::size_t kLeastInBlock = 10;  // a correlation of fewer rows is chance; a choice
  const std::vector<double>&t = view.run->time_s, &u = *drive.drive;
  std::vector<double> off;
  for (std::size_t k = 1; k < t.size(); ++k) off.push_back(std::abs(t[k] - t[k - 1] - view.period_s));
  constexpr double kSigmaOverMad = 1.4826;  // 1 / 0.6745, of a normal: derived
  const double jitter = view.period_s > 0.0 ? kSigmaOverMad * median_of(off) / view.period_s : 0.0;
  if (jitter < kOddTimes) return;
  struct Block {
    double variance, unlike, changing;
  };
  std::vector<Block> blocks;
  double liveliest = 0.0;
  for (std::size_t from = 0, to = 0; from < t.size(); from = to) {
    double sum = 0.0, squares = 0.0, changes = 0.0, changing = 0.0;
    for (to = from; to < t.size() && t[to] - t[from] < kBlock_s; ++to) {
      sum += u[to];
      squares += u[to] * u[to];
      if (to > from) changes += (u[to] - u[to - 1]) * (u[to] - u[to - 1]);
      if (to > from && u[to] != u[to - 1]) changing += 1.0;
    }
    const auto n = static_cast<double>(to - from);
    if (to - from < kLeastInBlock || !std::isfinite(squares)) continue;
    const double variance = squares / n - sum / n * (sum / n);
    liveliest = std::max(liveliest, variance);
    // half the mean squared change: variance less covariance
    blocks.push_back({variance, changes / n / 2.0, changing / n});
  }
  double lively = 0.0, fast = 0.0, count = 0.0;
  for (const Block& b : blocks) {
    if (!(b.variance > kLively * liveliest)) continue;
    count += 1.0;
    lively += b.variance;
    if (b.unlike > 0.5 * b.variance && b.changing >= kLeastChanging) fast += b.variance;
  }
  if (count < kLeastBlocks || fast < kShare * lively) return;
  findings.push_back({Grade::kDoubt, "fast_command", view.run->file, drive.drive_name, fast / lively,
                      fmt::format("{} changes from row to row as much as it ever does in {:.0f} % of its "
                                  "motion, and the rows come at odd "
                                  "times ({:.2g} ms of {:.3g} ms, 1 sigma): what the drive was asked between "
                                  "them is not known; leave "
                                  "that part out, or log at the controller's ticks",
                                  drive.drive_name, 100.0 * fast / lively, 1e3 * jitter * view.period_s,
                                  1e3 * view.period_s)});
}

}  // namespace

void check_command(const CheckContext& data, std::vector<DataFinding>& findings) {
  for (const RunView& view : data.runs) {
    for (const DriveView& drive : view.drives) {
      if (drive.drive == nullptr) continue;
      if (!view.run->steady && drive.drive_name != "position_target")
        check_between_rows(view, drive, findings);
      if (drive.drive_name.starts_with("duty")) {
        check_duty(view, drive, findings);
      } else if (drive.drive_name != "position_target") {
        check_clipped(view, drive, findings);
      }
    }
  }
}

}  // namespace omnihil
