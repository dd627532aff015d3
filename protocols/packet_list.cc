#include "protocols/packet_list.h"

#include <algorithm>

#include "protocols/codec.h"
#include "protocols/plain_packet.h"
#include "protocols/protobuf_list.h"

namespace omnihil {
namespace {

// Bytes before the first packet: the beginning and the number.
std::size_t head_bytes(const PacketList& list) { return list.begin.size() + 1; }

PacketError frame_fault(const PacketList& list, std::span<const std::uint8_t> frame) {
  const std::size_t seen = std::min(frame.size(), list.begin.size());
  if (!std::equal(frame.begin(), frame.begin() + static_cast<std::ptrdiff_t>(seen), list.begin.begin())) {
    return PacketError::kFraming;
  }
  if (frame.size() < head_bytes(list) + 1) return PacketError::kTooShort;
  const std::size_t packets = frame[list.begin.size()];
  if (packets > static_cast<std::size_t>(list.most)) return PacketError::kLength;
  const std::size_t inside = frame.size() - head_bytes(list) - 1;
  if (packets == 0 ? inside > 0 : inside % packets != 0) return PacketError::kLength;
  return frame.back() == list.end ? PacketError::kNone : PacketError::kFraming;
}

// The bytes of one of the packets of a frame without fault.
std::span<const std::uint8_t> packet_bytes(const PacketList& list, std::span<const std::uint8_t> frame,
                                           std::size_t index) {
  const std::size_t bytes = (frame.size() - head_bytes(list) - 1) / frame[list.begin.size()];
  return frame.subspan(head_bytes(list) + index * bytes, bytes);
}

DecodeResult without_packet(PacketError error) {
  DecodeResult result;
  result.error = error;
  return result;
}

RadioFormat::EncodeResult encode_packets(const PacketList& list, std::span<const Values> packets,
                                         std::vector<std::uint8_t>& out) {
  const std::size_t before = out.size();
  if (packets.size() > static_cast<std::size_t>(list.most)) return {PacketError::kTooLong, {}};
  out.insert(out.end(), list.begin.begin(), list.begin.end());
  out.push_back(static_cast<std::uint8_t>(packets.size()));
  for (const Values& packet : packets) {
    const RadioFormat::EncodeResult result = packet.message->size_bytes == packets[0].message->size_bytes
                                                 ? encode_packet(packet, out)
                                                 : RadioFormat::EncodeResult{PacketError::kLength, {}};
    if (result.error == PacketError::kNone) continue;
    out.resize(before);
    return result;
  }
  out.push_back(list.end);
  return {};
}

// A packet by the first table that fits it; where none does, the fault of the first.
DecodeResult decode_protobuf(std::span<const Message> messages, std::span<const std::uint8_t> packet) {
  DecodeResult first;
  for (const Message& message : messages) {
    FlatPacket flat;
    DecodeResult result;
    FieldFault fault = flatten(message, packet, flat);
    if (fault.error == PacketError::kNone) {
      fault = decode_fields(message, flat.span(), flat.size, result.values);
    }
    result.error = fault.error;
    result.field = fault.field;
    if (fault.error == PacketError::kNone) return result;
    if (first.error == PacketError::kNone) first = result;
  }
  return first;
}

RadioFormat::EncodeResult encode_protobuf(const PacketList& list, std::span<const Values> packets,
                                          std::vector<std::uint8_t>& out) {
  const std::size_t before = out.size();
  out.push_back(0);
  FlatPacket flat;
  RadioFormat::EncodeResult result;
  if (packets.size() > static_cast<std::size_t>(list.most)) result.error = PacketError::kTooLong;
  for (const Values& packet : packets) {
    if (result.error != PacketError::kNone) break;
    flat.size = static_cast<std::size_t>(packet.message->size_bytes);
    const FieldFault fault = encode_fields(packet, flat.size, std::span(flat.bytes).first(flat.size));
    result = {fault.error, fault.field};
    if (fault.error == PacketError::kNone) append_protobuf(*packet.message, flat.span(), out);
  }
  const std::size_t size = out.size() - before - 1;
  if (result.error == PacketError::kNone && size > 0xFF) result.error = PacketError::kTooLong;
  if (result.error == PacketError::kNone) {
    out[before] = static_cast<std::uint8_t>(size);
  } else {
    out.resize(before);
  }
  return result;
}

// The faults of a whole frame, by the framing.
PacketError frame_fault(const RadioFormat& format, std::span<const std::uint8_t> frame) {
  if (format.framing != Framing::kProtobuf) return frame_fault(*format.list, frame);
  PacketError fault = PacketError::kNone;
  const std::optional<std::size_t> packets = protobuf_packets(frame, &fault);
  if (packets && *packets > static_cast<std::size_t>(format.list->most)) return PacketError::kLength;
  return fault;
}

}  // namespace

std::optional<std::size_t> listed_packets(const RadioFormat& format, std::span<const std::uint8_t> frame) {
  if (format.list == nullptr) return 1;
  if (frame_fault(format, frame) != PacketError::kNone) return std::nullopt;
  return format.framing == Framing::kProtobuf ? protobuf_packets(frame)
                                              : std::size_t{frame[format.list->begin.size()]};
}

DecodeResult decode_listed(const RadioFormat& format, std::span<const std::uint8_t> frame,
                           std::size_t index) {
  if (format.list == nullptr) return format.decode(frame);
  const PacketError fault = frame_fault(format, frame);
  if (fault != PacketError::kNone) return without_packet(fault);
  return format.framing == Framing::kProtobuf
             ? decode_protobuf(format.messages, protobuf_packet(frame, index))
             : decode_packet(format.messages, packet_bytes(*format.list, frame, index));
}

bool is_frame(const RadioFormat& format, std::span<const std::uint8_t> frame) {
  const std::optional<std::size_t> packets = listed_packets(format, frame);
  for (std::size_t i = 0; i < packets.value_or(0); ++i) {
    if (decode_listed(format, frame, i).error != PacketError::kNone) return false;
  }
  return packets.has_value();
}

RadioFormat::EncodeResult encode_list(const RadioFormat& format, std::span<const Values> packets,
                                      std::vector<std::uint8_t>& out) {
  if (format.framing == Framing::kProtobuf) return encode_protobuf(*format.list, packets, out);
  if (format.list != nullptr) return encode_packets(*format.list, packets, out);
  return packets.size() == 1 ? format.encode(packets[0], out)
                             : RadioFormat::EncodeResult{PacketError::kLength, {}};
}

DecodeResult decode_list_of_one(const RadioFormat& format, std::span<const std::uint8_t> frame) {
  const PacketError fault = frame_fault(format, frame);
  if (fault != PacketError::kNone) return without_packet(fault);
  if (*listed_packets(format, frame) != 1) return without_packet(PacketError::kLength);
  return decode_listed(format, frame, 0);
}

}  // namespace omnihil
