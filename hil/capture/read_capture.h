// Any capture that we read, told by how it begins; and of it the bytes of one host and one dongle.
//
//   if (is_capture(text)) {
//     Capture capture = read_capture(text, "field.pcapng", {});
//     HostBytes both = host_bytes(capture, {.udp_port = 10301}, "field.pcapng");
//     for (const Captured& each : both.pieces) …               // times from 0, every way known
//   }
//
// Which bytes are whose is taken from the filter; without one from the only UDP port or CAN ids there are, and said. Where there
// is a choice, BadCapture lists it. Bytes of a serial capture that does not say its ways are taken as kUnknown.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hil/capture/captured.h"

namespace omnihil {

struct CaptureFilter {
  std::optional<std::uint16_t> udp_port;             // the dongle's: what goes there is the host's
  std::optional<std::uint32_t> can_id, can_back_id;  // the host's bytes, the dongle's
  std::int64_t time_unit_ns = 0;                     // of asc and CSV; 0: as the file says, else seconds
};

// "7E0", "0x7e0": a CAN id of 11 or 29 bits.
std::optional<std::uint32_t> parse_can_id(const std::string& text);

bool is_capture(const std::string& text);
Capture read_capture(const std::string& text, const std::string& name, const CaptureFilter& filter);

struct HostBytes {
  std::vector<Captured> pieces;
  std::int64_t start_ns = 0;  // where time 0 was in the capture
  bool unix_time = false;
  std::vector<std::string> notes;
};
HostBytes host_bytes(const Capture& capture, const CaptureFilter& filter, const std::string& name);

// The other way round: bytes as the frames that carry them over CAN, 8 bytes each, ids 7E0 from the host and 7E8 to it; what is
// CAN already stays as it is. Throws BadCapture where a way is unknown.
std::vector<Captured> as_can_frames(std::span<const Captured> pieces);

}  // namespace omnihil
