// pcapng: our writer, and of any capture which way each packet went, which libpcap does not tell.
//
//   std::string bytes = write_pcapng(pieces, "omnihil");
//
// One interface, USER0 (147) of serial bytes or SocketCAN (227) of CAN frames, times in nanoseconds, the way in each packet's
// flags: outbound is what the host wrote. Cannot: carry serial bytes and CAN frames, or UDP, in one file (BadCapture).
// Source: draft-ietf-opsawg-pcapng, sections 4.1 to 4.3.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "hil/capture/captured.h"

namespace omnihil {

std::string write_pcapng(std::span<const Captured> pieces, const std::string& program);
// Of each packet in the file's order; empty: no pcapng. Blocks that make no sense end it.
std::vector<CaptureWay> pcapng_ways(std::string_view bytes);

}  // namespace omnihil
