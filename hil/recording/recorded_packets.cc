#include "hil/recording/recorded_packets.h"

#include <algorithm>
#include <string_view>

#include "hil/recording/compare_recordings.h"

namespace omnihil {

namespace {

std::vector<RecordedPacket> cut(const std::vector<TimedBytes>& chunks, const RadioFormat& format,
                                bool complete) {
  std::vector<RecordedPacket> packets;
  FrameCutter cutter(format);
  auto chunk = chunks.begin();  // the one that holds the last byte of the frame at hand
  std::uint64_t chunk_end = chunk == chunks.end() ? 0 : chunk->bytes.size();
  for (const TimedBytes& each : chunks) cutter.push(each.bytes);
  if (complete) cutter.finish();
  while (auto frame = cutter.next()) {
    const std::uint64_t frame_end = frame->offset + frame->bytes.size();
    while (chunk_end < frame_end) chunk_end += (++chunk)->bytes.size();
    packets.push_back({chunk->now_ns, std::move(*frame)});
  }
  return packets;
}

}  // namespace

std::vector<RecordedPacket> dongle_packets(const Recording& recording, const RadioFormat& format) {
  return cut(dongle_bytes_of(recording), format, recording.complete);
}

std::vector<PassedPacket> all_packets(const Recording& recording, const RadioFormat& format) {
  std::vector<TimedBytes> written;
  for (const RecordedChunk& chunk : recording.chunks) {
    if (chunk.kind == RecordedChunk::Kind::kHostBytes) written.push_back({chunk.now_ns, chunk.bytes});
  }
  std::vector<PassedPacket> all;
  for (RecordedPacket& packet : cut(written, format, recording.complete))
    all.push_back({true, std::move(packet)});
  for (RecordedPacket& packet : dongle_packets(recording, format)) all.push_back({false, std::move(packet)});
  std::ranges::stable_sort(all, {}, [](const PassedPacket& passed) { return passed.packet.now_ns; });
  return all;
}

int packet_robot(const Values& values) {
  for (const std::string_view name : {"fromRobotId", "robot", "robot_id"}) {
    if (values.message->field_index(name) >= 0) return static_cast<int>(values.number(name));
  }
  // REM's role is whom a packet is for; where one field says it both ways it is the robot.
  const int named = values.message->field_index(FieldRole::kRobot);
  return named < 0 ? -1 : static_cast<int>(values.fields[static_cast<std::size_t>(named)].number);
}

}  // namespace omnihil
