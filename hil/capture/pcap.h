// Captures of Wireshark, tcpdump and our own: pcap and pcapng, read by libpcap.
//
//   Capture capture = read_pcap(bytes, "field.pcapng");
//
// Takes UDP payloads of Ethernet (also with VLAN tags), Linux "cooked" (SLL, SLL2), raw IP and loopback captures, IPv4 and
// IPv6; CAN frames of SocketCAN (link type 227, or cooked); and bytes as they are of USER0 (147), which convert writes and the
// dissectors of docs/radio register for. Ways are known where the capture says them: cooked, or pcapng's packet flags.
// Tolerated and said: what is no UDP or no CAN data frame, fragments, packets that were cut when captured, a cut end of the file.
// Cannot: reassemble fragments, IPv6 extension headers, TCP; captures whose interfaces differ in link type; gzip.
// Source: pcap-savefile(5), pcap_next_ex(3PCAP); www.tcpdump.org/linktypes.html; pcapng: draft-ietf-opsawg-pcapng, 4.3.
#pragma once
#include <string>

#include "hil/capture/captured.h"

namespace omnihil {

bool looks_like_pcap(std::string_view bytes);
Capture read_pcap(const std::string& bytes, const std::string& name);

}  // namespace omnihil
