// Packets whose frame is their fields and nothing else: the table alone is the codec.
//
//   const DecodeResult result = decode_packet(messages, packet);
//   encode_packet(result.values, bytes);                            // appends the same bytes
//
// A packet is the message whose type fields all hold their code; of several such, the one of its length. Its
// length must be the table's, or with a text what its length field says. A message without a type field is told by
// its length alone.
#pragma once
#include "protocols/radio_format.h"

namespace omnihil {

// True when every type field of `message` lies inside `bytes` and holds its code.
bool has_type_of(const Message& message, std::span<const std::uint8_t> bytes);

// A frame of a format whose tables and framing are all of its codec; RadioFormat::decode and encode are these.
DecodeResult decode_frame(const RadioFormat& format, std::span<const std::uint8_t> frame);
RadioFormat::EncodeResult encode_frame(const RadioFormat& format, const Values& values,
                                       std::vector<std::uint8_t>& out);

DecodeResult decode_packet(std::span<const Message> messages, std::span<const std::uint8_t> packet);
RadioFormat::EncodeResult encode_packet(const Values& values, std::vector<std::uint8_t>& out);

}  // namespace omnihil
