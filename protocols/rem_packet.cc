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

}  // namespace omnihil::rem
