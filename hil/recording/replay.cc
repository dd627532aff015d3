#include "hil/recording/replay.h"

#include <algorithm>

#include "hil/recording/command_values.h"
#include "hil/recording/recording_reader.h"

namespace omnihil {

void ObserverList::host_bytes(std::int64_t now_ns, std::span<const std::uint8_t> bytes) {
  for (SessionObserver* observer : observers_) observer->host_bytes(now_ns, bytes);
}
void ObserverList::dongle_bytes(std::int64_t now_ns, std::span<const std::uint8_t> bytes) {
  for (SessionObserver* observer : observers_) observer->dongle_bytes(now_ns, bytes);
}
void ObserverList::delivery(std::int64_t now_ns, const Delivery& delivery) {
  for (SessionObserver* observer : observers_) observer->delivery(now_ns, delivery);
}
void ObserverList::robot_tick(std::int64_t now_ns, const RobotSample& sample) {
  for (SessionObserver* observer : observers_) observer->robot_tick(now_ns, sample);
}
void ObserverList::host_closed(std::int64_t now_ns) {
  for (SessionObserver* observer : observers_) observer->host_closed(now_ns);
}

void ObserverList::command(std::int64_t now_ns, int robot_id, const RobotCommand& command) {
  for (SessionObserver* observer : observers_) observer->command(now_ns, robot_id, command);
}
void ObserverList::placed(std::int64_t now_ns, int robot_id, double x_m, double y_m, double yaw_rad) {
  for (SessionObserver* observer : observers_) observer->placed(now_ns, robot_id, x_m, y_m, yaw_rad);
}

namespace {

bool is_input(const RecordedChunk& chunk) {
  using Kind = RecordedChunk::Kind;
  return chunk.kind == Kind::kHostBytes || chunk.kind == Kind::kHostClosed || chunk.kind == Kind::kCommand ||
         chunk.kind == Kind::kPlaced;
}

// What went past the radio; the header's ids were checked when it was read.
void give(const RecordedChunk& chunk, Session& session) {
  const std::vector<int>& ids = session.config().robot_ids;
  const auto at = std::ranges::find(ids, chunk.robot_id);
  if (at == ids.end()) return;
  const int index = static_cast<int>(at - ids.begin());
  if (chunk.kind == RecordedChunk::Kind::kCommand) session.command(index, command_of(chunk.sample));
  if (chunk.kind == RecordedChunk::Kind::kPlaced)
    session.set_pose(index, chunk.sample[0], chunk.sample[1], chunk.sample[2]);
}

}  // namespace

std::vector<std::string> replay_problems(const Recording& recording) {
  using Kind = RecordedChunk::Kind;
  constexpr std::size_t kMost = RecordingReader::kMaxProblems;
  std::vector<std::string> problems;
  const std::int64_t step_ns = recording.header.step_ns;
  std::int64_t last_bytes_ns = -1;
  for (const RecordedChunk& chunk : recording.chunks) {
    if (!is_input(chunk) || problems.size() == kMost) continue;
    if (chunk.now_ns % step_ns != 0) {
      problems.push_back("host input at " + std::to_string(chunk.now_ns) +
                         " ns: allowed: multiples of the loop step, " + std::to_string(step_ns) + " ns");
    }
    if (chunk.kind == Kind::kHostBytes) {
      last_bytes_ns = chunk.now_ns;
    } else if (chunk.kind == Kind::kHostClosed && chunk.now_ns == last_bytes_ns) {
      problems.push_back("close at " + std::to_string(chunk.now_ns) +
                         " ns after host bytes at the same time: allowed: before them, or later");
    }
  }
  return problems;
}

void replay(const Recording& recording, Session& session, SessionObserver* observer) {
  using Kind = RecordedChunk::Kind;
  if (std::vector<std::string> problems = replay_problems(recording); !problems.empty()) {
    throw BadRecording(std::move(problems));
  }
  session.set_observer(observer);
  std::vector<std::uint8_t> host;
  std::vector<std::uint8_t> out;
  auto next = recording.chunks.begin();
  // A run that was cut off may end inside a step: that step is run whole.
  const std::int64_t end_ns = recording.end_ns + (recording.complete ? 0 : 1);
  while (session.now_ns() < end_ns) {
    host.clear();
    out.clear();
    for (; next != recording.chunks.end() && next->now_ns <= session.now_ns(); ++next) {
      if (next->kind == Kind::kHostBytes) host.insert(host.end(), next->bytes.begin(), next->bytes.end());
      if (next->kind == Kind::kHostClosed) session.host_closed();
      give(*next, session);
    }
    session.step(host, out);
  }
  session.set_observer(nullptr);
}

}  // namespace omnihil
