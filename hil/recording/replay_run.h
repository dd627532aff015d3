// A recording run again by this program: what `replay` and `check` do.
//
//   const Recording recording = load_recording("drive.omnirec");
//   const ReplayRun again = run_again(recording, {});        // its models, its physics, the reference firmware
//   again.sha256;                                            // of all outputs, every tick
//   first_byte_difference(recording, again.answer);          // none: identical bytes back
//
// The models come out of the recording unless another one is given; no other file is read here.
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "hil/loop/model_store.h"
#include "hil/recording/recording.h"

namespace omnihil {

// What takes the place of what was recorded.
struct ReplayOptions {
  std::optional<Physics> physics{};
  std::optional<ModelBundle> model{};   // of every robot
  std::optional<std::uint64_t> seed{};  // of everything random
  // The user's own firmware (hil/firmware/open_firmware.h); empty: the reference firmware.
  std::function<Session::FirmwareMaker(const SessionConfig&)> firmware{};
  std::function<Session::FirmwareMaker(const SessionConfig&)> opponents_firmware{};  // empty: the same
  std::vector<HashedFile> firmware_files{};                                          // what they come from
  SessionObserver* observer = nullptr;  // sees the run too; may be null
};

struct ReplayRun {
  Recording answer;  // with as many samples as the recording keeps
  std::string sha256;
  std::string firmware;  // name of the one that ran
  std::string
      firmware_failure;  // it crashed or hung, with its robot: its wheels coast from there on; empty: no
  PacketCounts from_host;
  double wall_s = 0.0;
};

// Throws BadRecording, std::invalid_argument (the header's session cannot be built) and
// std::runtime_error (the state stopped being finite).
ReplayRun run_again(const Recording& recording, const ReplayOptions& options);

// The header with what a replay would use instead of the recorded.
RecordingHeader replay_header(const RecordingHeader& recorded, const ReplayOptions& options);

// True when model, physics, seed and firmware files are those of the recording.
bool same_session(const RecordingHeader& recorded, const ReplayOptions& options);

// Why a replay with these options would run another kind of firmware than was recorded, and what to name;
// empty: it does not. A recording of a user's own firmware has its files' hashes.
std::string firmware_missing(const RecordingHeader& recorded, const ReplayOptions& options);

}  // namespace omnihil
