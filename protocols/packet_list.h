// Frames that list packets: AA 55 · number · packets of one length · FF, or protobuf messages (protobuf_list.h).
//
//   const std::size_t count = listed_packets(format, frame).value_or(0);
//   for (std::size_t i = 0; i < count; ++i) answers.push_back(decode_listed(format, frame, i).values);
//   encode_list(format, answers, out);
//
// In other formats a frame lists its one packet, so that this is all that a reader of any format needs.
#pragma once
#include <optional>

#include "protocols/radio_format.h"

namespace omnihil {

// Packets in a whole frame; none where it is no frame of a list.
std::optional<std::size_t> listed_packets(const RadioFormat& format, std::span<const std::uint8_t> frame);
DecodeResult decode_listed(const RadioFormat& format, std::span<const std::uint8_t> frame, std::size_t index);
// True when the frame and all it lists decode.
bool is_frame(const RadioFormat& format, std::span<const std::uint8_t> frame);
// Appends one frame; the packets are of one length.
RadioFormat::EncodeResult encode_list(const RadioFormat& format, std::span<const Values> packets,
                                      std::vector<std::uint8_t>& out);

// The codec of a list of one, for RadioFormat::decode.
DecodeResult decode_list_of_one(const RadioFormat& format, std::span<const std::uint8_t> frame);

}  // namespace omnihil
