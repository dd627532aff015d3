// The property that every input must have, for the fuzzer and for the normal tests.
//
//   check_packet_property({0x00, 0x03, 0x01, 0xfe, …});   // aborts with a message where it does not hold
//
// Byte 0 picks the format (low 7 bits) and how the rest is used:
//   highest bit 0: the rest is a frame from the wire. It is refused with a cause, or it survives
//                  decode, encode, decode with the same bytes and the same values.
//   highest bit 1: byte 1 picks the packet, the rest fills its fields bit by bit. Encoding refuses it with
//                  a cause and appends nothing, or its frame decodes to the same contents.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "protocols/codec.h"
#include "protocols/radio_format.h"
#include "tests/fuzz/fuzz_target.h"

namespace omnihil {

inline bool same_contents(const Values& a, const Values& b) {
  if (a.message != b.message || a.text != b.text) return false;
  for (std::size_t i = 0; i < a.message->fields.size(); ++i) {
    if (a.fields[i].raw != b.fields[i].raw) return false;
  }
  return true;
}

inline bool check_frame(const RadioFormat& format, std::span<const std::uint8_t> frame) {
  const DecodeResult first = format.decode(frame);
  if (first.error != PacketError::kNone) {
    demand(first.error < PacketError::kCount, "a refusal has a cause");
    return false;
  }
  std::vector<std::uint8_t> again;
  demand(format.encode(first.values, again).error == PacketError::kNone, "what was decoded can be encoded");
  demand(std::vector<std::uint8_t>(frame.begin(), frame.end()) == again, "the same bytes come back");
  const DecodeResult second = format.decode(again);
  demand(second.error == PacketError::kNone, "what was encoded can be decoded");
  demand(same_contents(first.values, second.values), "the same values come back");
  return true;
}

// The fields of `message` filled from `bytes`; what a table prescribes is left to the encoder.
inline Values contents_from(const Message& message, std::span<const std::uint8_t> bytes) {
  std::vector<std::uint8_t> filled(static_cast<std::size_t>(message.size_bytes));
  for (std::size_t i = 0; i < filled.size() && i < bytes.size(); ++i) filled[i] = bytes[i];
  Values values;
  values.message = &message;
  for (std::size_t i = 0; i < message.fields.size(); ++i) {
    const Field& field = message.fields[i];
    const bool free = field.kind == FieldKind::kInteger || field.kind == FieldKind::kReserved ||
                      field.kind == FieldKind::kFloat32 || field.kind == FieldKind::kRanged32 ||
                      field.kind == FieldKind::kScaled;
    if (!free) continue;
    const std::uint64_t raw = read_bits(filled, field.bit, field.bits, message.bit_order);
    values.fields[i] = {.number = field_number(field, raw), .raw = raw};
  }
  return values;
}

// An answer of ER-Force's robots with nothing behind its first fields has the bytes of a halt: nothing in their packets says
// which way they go (notes of erforce-proto2025). Protobuf packets whose fields that are not 0 fit an earlier table, too,
// are that one's.
inline bool is_read_as(const RadioFormat& format, const Message& sent, const Message& read) {
  return &sent == &read || (format.framing == Framing::kProtobuf && &read < &sent) ||
         (format.id.starts_with("erforce-proto2025") && sent.name == "response" && read.name == "halt");
}

inline bool check_contents(const RadioFormat& format, std::span<const std::uint8_t> bytes) {
  if (bytes.empty()) return false;
  const Message& message = format.messages[bytes[0] % format.messages.size()];
  const Values values = contents_from(message, bytes.subspan(1));
  std::vector<std::uint8_t> frame;
  if (format.encode(values, frame).error != PacketError::kNone) {
    demand(frame.empty(), "a refused packet appends nothing");
    return false;
  }
  demand(frame.size() <= static_cast<std::size_t>(format.max_frame_bytes),
         "no frame is longer than the longest");
  const DecodeResult result = format.decode(frame);
  demand(result.error == PacketError::kNone, "what was encoded can be decoded");
  demand(is_read_as(format, message, *result.values.message), "a packet stays what it is");
  for (std::size_t i = 0; result.values.message == &message && i < message.fields.size(); ++i) {
    const FieldKind kind = message.fields[i].kind;
    if (kind == FieldKind::kConst || kind == FieldKind::kType || kind == FieldKind::kLength ||
        kind == FieldKind::kChecksum) {
      continue;
    }
    // -0.0 and 0.0 are the same number and two contents: floats go by their number.
    const bool same = kind == FieldKind::kFloat32 ? result.values.fields[i].number == values.fields[i].number
                                                  : result.values.fields[i].raw == values.fields[i].raw;
    demand(same, "contents survive the wire");
  }
  return check_frame(format, frame);
}

// True when the input was a packet, false when it was refused.
inline bool check_packet_property(std::span<const std::uint8_t> input) {
  if (input.empty()) return false;
  const auto formats = radio_formats();
  const RadioFormat& format = *formats[(input[0] & 0x7Fu) % formats.size()];
  return (input[0] & 0x80u) == 0 ? check_frame(format, input.subspan(1))
                                 : check_contents(format, input.subspan(1));
}

}  // namespace omnihil
