#include "hil/recording/replay_run.h"

#include <fmt/format.h>

#include <chrono>

#include "hil/loop/reference_firmware.h"
#include "hil/recording/recording_memory.h"
#include "hil/recording/replay.h"
#include "hil/recording/replay_hash.h"
#include "hil/recording/session_setup.h"

namespace omnihil {

namespace {

// "robot 3: crashed (SIGSEGV) …" of the first robot whose firmware answers no more.
std::string failure_of(const Session& session) {
  for (int i = 0; i < session.robot_count(); ++i) {
    const std::string_view failure = session.firmware(i).failure();
    if (!failure.empty()) return fmt::format("robot {}: firmware {}", session.robot_key(i), failure);
  }
  return {};
}

Session::FirmwareMaker opponents_maker(const SessionConfig& config, const ReplayOptions& options) {
  if (config.opponents.robots.empty()) return {};
  const SessionConfig alone = opponents_alone(config);
  if (options.opponents_firmware) return options.opponents_firmware(alone);
  return options.firmware ? options.firmware(alone) : reference_firmware_for(alone);
}

std::string names_of(const std::vector<HashedFile>& files) {
  std::string text;
  for (const HashedFile& file : files) text += (text.empty() ? "" : ", ") + file.name;
  return text;
}

}  // namespace

RecordingHeader replay_header(const RecordingHeader& recorded, const ReplayOptions& options) {
  RecordingHeader header = recorded;
  if (options.physics) header.plant.physics = *options.physics;
  if (options.seed) header.seed = header.plant.seed = *options.seed;
  if (options.model) set_model(header, *options.model);
  header.firmware_files = options.firmware_files;
  return header;
}

bool same_session(const RecordingHeader& recorded, const ReplayOptions& options) {
  RecordingHeader header = replay_header(recorded, options);
  const SessionSetup now = session_setup(header), before = session_setup(recorded);
  return now.model == before.model && now.others == before.others &&
         header.plant.physics == recorded.plant.physics && header.seed == recorded.seed &&
         header.firmware_files == recorded.firmware_files;
}

std::string firmware_missing(const RecordingHeader& recorded, const ReplayOptions& options) {
  if (recorded.firmware_files.empty() || options.firmware) return {};
  return fmt::format(
      "recorded with a firmware of its own, '{}' from {}: name it with --firmware, or the reference firmware "
      "with --firmware reference",
      recorded.firmware, names_of(recorded.firmware_files));
}

ReplayRun run_again(const Recording& recording, const ReplayOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  const RecordingHeader header = replay_header(recording.header, options);
  const SessionConfig config = session_config(session_setup(header));
  Session session(config, options.firmware ? options.firmware(config) : reference_firmware_for(config),
                  opponents_maker(config, options));
  RecordingMemory memory(header);
  OutputHash hash;
  std::vector<SessionObserver*> observers{&memory, &hash};
  if (options.observer != nullptr) observers.push_back(options.observer);
  ObserverList all(std::move(observers));
  replay(recording, session, &all);
  ReplayRun run;
  run.answer = memory.take(session.now_ns());
  run.sha256 = hash.hex();
  run.firmware = session.firmware(0).name();
  run.answer.header.firmware = run.firmware;
  run.firmware_failure = failure_of(session);
  run.from_host = session.link().from_host();
  run.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return run;
}

}  // namespace omnihil
