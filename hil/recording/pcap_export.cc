#include "hil/recording/pcap_export.h"

#include "hil/recording/recorded_packets.h"
#include "hil/text/little_endian.h"

namespace omnihil {
namespace {

constexpr std::uint32_t kMagicNanoseconds = 0xa1b23c4d, kLinkUser0 = 147, kLongestPacket = 65'535;

}  // namespace

std::string pcap_header() {
  std::string out;
  put_u32(out, kMagicNanoseconds);
  put_u16(out, 2);  // version 2.4
  put_u16(out, 4);
  put_u32(out, 0);  // reserved
  put_u32(out, 0);
  put_u32(out, kLongestPacket);
  put_u32(out, kLinkUser0);
  return out;
}

void append_pcap_packet(std::string& out, std::uint64_t epoch_ms, std::int64_t now_ns,
                        std::span<const std::uint8_t> bytes) {
  const std::uint64_t unix_ns = epoch_ms * 1'000'000 + static_cast<std::uint64_t>(now_ns);
  put_u32(out, static_cast<std::uint32_t>(unix_ns / 1'000'000'000));
  put_u32(out, static_cast<std::uint32_t>(unix_ns % 1'000'000'000));
  put_u32(out, static_cast<std::uint32_t>(bytes.size()));
  put_u32(out, static_cast<std::uint32_t>(bytes.size()));
  out.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
}

std::string pcap_of(const Recording& recording, const RadioFormat& format) {
  std::string out = pcap_header();
  for (const PassedPacket& passed : all_packets(recording, format))
    append_pcap_packet(out, recording.header.epoch_ms, passed.packet.now_ns, passed.packet.frame.bytes);
  return out;
}

}  // namespace omnihil
