#include "protocols/plain_packet.h"

#include <algorithm>
#include <array>

#include "protocols/cobs.h"
#include "protocols/codec.h"
#include "protocols/packet_list.h"

namespace omnihil {
namespace {

constexpr std::size_t kLongestStuffed = 253;  // packets in COBS: one code, hence two bytes more in the frame

bool is_type_field(const Field& field) { return field.kind == FieldKind::kType; }

// Bytes from the first up to the last type field's end: fewer tell no packet.
std::size_t bytes_to_type(const Message& message) {
  int bits = 0;
  for (const Field& field : message.fields) {
    if (is_type_field(field)) bits = std::max(bits, field.bit + field.bits);
  }
  return static_cast<std::size_t>(bits + 7) / 8;
}

const Field* length_field(const Message& message) {
  for (const Field& field : message.fields) {
    if (field.kind == FieldKind::kLength) return &field;
  }
  return nullptr;
}

// The field that tells packets apart, to be named where none fits.
std::string_view type_name(std::span<const Message> messages) {
  for (const Message& message : messages) {
    for (const Field& field : message.fields) {
      if (is_type_field(field)) return field.name;
    }
  }
  return {};
}

DecodeResult refused(PacketError error, std::string_view field = {}) {
  DecodeResult result;
  result.error = error;
  result.field = field;
  return result;
}

// A version that this packet does not have. Where the version stands in front of the type, a packet of another version
// need not have one of ours.
const Field* other_version(const Message& message, std::span<const std::uint8_t> packet, bool before_type) {
  int type_bit = 0;
  for (const Field& field : message.fields) {
    if (is_type_field(field)) type_bit = field.bit;
  }
  for (const Field& field : message.fields) {
    const bool is_version = field.kind == FieldKind::kConst && field.cause == ConstCause::kVersion;
    if (!is_version || (field.bit < type_bit) != before_type) continue;
    if (read_bits(packet, field.bit, field.bits, message.bit_order) != field.constant) return &field;
  }
  return nullptr;
}

// The whole packet's length: with a text it says so itself; 0: it says less than its fields have.
std::size_t packet_size(const Message& message, std::span<const std::uint8_t> packet) {
  const auto fields_bytes = static_cast<std::size_t>(message.size_bytes);
  if (!message.text_tail) return fields_bytes;
  const Field* field = length_field(message);
  const std::uint64_t size = read_bits(packet, field->bit, field->bits, message.bit_order) + field->constant;
  return size < fields_bytes ? 0 : static_cast<std::size_t>(size);
}

}  // namespace

bool has_type_of(const Message& message, std::span<const std::uint8_t> bytes) {
  if (bytes.size() < bytes_to_type(message)) return false;
  for (const Field& field : message.fields) {
    if (!is_type_field(field)) continue;
    const std::uint64_t raw = read_bits(bytes, field.bit, field.bits, message.bit_order);
    if (raw != required_raw(field, message, bytes.size())) return false;
  }
  return true;
}

DecodeResult decode_packet(std::span<const Message> messages, std::span<const std::uint8_t> packet) {
  const Message* found = nullptr;
  std::size_t type_bytes = 0;
  std::size_t smallest = static_cast<std::size_t>(messages.front().size_bytes);
  for (const Message& message : messages) {
    type_bytes = std::max(type_bytes, bytes_to_type(message));
    smallest = std::min(smallest, static_cast<std::size_t>(message.size_bytes));
  }
  if (packet.size() < smallest) return refused(PacketError::kTooShort);
  if (const Field* version = other_version(messages.front(), packet, true))
    return refused(PacketError::kVersion, version->name);
  for (const Message& message : messages) {
    if (!has_type_of(message, packet)) continue;
    const auto fields_bytes = static_cast<std::size_t>(message.size_bytes);
    const bool fits = message.text_tail ? packet.size() >= fields_bytes : packet.size() == fields_bytes;
    const bool has_type = bytes_to_type(message) > 0;  // without one the length alone tells it
    if (fits || (found == nullptr && has_type)) found = &message;
    if (fits) break;
  }
  if (found == nullptr) {
    return packet.size() < type_bytes ? refused(PacketError::kTooShort)
                                      : refused(PacketError::kUnknownType, type_name(messages));
  }
  const auto fields_bytes = static_cast<std::size_t>(found->size_bytes);
  if (packet.size() < fields_bytes) return refused(PacketError::kTooShort);
  if (const Field* version = other_version(*found, packet, false))
    return refused(PacketError::kVersion, version->name);
  const std::size_t size = packet_size(*found, packet);
  if (size == 0) return refused(PacketError::kLength, length_field(*found)->name);
  if (packet.size() < size) return refused(PacketError::kTooShort);
  if (packet.size() > size) return refused(PacketError::kTooLong);
  DecodeResult result;
  const FieldFault fault = decode_fields(*found, packet, size, result.values);
  result.error = fault.error;
  result.field = fault.field;
  const auto text = packet.subspan(fields_bytes);
  result.values.text = {reinterpret_cast<const char*>(text.data()), text.size()};
  return result;
}

RadioFormat::EncodeResult encode_packet(const Values& values, std::vector<std::uint8_t>& out) {
  const auto size = static_cast<std::size_t>(values.message->size_bytes);
  const std::string_view text = values.message->text_tail ? values.text : std::string_view{};
  const std::size_t before = out.size();
  out.resize(before + size);
  const FieldFault fault = encode_fields(values, size + text.size(), std::span(out).subspan(before, size));
  if (fault.error != PacketError::kNone) {
    out.resize(before);
    return {fault.error, fault.field};
  }
  out.insert(out.end(), text.begin(), text.end());
  return {};
}

DecodeResult decode_frame(const RadioFormat& format, std::span<const std::uint8_t> frame) {
  if (format.framing == Framing::kNone) return decode_packet(format.messages, frame);
  if (format.list != nullptr) return decode_list_of_one(format, frame);
  if (frame.empty()) return refused(PacketError::kTooShort);
  if (frame.back() != 0) return refused(PacketError::kFraming);
  std::array<std::uint8_t, kLongestStuffed> buffer{};
  const auto longest = static_cast<std::size_t>(format.max_frame_bytes) - 2;
  const CobsResult cobs =
      cobs_decode(frame.first(frame.size() - 1), std::span(buffer).first(std::min(longest, buffer.size())));
  if (cobs.status == CobsStatus::kBadCode) return refused(PacketError::kFraming);
  if (cobs.status == CobsStatus::kTooLong) return refused(PacketError::kTooLong);
  return decode_packet(format.messages, std::span(buffer).first(cobs.size));
}

RadioFormat::EncodeResult encode_frame(const RadioFormat& format, const Values& values,
                                       std::vector<std::uint8_t>& out) {
  if (format.framing == Framing::kNone) return encode_packet(values, out);
  if (format.list != nullptr) return encode_list(format, std::span(&values, 1), out);
  std::array<std::uint8_t, kLongestStuffed> buffer{};
  const auto size = static_cast<std::size_t>(values.message->size_bytes);
  const auto packet = std::span(buffer).first(size);
  const FieldFault fault = encode_fields(values, size, packet);
  if (fault.error != PacketError::kNone) return {fault.error, fault.field};
  cobs_encode(packet, out);
  out.push_back(0);
  return {};
}

}  // namespace omnihil
