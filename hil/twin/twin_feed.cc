#include "hil/twin/twin_feed.h"

#include <algorithm>

#include "hil/acquire/acquired_dataset.h"

namespace omnihil {
namespace {

constexpr double kLag_s = 0.1;    // six packets at 60 Hz; a choice
constexpr double kKept_s = 1.0;   // of the log behind a piece, for headings and held commands; a choice
constexpr double kSame_s = 1e-7;  // two times that are one row: below a nanosecond clock's steps

double seconds(std::int64_t ns) { return 1e-9 * static_cast<double>(ns); }

}  // namespace

Run run_of_rows(const RunRows& rows) {
  Run run;
  for (const double t : rows.time_s) run.time_s.push_back(rows.start_s + t);
  for (std::size_t c = 0; c < rows.columns.size(); ++c) {
    if (const std::string signal = signal_of_column(rows.columns[c]); !signal.empty())
      run.signals[signal] = rows.values[c];
  }
  return run;
}

TwinFeed::TwinFeed(const RadioFormat& format, const TwinFeedOptions& options)
    : format_(format),
      options_(options),
      listener_(format, options.robot_ids, options.team, options.step_ns),
      cutter_(format) {}

void TwinFeed::hear(std::int64_t now_ns) {
  listener_.until(now_ns);
  for (const HeardCommand& heard : listener_.take()) {
    if (heard.robot_id != options_.robot) continue;
    const auto told = told_by_dataset(heard);
    if (told && !drive_) drive_ = told->first;
    if (!told || told->first != *drive_) {
      ++left_out_;
      continue;
    }
    ++commands_;
    log_.sent.push_back(told->second);
    if (!from_s_) from_s_ = seconds(told->second.now_ns);
  }
}

void TwinFeed::host_bytes(std::int64_t now_ns, std::span<const std::uint8_t> bytes) {
  listener_.host_bytes(now_ns, bytes);
  hear(now_ns);
}

void TwinFeed::dongle_bytes(std::int64_t now_ns, std::span<const std::uint8_t> bytes) {
  cutter_.push(bytes);
  while (auto frame = cutter_.next()) {
    if (!frame->understood) continue;
    const auto told = telemetry_of(format_, format_.decode(frame->bytes).values);
    if (!told || (told->robot_id >= 0 && told->robot_id != options_.robot)) continue;
    ++told_;
    log_.told.push_back({now_ns, *told});
  }
}

std::optional<Run> TwinFeed::next(std::int64_t now_ns) {
  hear(now_ns);
  if (!from_s_) return std::nullopt;
  double to_s = *from_s_ + options_.piece_s;
  while (to_s + kLag_s <= seconds(now_ns)) {
    const RunRows rows = rows_between(log_, *drive_, *from_s_ - kSame_s, to_s);
    if (rows.time_s.size() < 2) {  // nothing passed: the piece grows until something does
      to_s += options_.piece_s;
      continue;
    }
    from_s_ = rows.start_s + rows.time_s.back();
    forget(*from_s_ - kKept_s);
    return run_of_rows(rows);
  }
  return std::nullopt;
}

// All but the last command and answer before a time.
void TwinFeed::forget(double before_s) {
  const auto old = [&](auto& list) {
    std::size_t first = 0;
    while (first + 1 < list.size() && seconds(list[first + 1].now_ns) < before_s) ++first;
    list.erase(list.begin(), list.begin() + static_cast<std::ptrdiff_t>(first));
  };
  old(log_.sent);
  old(log_.told);
}

}  // namespace omnihil
