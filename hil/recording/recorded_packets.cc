#include "hil/recording/recorded_packets.h"

#include <string_view>

#include "hil/recording/compare_recordings.h"

namespace omnihil {

std::vector<RecordedPacket> dongle_packets(const Recording& recording, const RadioFormat& format) {
  std::vector<RecordedPacket> packets;
  FrameCutter cutter(format);
  const std::vector<TimedBytes> chunks = dongle_bytes_of(recording);
  auto chunk = chunks.begin();  // the one that holds the last byte of the frame at hand
  std::uint64_t chunk_end = chunk == chunks.end() ? 0 : chunk->bytes.size();
  for (const TimedBytes& each : chunks) cutter.push(each.bytes);
  if (recording.complete) cutter.finish();
  while (auto frame = cutter.next()) {
    const std::uint64_t frame_end = frame->offset + frame->bytes.size();
    while (chunk_end < frame_end) chunk_end += (++chunk)->bytes.size();
    packets.push_back({chunk->now_ns, std::move(*frame)});
  }
  return packets;
}

int packet_robot(const Values& values) {
  for (const std::string_view name : {"fromRobotId", "robot", "robot_id"}) {
    if (values.message->field_index(name) >= 0) return static_cast<int>(values.number(name));
  }
  return -1;
}

}  // namespace omnihil
