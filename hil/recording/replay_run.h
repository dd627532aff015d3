// A recording run again with the firmware, models and physics of this program: what `replay` and `check` do.
//
//   const Recording recording = load_recording("drive.omnirec");
//   const ReplayRun again = run_again(recording, {});
//   again.sha256;                                            // of all outputs, every tick
//   first_byte_difference(recording, again.answer);          // none: identical bytes back
//
// The models come out of the recording, no other file is read. The firmware is this program's.
#pragma once
#include <optional>
#include <string>

#include "hil/recording/recording.h"

namespace omnihil {

struct ReplayOptions {
  std::optional<Physics> physics;       // instead of the recorded one
  SessionObserver* observer = nullptr;  // sees the run too; may be null
};

struct ReplayRun {
  Recording answer;  // with as many samples as the recording keeps
  std::string sha256;
  std::string firmware;  // name of the one that ran
  PacketCounts from_host;
  double wall_s = 0.0;
};

// Throws BadRecording, std::invalid_argument (the header's session cannot be built) and
// std::runtime_error (the state stopped being finite).
ReplayRun run_again(const Recording& recording, const ReplayOptions& options);

// The header with the physics that a replay would use.
RecordingHeader replay_header(const RecordingHeader& recorded, const ReplayOptions& options);

}  // namespace omnihil
