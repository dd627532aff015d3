#include "hil/recording/replay.h"

#include <algorithm>

#include "hil/loop/mover_values.h"
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

void ObserverList::field_input(std::int64_t now_ns, FieldInput kind, int robot_id,
                               std::span<const double> values) {
  for (SessionObserver* observer : observers_) observer->field_input(now_ns, kind, robot_id, values);
}
void ObserverList::opponents_bytes(std::int64_t now_ns, std::span<const std::uint8_t> bytes) {
  for (SessionObserver* observer : observers_) observer->opponents_bytes(now_ns, bytes);
}
void ObserverList::world(std::int64_t now_ns, const World& world) {
  for (SessionObserver* observer : observers_) observer->world(now_ns, world);
}

namespace {

bool is_input(const RecordedChunk& chunk) {
  using Kind = RecordedChunk::Kind;
  return chunk.kind != Kind::kSample && chunk.kind != Kind::kDongleBytes && chunk.kind != Kind::kBallSeen &&
         chunk.kind != Kind::kConsole;
}

// What went past the radio; the ids were checked when it was read.
void give(const RecordedChunk& chunk, Session& session) {
  using Kind = RecordedChunk::Kind;
  const std::vector<double>& v = chunk.sample;
  if (chunk.kind == Kind::kBallPlaced) {
    if (v.empty())
      session.take_ball_away();
    else
      session.put_ball({v[0], v[1], v[2]}, {v[3], v[4], v[5]}, {v[6], v[7], v[8]});
    return;
  }
  if (chunk.kind == Kind::kMovers) session.set_movers(movers_of(v));
  for (int index = 0; index < session.robot_count(); ++index) {
    if (session.robot_key(index) != chunk.robot_id) continue;
    if (chunk.kind == Kind::kCommand) session.command(index, command_of(v));
    if (chunk.kind == Kind::kPlaced) session.set_pose(index, v[0], v[1], v[2]);
    if (chunk.kind == Kind::kPushed) session.set_velocity(index, v[0], v[1], v[2]);
    if (chunk.kind == Kind::kPresent) session.set_present(index, v[0] != 0.0);
  }
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
  std::vector<std::uint8_t> host, opponents_host;
  std::vector<std::uint8_t> out, opponents_out;
  auto next = recording.chunks.begin();
  // A run that was cut off may end inside a step: that step is run whole.
  const std::int64_t end_ns = recording.end_ns + (recording.complete ? 0 : 1);
  while (session.now_ns() < end_ns) {
    host.clear();
    opponents_host.clear();
    out.clear();
    opponents_out.clear();
    for (; next != recording.chunks.end() && next->now_ns <= session.now_ns(); ++next) {
      if (next->kind == Kind::kHostBytes) host.insert(host.end(), next->bytes.begin(), next->bytes.end());
      if (next->kind == Kind::kOpponentsBytes)
        opponents_host.insert(opponents_host.end(), next->bytes.begin(), next->bytes.end());
      if (next->kind == Kind::kHostClosed) session.host_closed();
      give(*next, session);
    }
    session.step(host, out, opponents_host, opponents_out);
  }
  session.set_observer(nullptr);
}

}  // namespace omnihil
