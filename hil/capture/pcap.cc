#include "hil/capture/pcap.h"

#include <pcap/pcap.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <functional>
#include <memory>
#include <span>

#include "hil/capture/captured.h"
#include "hil/capture/decimal_time.h"
#include "hil/capture/pcapng.h"

namespace omnihil {
namespace {

using Bytes = std::span<const std::uint8_t>;
constexpr int kUser0 = DLT_USER0;
constexpr std::uint16_t kIpv4 = 0x0800, kIpv6 = 0x86DD, kVlan = 0x8100, kServiceVlan = 0x88A8;  // EtherType
constexpr std::uint16_t kCanInSll = 0x000C, kCanFdInSll = 0x000D;  // LINUX_SLL_P_CAN, _CANFD
constexpr std::uint8_t kUdp = 17;
constexpr std::uint16_t kSentByUs = 4;  // LINUX_SLL_OUTGOING

constexpr const char* kOther = "a packet that is neither UDP nor CAN: left out";

std::uint16_t be16(Bytes b, std::size_t at) { return static_cast<std::uint16_t>(b[at] << 8 | b[at + 1]); }
std::uint32_t be32(Bytes b, std::size_t at) {
  return static_cast<std::uint32_t>(be16(b, at)) << 16 | be16(b, at + 2);
}

const char* take_udp(Bytes b, Captured& piece) {
  constexpr std::size_t kHeader = 8;
  if (b.size() < kHeader) return kOther;
  const std::size_t length = be16(b, 4);
  if (length < kHeader || length > b.size()) return "a UDP packet that is cut: left out";
  piece.carrier = CaptureCarrier::kUdp;
  piece.from_port = be16(b, 0);
  piece.to_port = be16(b, 2);
  piece.bytes.assign(b.begin() + kHeader, b.begin() + static_cast<std::ptrdiff_t>(length));
  return nullptr;
}

const char* take_ip(Bytes b, Captured& piece) {
  if (b.empty()) return kOther;
  if (b[0] >> 4 == 4) {
    const std::size_t header = 4U * (b[0] & 15U);
    if (b.size() < header || header < 20 || b[9] != kUdp) return kOther;
    if ((be16(b, 6) & 0x3FFF) != 0) return "a fragment of a UDP packet: left out";  // offset, or more to come
    return take_udp(b.subspan(header), piece);
  }
  constexpr std::size_t kHeader6 = 40;
  if (b[0] >> 4 != 6 || b.size() < kHeader6 || b[6] != kUdp) return kOther;
  return take_udp(b.subspan(kHeader6), piece);
}

// SocketCAN: id and flags, most significant first; length; flags of FD; two more; data.
const char* take_can(Bytes b, Captured& piece) {
  constexpr std::uint32_t kExtended = 0x8000'0000, kRemote = 0x4000'0000, kError = 0x2000'0000;
  constexpr std::uint8_t kBitRateSwitch = 0x01, kFd = 0x04;
  constexpr std::size_t kHeader = 8;
  if (b.size() < kHeader) return "a CAN frame that is cut: left out";
  const std::uint32_t id = be32(b, 0);
  if ((b[5] & 0x80) != 0) return "CAN XL: left out";
  if ((id & kError) != 0) return "error frame: left out";
  if ((id & kRemote) != 0) return "remote frame: left out";
  if (b.size() < kHeader + b[4]) return "a CAN frame that is cut: left out";
  piece.carrier = CaptureCarrier::kCan;
  piece.extended = (id & kExtended) != 0;
  piece.can_id = id & (piece.extended ? 0x1FFF'FFFFU : 0x7FFU);
  piece.fd = (b[5] & kFd) != 0 || b[4] > 8;
  piece.bitrate_switch = piece.fd && (b[5] & kBitRateSwitch) != 0;
  piece.bytes.assign(b.begin() + kHeader, b.begin() + static_cast<std::ptrdiff_t>(kHeader + b[4]));
  return nullptr;
}

const char* take_ether_type(std::uint16_t type, Bytes b, Captured& piece) {
  return type == kIpv4 || type == kIpv6 ? take_ip(b, piece) : kOther;
}

const char* take_ethernet(Bytes b, Captured& piece) {
  std::size_t at = 12;
  while (b.size() >= at + 2 && (be16(b, at) == kVlan || be16(b, at) == kServiceVlan)) at += 4;
  return b.size() < at + 2 ? kOther : take_ether_type(be16(b, at), b.subspan(at + 2), piece);
}

const char* take_cooked(std::uint16_t way, std::uint16_t type, Bytes b, Captured& piece) {
  piece.way = way == kSentByUs ? CaptureWay::kFromHost : CaptureWay::kToHost;
  if (type != kCanInSll && type != kCanFdInSll) return take_ether_type(type, b, piece);
  const char* left_out = take_can(b, piece);
  piece.fd = piece.fd || type == kCanFdInSll;
  return left_out;
}

const char* take_packet(int link, Bytes b, Captured& piece) {
  switch (link) {
    case kUser0:
      piece.bytes.assign(b.begin(), b.end());
      return b.empty() ? "an empty packet: left out" : nullptr;
    case DLT_EN10MB:
      return take_ethernet(b, piece);
    case DLT_LINUX_SLL:
      return b.size() < 16 ? kOther : take_cooked(be16(b, 0), be16(b, 14), b.subspan(16), piece);
    case DLT_LINUX_SLL2:
      return b.size() < 20 ? kOther : take_cooked(b[10], be16(b, 0), b.subspan(20), piece);
    case DLT_CAN_SOCKETCAN:
      return take_can(b, piece);
    case DLT_RAW:
    case DLT_IPV4:
    case DLT_IPV6:
      return take_ip(b, piece);
    case DLT_NULL:
    case DLT_LOOP:
      return b.size() < 4 ? kOther : take_ip(b.subspan(4), piece);
    default:
      return kOther;
  }
}

bool is_known_link(int link) {
  for (const int known : {kUser0, DLT_EN10MB, DLT_LINUX_SLL, DLT_LINUX_SLL2, DLT_CAN_SOCKETCAN, DLT_RAW,
                          DLT_IPV4, DLT_IPV6, DLT_NULL, DLT_LOOP})
    if (link == known) return true;
  return false;
}

using Pcap = std::unique_ptr<pcap_t, decltype(&::pcap_close)>;

Pcap opened(const std::string& bytes, const std::string& name) {
  // fmemopen does not write with "r".
  std::FILE* file = ::fmemopen(const_cast<char*>(bytes.data()), bytes.size(), "rb");
  if (file == nullptr) throw BadCapture(name + ": " + std::strerror(errno));
  char error[PCAP_ERRBUF_SIZE] = "";
  Pcap pcap(::pcap_fopen_offline_with_tstamp_precision(file, PCAP_TSTAMP_PRECISION_NANO, error),
            &::pcap_close);
  if (pcap == nullptr) {
    std::fclose(file);
    throw BadCapture(name + ": " + error);
  }
  return pcap;
}

}  // namespace

bool looks_like_pcap(std::string_view bytes) {
  for (const std::string_view magic :
       {"\xa1\xb2\xc3\xd4", "\xd4\xc3\xb2\xa1", "\xa1\xb2\x3c\x4d", "\x4d\x3c\xb2\xa1", "\x0a\x0d\x0d\x0a"})
    if (bytes.starts_with(magic)) return true;
  return false;
}

Capture read_pcap(const std::string& bytes, const std::string& name) {
  const Pcap pcap = opened(bytes, name);
  const int link = ::pcap_datalink(pcap.get());
  if (!is_known_link(link)) {
    const char* says = ::pcap_datalink_val_to_name(link);
    throw BadCapture(name + ": link type: found " + (says == nullptr ? std::to_string(link) : says) +
                     ", allowed: Ethernet, Linux cooked, raw IP, loopback, SocketCAN, USER0");
  }
  const std::vector<CaptureWay> ways = pcapng_ways(bytes);
  Capture capture;
  capture.unix_time = true;
  CaptureNotes notes(name, "packet ");
  pcap_pkthdr* header = nullptr;
  const u_char* data = nullptr;
  int more = 0;
  for (std::size_t number = 1; (more = ::pcap_next_ex(pcap.get(), &header, &data)) == 1; ++number) {
    Captured piece;
    if (number <= ways.size()) piece.way = ways[number - 1];
    const char* left_out = "a packet that was cut when it was captured: left out";
    // tv_usec: nanoseconds, as asked for; a second or more of them where the file is damaged
    const auto seconds = header->ts.tv_sec, fraction_ns = header->ts.tv_usec;
    if (seconds < 0 || seconds > kMostTime_ns / kSecond_ns || fraction_ns < 0 || fraction_ns >= kSecond_ns ||
        seconds * kSecond_ns + fraction_ns > kMostTime_ns)
      left_out = "a time before 1970, after 2096, or that is none: left out";
    else if (header->caplen >= header->len)
      left_out = take_packet(link, Bytes(data, header->caplen), piece);
    if (left_out != nullptr) {
      notes.count(left_out, number);
    } else if (piece.bytes.empty() && piece.carrier != CaptureCarrier::kCan) {
      notes.count("a packet without payload: left out", number);
    } else {
      piece.at_ns = seconds * kSecond_ns + fraction_ns;
      capture.pieces.push_back(std::move(piece));
    }
  }
  if (more == PCAP_ERROR) notes.say(std::string("the end is missing: ") + ::pcap_geterr(pcap.get()));
  sort_by_time(capture, notes);
  capture.notes = notes.list();
  return capture;
}

}  // namespace omnihil
