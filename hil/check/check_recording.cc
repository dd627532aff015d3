#include "hil/check/check_recording.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "hil/check/console_difference.h"
#include "hil/check/firmware_alone.h"
#include "hil/check/law_difference.h"
#include "hil/check/signal_series.h"
#include "hil/field_view/field_picture.h"
#include "hil/recording/recording_header.h"
#include "hil/recording/replay.h"
#include "hil/recording/replay_report.h"
#include "hil/recording/session_setup.h"

namespace omnihil {
namespace {

constexpr double kFirmwareAlike = 1e-6;   // of duty: single precision of a firmware's own arithmetic
constexpr std::size_t kShownDigits = 12;  // of a SHA-256, enough to tell two builds apart

std::string short_hash(const std::string& sha256) { return sha256.substr(0, kShownDigits); }

std::string file_change(const HashedFile& recorded, const HashedFile& now) {
  if (recorded == now) return {};
  if (recorded.name == now.name) {
    return fmt::format("firmware {}: another build than recorded, {} instead of {}", now.name,
                       short_hash(now.sha256), short_hash(recorded.sha256));
  }
  if (recorded.sha256 == now.sha256 && !now.sha256.empty()) return {};  // the same file by another name
  return fmt::format("firmware {} {} instead of {} {}", now.name, short_hash(now.sha256), recorded.name,
                     short_hash(recorded.sha256));
}

// Values of `other` at the times of `base`, NaN where it has none.
std::vector<double> at_times(const SignalSeries& base, const SignalSeries& other) {
  std::vector<double> values;
  std::size_t k = 0;
  for (const double time_s : base.time_s) {
    while (k < other.time_s.size() && other.time_s[k] < time_s - 1e-9) ++k;
    const bool there = k < other.time_s.size() && other.time_s[k] <= time_s + 1e-9;
    values.push_back(there ? other.value[k] : std::numeric_limits<double>::quiet_NaN());
  }
  return values;
}

LineChart chart_of(const SignalSummary& signal, const Recording& recorded, const Recording& replayed,
                   const RadioFormat& format) {
  const std::string name = signal.largest_column.empty() ? signal.name : signal.largest_column;
  const SignalSeries was = signal_series(recorded, format, name, signal.largest_robot);
  const SignalSeries is = signal_series(replayed, format, name, signal.largest_robot);
  LineChart chart{
      .title = signal.largest_robot < 0 ? name : fmt::format("robot {}: {}", signal.largest_robot, name),
      .x = was.time_s,
      .x_label = "time in s; dashed: the largest difference",
      .panels = {},
      .shade = {},
      .mark = static_cast<double>(signal.largest_ns) / 1e9};
  const std::string unit = signal.unit.empty() ? "1" : signal.unit;
  chart.panels.push_back({unit, {{"recorded", was.value}, {"replayed", at_times(was, is)}}});
  return chart;
}

// Whether it is the firmware that answers otherwise, or what it drives.
void explain(const Recording& recording, const Recording& answer, const ReplayOptions& options,
             CheckOutcome& out) {
  const FirmwareAlone alone = run_firmware_alone(recording, options);
  if (!alone.why_not.empty()) {
    out.drive = first_drive_difference(recording, answer);
    if (out.drive) out.cause.push_back("firmware and robot not told apart: " + alone.why_not);
    return;
  }
  out.drive = first_drive_difference(recording, alone.answer, kFirmwareAlike);
  if (!out.drive) {
    out.cause.push_back(
        "the firmware answers the recorded sensors with the recorded duties: the robot differs");
    return;
  }
  if (session_setup(replay_header(recording.header, options)).model !=
      session_setup(recording.header).model) {
    // A firmware may take wheels, gear and motor from the model: what differs need not be its code.
    out.cause.push_back(
        "the firmware, told of another robot, answers the recorded sensors with other duties");
    return;
  }
  out.cause.push_back("the firmware answers the recorded sensors with other duties");
  for (std::string& line : law_differences(recording, alone.answer)) out.cause.push_back(std::move(line));
}

}  // namespace

std::vector<std::string> session_changes(const RecordingHeader& recorded, const ReplayOptions& options) {
  std::vector<std::string> changes;
  const auto add = [&changes](std::string text) {
    if (!text.empty()) changes.push_back(std::move(text));
  };
  const RecordingHeader now = replay_header(recorded, options);
  const std::size_t common = std::min(recorded.firmware_files.size(), now.firmware_files.size());
  for (std::size_t i = 0; i < common; ++i)
    add(file_change(recorded.firmware_files[i], now.firmware_files[i]));
  for (std::size_t i = common; i < now.firmware_files.size(); ++i)
    add(fmt::format("firmware {}: not what was recorded, '{}'", now.firmware_files[i].name,
                    recorded.firmware));
  if (now.firmware_files.empty() && !recorded.firmware_files.empty())
    add("the reference firmware instead of " + recorded.firmware_files.front().name);
  if (session_setup(now).model != session_setup(recorded).model) {
    add(now.robot_model == recorded.robot_model
            ? fmt::format("robot {}: another text than recorded", now.robot_model)
            : fmt::format("robot {} instead of {}", now.robot_model, recorded.robot_model));
  }
  if (now.plant.physics != recorded.plant.physics)
    add(fmt::format("physics {} instead of {}", to_string(now.plant.physics),
                    to_string(recorded.plant.physics)));
  if (now.seed != recorded.seed) add(fmt::format("seed {} instead of {}", now.seed, recorded.seed));
  return changes;
}

std::vector<SignalSummary> signals_beyond(const RecordingComparison& comparison) {
  std::vector<SignalSummary> signals;
  for (const SignalSummary& signal : comparison.signals) {
    if (signal.beyond > 0) signals.push_back(signal);
  }
  std::ranges::stable_sort(signals, std::greater<>{}, &SignalSummary::over_tolerance);
  return signals;
}

namespace {
void note_console(const Recording& recording, const ConsoleKeeper& console, CheckOutcome& out) {
  const std::int64_t until_ns = out.comparison.first ? out.comparison.first->now_ns : recording.end_ns;
  const std::span<const ConsoleLine> last = last_lines(console.lines(), until_ns);
  out.console.assign(last.begin(), last.end());
  out.console_difference = console_difference(recording, console.lines());
}
}  // namespace

CheckOutcome check_recording(const std::string& file, const Recording& recording, const RadioFormat& format,
                             const CheckOptions& options) {
  CheckOutcome out;
  out.file = file;
  out.tolerance_reason = options.tolerance_reason;
  out.changed = session_changes(recording.header, options.replay);
  std::unique_ptr<FieldTrace> trace;
  ObserverList observers({});
  ReplayOptions replay = options.replay;
  if (options.charts > 0 && recording.header.field.contacts) {
    trace = std::make_unique<FieldTrace>(
        session_config(session_setup(replay_header(recording.header, options.replay))));
    observers.add(trace.get());
    if (replay.observer != nullptr) observers.add(replay.observer);
    replay.observer = &observers;
  }
  const ReplayRun run = run_again(recording, replay);
  if (trace) out.field = field_picture(*trace, {});
  out.recording = recording_line(recording);
  out.replayed = replay_line(recording, run);
  out.simulated_s = static_cast<double>(run.answer.end_ns) / 1e9;
  out.wall_s = run.wall_s;
  out.comparison = compare_recordings(recording, run.answer, format, options.tolerances);
  if (!run.firmware_failure.empty()) {
    out.fault = CheckFault::kFirmware;
    out.fault_text = run.firmware_failure;
  }
  if (out.comparison.agrees() && out.comparison.values() == 0) {
    throw std::invalid_argument(
        "nothing to compare: the recording has neither samples nor bytes of the dongle");
  }
  if (options.console != nullptr && !out.passed()) note_console(recording, *options.console, out);
  if (out.comparison.agrees()) return out;
  explain(recording, run.answer, options.replay, out);
  const std::vector<SignalSummary> beyond = signals_beyond(out.comparison);
  for (std::size_t i = 0; i < std::min(options.charts, beyond.size()); ++i)
    out.charts.push_back(chart_of(beyond[i], recording, run.answer, format));
  return out;
}

}  // namespace omnihil
