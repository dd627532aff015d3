// The packets of a recording, cut out of the bytes: what the dongle gave its host, and what the host wrote.
//
//   for (const RecordedPacket& packet : dongle_packets(recording, format)) {
//     const DecodeResult decoded = format.decode(packet.frame.bytes);
//   }
#pragma once
#include <cstdint>
#include <vector>

#include "hil/recording/recording.h"
#include "hil/recording/stream_frames.h"

namespace omnihil {

struct RecordedPacket {
  std::int64_t now_ns = 0;  // when its last byte left
  FrameCutter::Frame frame;
};

// What a cut-off recording ends with may be the beginning of a packet: it is left out.
std::vector<RecordedPacket> dongle_packets(const Recording& recording, const RadioFormat& format);

// Both directions, in the order of their times; at one time the host's first. Pieces that no packet begins with are
// there too, as not understood.
struct PassedPacket {
  bool from_host = false;
  RecordedPacket packet;
};
std::vector<PassedPacket> all_packets(const Recording& recording, const RadioFormat& format);

// The robot that a packet came from, by the field names of the formats; -1 when it has none.
int packet_robot(const Values& values);

}  // namespace omnihil
