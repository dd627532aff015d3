#include "hil/recording/replay_run.h"

#include <chrono>

#include "hil/loop/reference_firmware.h"
#include "hil/recording/recording_memory.h"
#include "hil/recording/replay.h"
#include "hil/recording/replay_hash.h"
#include "hil/recording/session_setup.h"

namespace omnihil {

RecordingHeader replay_header(const RecordingHeader& recorded, const ReplayOptions& options) {
  RecordingHeader header = recorded;
  if (options.physics) header.plant.physics = *options.physics;
  return header;
}

ReplayRun run_again(const Recording& recording, const ReplayOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  const RecordingHeader header = replay_header(recording.header, options);
  const SessionConfig config = session_config(session_setup(header));
  Session session(config, reference_firmware_for(config));
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
  run.from_host = session.link().from_host();
  run.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return run;
}

}  // namespace omnihil
