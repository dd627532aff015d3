#include "hil/recording/recording_memory.h"

#include "hil/recording/command_values.h"

namespace omnihil {

RecordingHeader with_sample_columns(RecordingHeader header) {
  header.columns.clear();
  header.units.clear();
  for (const SampleColumn& column : sample_columns()) {
    header.columns.push_back(column.name);
    header.units.push_back(column.unit);
  }
  for (const std::string& variable : header.watched) {
    header.columns.push_back("var:" + variable);
    header.units.emplace_back("1");
  }
  return header;
}

RecordingMemory::RecordingMemory(RecordingHeader header)
    : decimation_(robot_keys(header), header.sample_every) {
  recording_.header = with_sample_columns(std::move(header));
}

RecordedChunk& RecordingMemory::add(RecordedChunk::Kind kind, std::int64_t now_ns) {
  RecordedChunk& chunk = recording_.chunks.emplace_back();
  chunk.kind = kind;
  chunk.now_ns = now_ns;
  return chunk;
}

void RecordingMemory::host_bytes(std::int64_t now_ns, std::span<const std::uint8_t> bytes) {
  if (!bytes.empty()) add(RecordedChunk::Kind::kHostBytes, now_ns).bytes.assign(bytes.begin(), bytes.end());
}

void RecordingMemory::dongle_bytes(std::int64_t now_ns, std::span<const std::uint8_t> bytes) {
  if (!bytes.empty()) add(RecordedChunk::Kind::kDongleBytes, now_ns).bytes.assign(bytes.begin(), bytes.end());
}

void RecordingMemory::host_closed(std::int64_t now_ns) { add(RecordedChunk::Kind::kHostClosed, now_ns); }

void RecordingMemory::command(std::int64_t now_ns, int robot_id, const RobotCommand& command) {
  RecordedChunk& chunk = add(RecordedChunk::Kind::kCommand, now_ns);
  chunk.robot_id = robot_id;
  chunk.sample = command_values(command);
}

void RecordingMemory::placed(std::int64_t now_ns, int robot_id, double x_m, double y_m, double yaw_rad) {
  RecordedChunk& chunk = add(RecordedChunk::Kind::kPlaced, now_ns);
  chunk.robot_id = robot_id;
  chunk.sample = {x_m, y_m, yaw_rad};
}

void RecordingMemory::field_input(std::int64_t now_ns, FieldInput kind, int robot_id,
                                  std::span<const double> values) {
  using Kind = RecordedChunk::Kind;
  RecordedChunk& chunk = add(kind == FieldInput::kBall     ? Kind::kBallPlaced
                             : kind == FieldInput::kMovers ? Kind::kMovers
                             : kind == FieldInput::kPushed ? Kind::kPushed
                                                           : Kind::kPresent,
                             now_ns);
  chunk.robot_id = robot_id;
  chunk.sample.assign(values.begin(), values.end());
}

void RecordingMemory::opponents_bytes(std::int64_t now_ns, std::span<const std::uint8_t> bytes) {
  if (!bytes.empty())
    add(RecordedChunk::Kind::kOpponentsBytes, now_ns).bytes.assign(bytes.begin(), bytes.end());
}

void RecordingMemory::world(std::int64_t now_ns, const World& world) {
  const BallState* const ball = world.ball();
  if (ball == nullptr || now_ns < next_ball_ns_) return;
  next_ball_ns_ = now_ns + kBallEvery_ns;
  const Vector3 &p = ball->position, &v = ball->velocity;
  add(RecordedChunk::Kind::kBallSeen, now_ns).sample = {p.x(), p.y(), p.z(), v.x(), v.y(), v.z()};
}

void RecordingMemory::robot_tick(std::int64_t now_ns, const RobotSample& sample) {
  if (!decimation_.keep(sample.robot_id)) return;
  RecordedChunk& chunk = add(RecordedChunk::Kind::kSample, now_ns);
  chunk.robot_id = sample.robot_id;
  chunk.sample.reserve(sample_columns().size());
  for (const SampleColumn& column : sample_columns()) chunk.sample.push_back(column.get(sample));
}

Recording RecordingMemory::take(std::int64_t end_ns) {
  recording_.end_ns = end_ns;
  recording_.end.now_ns = end_ns;
  recording_.complete = true;
  return std::exchange(recording_, {});
}

}  // namespace omnihil
