#include "hil/recording/replay_report.h"

#include <fmt/format.h>

#include "hil/recording/recording_header.h"

namespace omnihil {
namespace {

double seconds(std::int64_t ns) { return static_cast<double>(ns) / 1e9; }

}  // namespace

std::string recording_line(const Recording& recording) {
  const RecordingHeader& header = recording.header;
  std::string text =
      fmt::format("{} robot{} {}, {}, {}, {:.3f} s, recorded by commit {}", header.robot_ids.size(),
                  header.robot_ids.size() == 1 ? "" : "s", header.robot_model, header.radio_format,
                  to_string(header.plant.physics), seconds(recording.end_ns), header.commit);
  if (!recording.complete) text += "; the run was cut off";
  if (recording.last_line_cut) text += ", its last line is incomplete and was left out";
  return text;
}

std::string replay_line(const Recording& recording, const ReplayRun& run) {
  const double simulated_s = seconds(run.answer.end_ns);
  std::string text =
      fmt::format("{:.3f} s in {:.2f} s, {:.1f} times real time; {} host packets good, {} refused",
                  simulated_s, run.wall_s, run.wall_s > 0.0 ? simulated_s / run.wall_s : 0.0,
                  run.from_host.good, run.from_host.refused());
  if (run.answer.header.plant.physics != recording.header.plant.physics) {
    text += fmt::format("; physics {} instead of {}", to_string(run.answer.header.plant.physics),
                        to_string(recording.header.plant.physics));
  }
  if (run.firmware != recording.header.firmware) {
    text += fmt::format("; firmware '{}' instead of '{}'", run.firmware, recording.header.firmware);
  }
  return text;
}

std::string comparison_table(const RecordingComparison& comparison) {
  std::string text = fmt::format("{:<36} {:>9} {:>13} {:>10} {:<6} {}\n", "signal", "values", "largest diff",
                                 "tolerance", "unit", "where");
  for (const SignalSummary& signal : comparison.signals) {
    std::string where;
    if (signal.largest > 0.0) {
      where = fmt::format("{:.3f} s", seconds(signal.largest_ns));
      if (signal.largest_robot >= 0) where += fmt::format(", robot {}", signal.largest_robot);
    }
    if (signal.beyond > 0) where += fmt::format(", {} beyond", signal.beyond);
    text += fmt::format("{:<36} {:>9} {:>13.3g} {:>10.3g} {:<6} {}\n", signal.name, signal.values,
                        signal.largest, signal.tolerance, signal.unit, where);
  }
  return text;
}

}  // namespace omnihil
