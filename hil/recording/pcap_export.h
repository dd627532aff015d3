// A recording's packets as a capture that Wireshark opens: pcap with times in nanoseconds, link type USER0 (147), for
// which the dissectors of docs/radio register.
//
//   const std::string bytes = pcap_of(recording, format);
//
// Each packet is one record at the time its last byte passed, Unix time by the recording's epoch; pieces that are no
// packet are records too. Cannot: say which way a packet went, since USER0 has no direction (its message does).
// Source: Tcpdump group, pcap-savefile(5); link types, www.tcpdump.org/linktypes.html.
#pragma once
#include <cstdint>
#include <span>
#include <string>

#include "hil/recording/recording.h"
#include "protocols/radio_format.h"

namespace omnihil {

std::string pcap_of(const Recording& recording, const RadioFormat& format);

// Its parts: what a file begins with, and one packet at `now_ns` after `epoch_ms`.
std::string pcap_header();
void append_pcap_packet(std::string& out, std::uint64_t epoch_ms, std::int64_t now_ns,
                        std::span<const std::uint8_t> bytes);

}  // namespace omnihil
