#include "hil/capture/pcapng.h"

#include "hil/capture/candump.h"
#include "hil/text/little_endian.h"

namespace omnihil {
namespace {

constexpr std::uint32_t kSection = 0x0A0D'0D0A, kInterface = 1, kOldPacket = 2, kSimplePacket = 3,
                        kPacket = 6;
constexpr std::uint32_t kByteOrder = 0x1A2B'3C4D;
constexpr std::uint16_t kEnd = 0, kFlags = 2, kUserProgram = 4, kResolution = 9;
constexpr std::uint16_t kLinkUser0 = 147, kLinkSocketCan = 227;
constexpr std::uint32_t kInbound = 1, kOutbound = 2;

void pad(std::string& out) { out.append((4 - out.size() % 4) % 4, '\0'); }

void put_option(std::string& out, std::uint16_t code, std::string_view value) {
  put_u16(out, code);
  put_u16(out, static_cast<std::uint16_t>(value.size()));
  out += value;
  pad(out);
}

void put_block(std::string& out, std::uint32_t type, const std::string& body) {
  const auto length = static_cast<std::uint32_t>(body.size() + 12);
  put_u32(out, type);
  put_u32(out, length);
  out += body;
  put_u32(out, length);
}

void put_be32(std::string& out, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) put_u8(out, static_cast<std::uint8_t>(value >> shift & 0xFF));
}

std::string data_of(const Captured& piece) {
  std::string data;
  if (piece.carrier == CaptureCarrier::kCan) {
    put_be32(data, piece.can_id | (piece.extended ? 0x8000'0000U : 0U));
    put_u8(data, static_cast<std::uint8_t>(piece.bytes.size()));
    put_u8(data, static_cast<std::uint8_t>((piece.fd ? 0x04 : 0) | (piece.bitrate_switch ? 0x01 : 0)));
    put_u16(data, 0);
  }
  return data.append(piece.bytes.begin(), piece.bytes.end());
}

// Numbers in the order that the section's header says.
struct FileWords {
  std::string_view bytes;
  bool big = false;
  std::uint32_t u32(std::size_t at) const { return u16(at + (big ? 2 : 0)) | u16(at + (big ? 0 : 2)) << 16; }
  std::uint32_t u16(std::size_t at) const {
    const auto byte = [&](std::size_t i) {
      return static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[i]));
    };
    return big ? byte(at) << 8 | byte(at + 1) : byte(at) | byte(at + 1) << 8;
  }
};

CaptureWay way_of(const FileWords& words, std::size_t at, std::size_t end) {
  while (at + 4 <= end) {
    const std::uint32_t code = words.u16(at), length = words.u16(at + 2);
    if (code == kEnd || at + 4 + length > end) break;
    if (code == kFlags && length == 4) {
      const std::uint32_t way = words.u32(at + 4) & 3;
      if (way == kOutbound) return CaptureWay::kFromHost;
      if (way == kInbound) return CaptureWay::kToHost;
    }
    at += 4 + (length + 3) / 4 * 4;
  }
  return CaptureWay::kUnknown;
}

}  // namespace

std::string write_pcapng(std::span<const Captured> pieces, const std::string& program) {
  const bool can = !pieces.empty() && pieces.front().carrier == CaptureCarrier::kCan;
  if (can) check_can_pieces(pieces);
  std::string out, body;
  put_u32(body, kByteOrder);
  put_u16(body, 1);  // version 1.0
  put_u16(body, 0);
  put_u64(body, ~std::uint64_t{0});  // length of the section: not said
  put_option(body, kUserProgram, program);
  put_option(body, kEnd, "");
  put_block(out, kSection, body);
  body.clear();
  put_u16(body, can ? kLinkSocketCan : kLinkUser0);
  put_u16(body, 0);
  put_u32(body, 0);                       // packets are not cut
  put_option(body, kResolution, "\x09");  // 10^-9 s
  put_option(body, kEnd, "");
  put_block(out, kInterface, body);
  for (const Captured& piece : pieces) {
    if (piece.carrier != (can ? CaptureCarrier::kCan : CaptureCarrier::kSerial) || piece.at_ns < 0)
      throw BadCapture("a piece of another carrier than the first, or before time 0");
    const std::string data = data_of(piece);
    body.clear();
    put_u32(body, 0);  // the interface
    put_u32(body, static_cast<std::uint32_t>(static_cast<std::uint64_t>(piece.at_ns) >> 32));
    put_u32(body, static_cast<std::uint32_t>(piece.at_ns & 0xFFFF'FFFF));
    put_u32(body, static_cast<std::uint32_t>(data.size()));
    put_u32(body, static_cast<std::uint32_t>(data.size()));
    body += data;
    pad(body);
    if (piece.way != CaptureWay::kUnknown) {
      std::string flags;
      put_u32(flags, piece.way == CaptureWay::kFromHost ? kOutbound : kInbound);
      put_option(body, kFlags, flags);
      put_option(body, kEnd, "");
    }
    put_block(out, kPacket, body);
  }
  return out;
}

std::vector<CaptureWay> pcapng_ways(std::string_view bytes) {
  std::vector<CaptureWay> ways;
  FileWords words{bytes};
  if (bytes.size() < 28 || words.u32(0) != kSection) return ways;
  for (std::size_t at = 0; at + 12 <= bytes.size();) {
    if (words.u32(at) == kSection)
      words.big = words.u32(at + 8) != kByteOrder && FileWords{bytes, !words.big}.u32(at + 8) == kByteOrder
                      ? !words.big
                      : words.big;
    const std::uint32_t length = words.u32(at + 4);
    if (length < 12 || length % 4 != 0 || at + length > bytes.size()) break;
    const std::uint32_t type = words.u32(at);
    if (type == kSimplePacket) ways.push_back(CaptureWay::kUnknown);
    if ((type == kPacket || type == kOldPacket) && length >= 32) {
      const std::size_t data = (static_cast<std::size_t>(words.u32(at + 20)) + 3) / 4 * 4;
      ways.push_back(way_of(words, at + 28 + data, at + length - 4));
    }
    at += length;
  }
  return ways;
}

}  // namespace omnihil
