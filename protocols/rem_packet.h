// RoboTeam Twente's REM packets: what all versions share beyond the rows of their tables.
//
//   std::size_t size = rem::packet_bytes(kMessages, frame).value_or(0);   // kMessages: the tables of the version at hand
//
// A packet has no framing and no checksum: byte 0 is the type, the type gives the length, and the header's
// payloadSize repeats it. Where packets follow each other on a wire, `packet_bytes` finds the next one.
// Source: RoboTeamTwente/roboteam_embedded_messages 27e6961 (generator, version 5) and 9cb3c21 (version 8).
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "protocols/radio_format.h"

namespace omnihil::rem {

// The length of the packet that starts with `bytes`, as far as they tell: by its type, and for a packet with
// a text by its payloadSize. Empty while more bytes are needed; 0 when no packet starts like this.
std::optional<std::size_t> packet_bytes(std::span<const Message> messages,
                                        std::span<const std::uint8_t> bytes);

}  // namespace omnihil::rem
