#include "protocols/rem_packet.h"

#include "protocols/codec.h"

namespace omnihil::rem {
namespace {

const Field* field_of_kind(const Message& message, FieldKind kind) {
  for (const Field& field : message.fields) {
    if (field.kind == kind) return &field;
  }
  return nullptr;
}

std::uint64_t read(const Message& message, const Field& field, std::span<const std::uint8_t> bytes) {
  return read_bits(bytes, field.bit, field.bits, message.bit_order);
}

DecodeResult refused(PacketError error, std::string_view field = {}) {
  DecodeResult result;
  result.error = error;
  result.field = field;
  return result;
}

}  // namespace

std::optional<std::size_t> packet_bytes(std::span<const Message> messages,
                                        std::span<const std::uint8_t> bytes) {
  if (bytes.empty()) return std::nullopt;
  const Message* message = message_of_type(messages, bytes[0]);
  if (message == nullptr) return 0;
  const auto fields_bytes = static_cast<std::size_t>(message->size_bytes);
  if (!message->text_tail) return fields_bytes;
  if (bytes.size() < fields_bytes) return std::nullopt;
  const Field* size_field = field_of_kind(*message, FieldKind::kLength);
  const auto size = static_cast<std::size_t>(read(*message, *size_field, bytes));
  return size < fields_bytes ? 0 : size;
}

DecodeResult decode(std::span<const Message> messages, std::span<const std::uint8_t> frame) {
  if (frame.empty()) return refused(PacketError::kTooShort);
  const Message* message = message_of_type(messages, frame[0]);
  if (message == nullptr) return refused(PacketError::kUnknownType, messages[0].fields[0].name);
  const auto fields_bytes = static_cast<std::size_t>(message->size_bytes);
  if (frame.size() < fields_bytes) return refused(PacketError::kTooShort);
  // A packet of another version has another layout: nothing after the version may be read.
  const Field* version = field_of_kind(*message, FieldKind::kConst);
  if (read(*message, *version, frame) != version->constant)
    return refused(PacketError::kVersion, version->name);
  const std::size_t size = packet_bytes(messages, frame).value_or(0);
  const Field* size_field = field_of_kind(*message, FieldKind::kLength);
  if (size_field != nullptr && (size == 0 || read(*message, *size_field, frame) != size)) {
    return refused(PacketError::kLength, size_field->name);
  }
  if (frame.size() < size) return refused(PacketError::kTooShort);
  if (frame.size() > size) return refused(PacketError::kTooLong);
  DecodeResult result;
  const FieldFault fault = decode_fields(*message, frame, size, result.values);
  result.error = fault.error;
  result.field = fault.field;
  const auto text = frame.subspan(fields_bytes);
  result.values.text = {reinterpret_cast<const char*>(text.data()), text.size()};
  return result;
}

RadioFormat::EncodeResult encode(const Values& values, std::vector<std::uint8_t>& out) {
  const Message& message = *values.message;
  const auto fields_bytes = static_cast<std::size_t>(message.size_bytes);
  const std::string_view text = message.text_tail ? values.text : std::string_view{};
  const std::size_t before = out.size();
  out.resize(before + fields_bytes);
  const FieldFault fault =
      encode_fields(values, fields_bytes + text.size(), std::span(out).subspan(before, fields_bytes));
  if (fault.error != PacketError::kNone) {
    out.resize(before);
    return {fault.error, fault.field};
  }
  out.insert(out.end(), text.begin(), text.end());
  return {};
}

}  // namespace omnihil::rem
