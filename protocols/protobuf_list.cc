#include "protocols/protobuf_list.h"

#include <cassert>

#include "protocols/codec.h"

namespace omnihil {
namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr std::uint8_t kListKey = 0x0A;  // number 1, length and bytes
enum WireType : std::uint8_t { kVarint = 0, kFourBytes = 5 };

WireType wire_type(const Field& field) { return field.kind == FieldKind::kFloat32 ? kFourBytes : kVarint; }

void append_varint(std::uint64_t value, std::vector<std::uint8_t>& out) {
  for (; value > 0x7F; value >>= 7) out.push_back(static_cast<std::uint8_t>(value | 0x80));
  out.push_back(static_cast<std::uint8_t>(value));
}

// The varint at the front, which is taken away; none where it is cut off, longer than it need be or beyond 64 bits.
std::optional<std::uint64_t> take_varint(Bytes& rest) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < rest.size() && i < 10; ++i) {
    const std::uint64_t seven = rest[i] & 0x7Fu;
    if (i == 9 && seven > 1) return std::nullopt;
    value |= seven << 7 * i;
    if ((rest[i] & 0x80u) != 0) continue;
    if (i > 0 && seven == 0) return std::nullopt;
    rest = rest.subspan(i + 1);
    return value;
  }
  return std::nullopt;
}

// One 0A · length · packet at the front: the packet; `rest` goes on behind it.
std::optional<Bytes> take_packet(Bytes& rest) {
  if (rest.front() != kListKey) return std::nullopt;
  Bytes behind = rest.subspan(1);
  const std::optional<std::uint64_t> size = take_varint(behind);
  if (!size || *size > behind.size()) return std::nullopt;
  rest = behind.subspan(static_cast<std::size_t>(*size));
  return behind.first(static_cast<std::size_t>(*size));
}

const Field* field_of_tag(const Message& message, std::uint64_t tag) {
  for (const Field& field : message.fields) {
    if (field.tag != 0 && static_cast<std::uint64_t>(field.tag) == tag) return &field;
  }
  return nullptr;
}

}  // namespace

std::optional<std::size_t> protobuf_packets(Bytes frame, PacketError* fault) {
  const auto refused = [&](PacketError error) -> std::optional<std::size_t> {
    if (fault != nullptr) *fault = error;
    return std::nullopt;
  };
  if (frame.empty() || frame.size() < 1u + frame[0]) return refused(PacketError::kTooShort);
  if (frame.size() > 1u + frame[0]) return refused(PacketError::kTooLong);
  std::size_t packets = 0;
  for (Bytes rest = frame.subspan(1); !rest.empty(); ++packets) {
    if (!take_packet(rest)) return refused(PacketError::kFraming);
  }
  return packets;
}

Bytes protobuf_packet(Bytes frame, std::size_t index) {
  Bytes rest = frame.subspan(1);
  for (std::size_t i = 0; i < index; ++i) take_packet(rest);
  return *take_packet(rest);
}

FieldFault flatten(const Message& message, Bytes packet, FlatPacket& flat) {
  flat.size = static_cast<std::size_t>(message.size_bytes);
  assert(flat.size <= flat.bytes.size());
  flat.bytes.fill(0);
  const auto bytes = std::span(flat.bytes).first(flat.size);
  std::uint64_t last_tag = 0;
  while (!packet.empty()) {
    const std::optional<std::uint64_t> key = take_varint(packet);
    if (!key) return {PacketError::kFraming, {}};
    const Field* field = field_of_tag(message, *key >> 3);
    if (field == nullptr) return {PacketError::kUnknownType, {}};
    const std::uint64_t tag = *key >> 3;
    if (tag <= last_tag || (*key & 7u) != wire_type(*field)) return {PacketError::kFraming, field->name};
    last_tag = tag;
    std::uint64_t raw = 0;
    if (wire_type(*field) == kFourBytes) {
      if (packet.size() < 4) return {PacketError::kTooShort, field->name};
      raw = read_bits(packet, 0, 32, BitOrder::kLsbFirst);
      packet = packet.subspan(4);
    } else {
      const std::optional<std::uint64_t> value = take_varint(packet);
      if (!value) return {PacketError::kFraming, field->name};
      if (field->bits < 64 && *value >> field->bits != 0) return {PacketError::kRange, field->name};
      raw = *value;
    }
    if (raw == 0) return {PacketError::kFraming, field->name};
    write_bits(bytes, field->bit, field->bits, message.bit_order, raw);
  }
  return {};
}

void append_protobuf(const Message& message, Bytes flat, std::vector<std::uint8_t>& out) {
  out.push_back(kListKey);
  const std::size_t size_at = out.size();
  out.push_back(0);
  for (const Field& field : message.fields) {
    const std::uint64_t raw = read_bits(flat, field.bit, field.bits, message.bit_order);
    if (field.tag == 0 || raw == 0) continue;
    append_varint(static_cast<std::uint64_t>(field.tag) << 3 | wire_type(field), out);
    if (wire_type(field) == kVarint) {
      append_varint(raw, out);
      continue;
    }
    for (int byte = 0; byte < 4; ++byte) out.push_back(static_cast<std::uint8_t>(raw >> 8 * byte));
  }
  const std::size_t size = out.size() - size_at - 1;
  assert(size < 0x80);  // one byte of length: tables of more are refused where they are read
  out[size_at] = static_cast<std::uint8_t>(size);
}

}  // namespace omnihil
