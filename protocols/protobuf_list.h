// Frames whose packets are protobuf messages: length in one byte · (0A · length · packet)…, as `repeated … = 1` is written.
//
//   const std::optional<std::size_t> packets = protobuf_packets(frame);
//   const std::span<const std::uint8_t> packet = protobuf_packet(frame, 0);
//   FlatPacket flat;
//   if (flatten(message, packet, flat).error == PacketError::kNone) …   // flat.span(): the bytes of the message's table
//
// A table describes such a packet with its fields side by side, little-endian; each carries its number in the protobuf
// message (Field::tag). Whole numbers travel as varints, floats as four bytes, zeros not at all, fields in the order of
// their numbers: what every encoder writes. Another spelling of the same (fields in another order, written zeros,
// longer varints, unknown numbers) is refused as framing: it would not come back byte for byte.
// Cannot: signed varints, strings, maps, messages inside a packet, other numbers than 1 for the list.
#pragma once
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "protocols/field_table.h"
#include "protocols/packet_error.h"

namespace omnihil {

struct FieldFault;

inline constexpr int kLongestProtobuf = 0x7F;  // of a packet: its length is one byte

// The most bytes that a packet of this table has as protobuf: 7 bits of a number in each byte.
constexpr int most_protobuf_bytes(const Message& message) {
  int most = 0;
  for (const Field& field : message.fields) {
    int key = 1;
    for (int tag = field.tag >> 4; tag > 0; tag >>= 7) ++key;
    most += key + (field.kind == FieldKind::kFloat32 ? 4 : (field.bits + 6) / 7);
  }
  return most;
}
// The longest frame of at most this many packets of that length.
constexpr int protobuf_frame_bytes(int packet_bytes, int packets) {
  const int frame = 1 + packets * (2 + packet_bytes);
  return frame < 0x100 ? frame : 0x100;
}

struct FlatPacket {
  std::array<std::uint8_t, 255> bytes{};
  std::size_t size = 0;
  std::span<const std::uint8_t> span() const { return std::span(bytes).first(size); }
};

// Packets in a whole frame; none where it is no such frame, and then `fault` says why.
std::optional<std::size_t> protobuf_packets(std::span<const std::uint8_t> frame,
                                            PacketError* fault = nullptr);
std::span<const std::uint8_t> protobuf_packet(std::span<const std::uint8_t> frame, std::size_t index);

FieldFault flatten(const Message& message, std::span<const std::uint8_t> packet, FlatPacket& flat);
// Appends 0A, length and packet.
void append_protobuf(const Message& message, std::span<const std::uint8_t> flat,
                     std::vector<std::uint8_t>& out);

}  // namespace omnihil
