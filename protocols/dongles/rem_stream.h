// Cuts the bytes a host writes to a RoboTeam base station into packets.
//
//   stream.feed(bytes, now_ns, [&](std::span<const std::uint8_t> packet, const Values& values) { … });
//
// The wire has no framing: byte 0 says the type, the type says the length, the next packet follows. The base
// station takes each USB transfer by itself and throws all of it away from the first packet on that has a
// wrong version, an unknown type or another length than its type (Basestation 0bb0bf9, handlePackets). A
// pseudo-terminal has no transfers, so here (docs/dongles.md, "REM on the USB side"):
//   - a transfer is what arrives within 1 ms (one USB frame) of its first byte; after a bad packet the rest
//     of that millisecond is thrown away;
//   - a half packet waits up to 5 ms for its rest, then it is dropped as too short.
// So the same bytes at the same times give the same packets, however they are cut into calls.
#pragma once
#include <array>
#include <cstdint>
#include <limits>
#include <span>

#include "protocols/radio_format.h"

namespace omnihil {

class RemStream {
 public:
  static constexpr std::int64_t kTransfer_ns = 1'000'000;
  static constexpr std::int64_t kHalfPacket_ns = 5'000'000;

  RemStream(const RadioFormat& format, PacketCounts& counts);

  // Calls on_packet(bytes, values) for each good packet. Refused ones are counted here.
  template <class OnPacket>
  void feed(std::span<const std::uint8_t> bytes, std::int64_t now_ns, OnPacket&& on_packet) {
    expire(now_ns);
    begin_transfer(now_ns);
    while (!bytes.empty() && !discarding_) {
      bytes = take(bytes);
      if (fill_ < wanted_) break;
      if (!header_is_good() || fill_ < wanted_) continue;
      const std::span<const std::uint8_t> packet = std::span(buffer_).first(fill_);
      fill_ = 0;
      wanted_ = 1;
      const DecodeResult result = format_.decode(packet);
      if (result.error == PacketError::kNone) {
        on_packet(packet, result.values);
      } else {
        refuse(result.error);
      }
    }
    last_byte_ns_ = now_ns;
  }

  // Length of the good packet at the front: its header's last byte.
  std::size_t packet_bytes(std::span<const std::uint8_t> packet) const { return packet[header_bytes_ - 1]; }

  // The same of bytes that nobody has looked at: all of them, where the front says no length that they have.
  std::size_t first_packet_bytes(std::span<const std::uint8_t> bytes) const {
    const std::size_t said = bytes.size() < header_bytes_ ? 0 : packet_bytes(bytes);
    return said == 0 || said > bytes.size() ? bytes.size() : said;
  }

  void expire(std::int64_t now_ns);  // gives up a half packet whose rest did not come in time
  void close();                      // the host is gone: a half packet is dropped and counted

  // The cause of the latest refusal that cost a transfer, and then none until the next one.
  PacketError take_refusal();

 private:
  void begin_transfer(std::int64_t now_ns);
  std::span<const std::uint8_t> take(std::span<const std::uint8_t> bytes);
  bool header_is_good();  // false: the rest of the transfer is lost, or more bytes are wanted first
  void refuse(PacketError error);

  const RadioFormat& format_;
  PacketCounts& counts_;
  std::size_t header_bytes_ = 0;
  std::uint8_t version_ = 0;
  std::uint8_t filler_type_ = 0;
  std::size_t filler_bytes_ = 0;
  std::array<std::uint8_t, 256> buffer_{};
  std::size_t fill_ = 0;
  std::size_t wanted_ = 1;  // bytes needed before the next decision
  bool discarding_ = false;
  PacketError refusal_ = PacketError::kNone;
  std::int64_t transfer_end_ns_ = std::numeric_limits<std::int64_t>::min();
  std::int64_t last_byte_ns_ = 0;
};

}  // namespace omnihil
