// One recording run again and compared: the outcome that the verdict, JUnit, JSON and the page are made of.
//
//   CheckOutcome outcome = check_recording("drive.omnirec", recording, format, {.replay = {}, .tolerances = {}});
//   outcome.passed();                              // everything within its tolerance
//   outcome.drive;                                 // what the firmware first did otherwise
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "hil/check/drive_difference.h"
#include "hil/loop/console_line.h"
#include "hil/recording/compare_recordings.h"
#include "hil/recording/replay_run.h"
#include "hil/text/line_chart.h"

namespace omnihil {

struct CheckOptions {
  ReplayOptions replay;
  Tolerances tolerances;
  std::string tolerance_reason;            // "exact, as asked"
  std::size_t charts = 0;                  // of the signals that differ most, at most so many
  const ConsoleKeeper* console = nullptr;  // hears the replay's boards; null: nobody does
};

// Why there is no verdict.
enum class CheckFault : std::uint8_t { kNone, kBadInput, kIo, kDiverged, kFirmware };

struct CheckOutcome {
  std::string file;  // as the user named it
  CheckFault fault = CheckFault::kNone;
  std::string fault_text;
  std::string recording, replayed;  // a line each: recording_line(), replay_line()
  std::string tolerance_reason;
  std::vector<std::string> changed;  // "firmware libfw.so: another build than recorded", …
  RecordingComparison comparison;
  std::optional<DriveDifference> drive;  // where it can be had, with the recorded sensors fed in
  std::vector<std::string> cause;        // whether firmware or robot differs, and in what, a line each
  std::string explained;                 // of the model, where it was asked for (explain_difference.h)
  std::vector<LineChart> charts;
  std::string
      field;  // SVG of the field from above, of the new run; where charts are asked for and there is one
  // Of one that differs or failed: the last that its boards said until then, and the first line that was recorded otherwise.
  std::vector<ConsoleLine> console;
  std::string console_difference;
  double simulated_s = 0.0, wall_s = 0.0;

  bool passed() const { return fault == CheckFault::kNone && comparison.agrees(); }
};

// Throws as run_again does, and std::invalid_argument when the recording has nothing to compare.
CheckOutcome check_recording(const std::string& file, const Recording& recording, const RadioFormat& format,
                             const CheckOptions& options);

// What is not as recorded, a line each: files of the firmware, model, physics, seed.
std::vector<std::string> session_changes(const RecordingHeader& recorded, const ReplayOptions& options);

// Signals beyond their tolerance, the one furthest beyond first.
std::vector<SignalSummary> signals_beyond(const RecordingComparison& comparison);

}  // namespace omnihil
