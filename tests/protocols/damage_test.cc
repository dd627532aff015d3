// Every golden packet cut at each byte and with each single bit flipped.
#include <array>
#include <cstdio>
#include <map>
#include <optional>

#include "tests/protocols/packet_util.h"

namespace omnihil {
namespace {

void print_counts(const char* what, const RadioFormat& format, const PacketCounts& counts) {
  std::printf("%s, %s: %llu accepted, %llu refused:", std::string(format.id).c_str(), what,
              static_cast<unsigned long long>(counts.good),
              static_cast<unsigned long long>(counts.refused()));
  for (std::size_t i = 0; i < counts.bad.size(); ++i) {
    if (counts.bad[i] == 0) continue;
    std::printf(" %llu %s,", static_cast<unsigned long long>(counts.bad[i]),
                std::string(to_string(static_cast<PacketError>(i))).c_str());
  }
  std::printf("\n");
}

TEST(DamagedPacket, CutAtEachByteIsRefusedWithACause) {
  std::map<const RadioFormat*, PacketCounts> counts;
  for (const GoldenPacket& packet : golden_packets()) {
    for (std::size_t size = 0; size < packet.frame.size(); ++size) {
      const DecodeResult result = packet.format->decode(std::span(packet.frame).first(size));
      EXPECT_NE(result.error, PacketError::kNone) << to_hex(packet.frame) << " cut to " << size;
      counts[packet.format].count(result.error);
    }
  }
  for (const auto& [format, count] : counts) {
    EXPECT_EQ(count.good, 0u);
    print_counts("cut", *format, count);
  }
}

TEST(DamagedPacket, OneByteMoreIsRefusedWithACause) {
  for (const GoldenPacket& packet : golden_packets()) {
    for (int byte = 0; byte < 256; ++byte) {
      Bytes frame = packet.frame;
      frame.push_back(static_cast<std::uint8_t>(byte));
      EXPECT_NE(packet.format->decode(frame).error, PacketError::kNone) << to_hex(frame);
    }
  }
}

const Field* owner_of(const Message& message, std::size_t byte, int bit_of_byte) {
  const int in_order = message.bit_order == BitOrder::kMsbFirst ? 7 - bit_of_byte : bit_of_byte;
  const int bit = 8 * static_cast<int>(byte) + in_order;
  for (const Field& field : message.fields) {
    if (bit >= field.bit && bit < field.bit + field.bits) return &field;
  }
  return nullptr;
}

// A format without framing and checksum: a bit of type, version or length is refused, any other changes
// its field and nothing else.
void expect_owner_alone_changes(const GoldenPacket& packet, std::size_t byte, int bit, PacketCounts& counts) {
  Bytes frame = packet.frame;
  frame[byte] = static_cast<std::uint8_t>(frame[byte] ^ (1u << bit));
  const DecodeResult result = packet.format->decode(frame);
  counts.count(result.error);
  const Field* owner = owner_of(*packet.message, byte, bit);
  const bool prescribed =
      owner != nullptr && (owner->kind == FieldKind::kType || owner->kind == FieldKind::kConst ||
                           owner->kind == FieldKind::kLength);
  ASSERT_EQ(result.error != PacketError::kNone, prescribed)
      << to_hex(frame) << " byte " << byte << " bit " << bit;
  if (prescribed) return;
  const DecodeResult before = packet.format->decode(packet.frame);
  ASSERT_EQ(result.values.message, packet.message);
  EXPECT_EQ(result.values.text != before.values.text, owner == nullptr);
  for (std::size_t i = 0; i < packet.message->fields.size(); ++i) {
    const bool changed = result.values.fields[i].raw != before.values.fields[i].raw;
    EXPECT_EQ(changed, &packet.message->fields[i] == owner)
        << to_hex(frame) << " " << packet.message->fields[i].name;
  }
}

TEST(DamagedPacket, WithoutChecksumOneFlippedBitIsRefusedOrChangesTheFieldThatOwnsIt) {
  for (const RadioFormat* format : radio_formats()) {
    if (format->framing != Framing::kNone) continue;
    PacketCounts counts;
    for (const GoldenPacket& packet : golden_packets()) {
      if (packet.format != format) continue;
      for (std::size_t byte = 0; byte < packet.frame.size(); ++byte) {
        for (int bit = 0; bit < 8; ++bit) expect_owner_alone_changes(packet, byte, bit, counts);
      }
    }
    EXPECT_GT(counts.good, 0u);
    print_counts("one bit flipped", *format, counts);
  }
}

// A second, plain HERMES decoder: the packet behind the frame, or nothing.
std::optional<Bytes> hermes_packet(const Bytes& frame) {
  if (frame.size() < 2 || frame.back() != 0) return std::nullopt;
  Bytes packet;
  std::size_t next_code = 0;
  for (std::size_t i = 0; i + 1 < frame.size(); ++i) {
    if (frame[i] == 0) return std::nullopt;
    if (i == next_code) {
      if (i > 0) packet.push_back(0);
      next_code = i + frame[i];
    } else {
      packet.push_back(frame[i]);
    }
  }
  if (next_code + 1 != frame.size()) return std::nullopt;
  return packet;
}

bool hermes_accepts(const Bytes& frame) {
  constexpr std::array<std::size_t, 10> kSizes{5, 5, 17, 7, 21, 5, 6, 5, 9, 19};
  const std::optional<Bytes> packet = hermes_packet(frame);
  if (!packet || packet->size() < 5 || packet->at(0) != 1 || packet->at(3) >= kSizes.size()) return false;
  const std::size_t type = packet->at(3);
  if (packet->size() != kSizes[type]) return false;
  unsigned sum = 0;
  for (std::uint8_t byte : *packet) sum += byte;
  if ((sum - packet->at(4)) % 256 != packet->at(4)) return false;
  const bool answer = type == 1 || type == 6 || type == 8;
  if (answer ? packet->at(2) != 0 : packet->at(1) != 0xFE) return false;
  const std::size_t floats = type == 4 ? 4 : type == 2 || type == 9 ? 3 : 0;
  for (std::size_t i = 0; i < floats; ++i) {
    const unsigned high = packet->at(5 + 4 * i + 3) & 0x7Fu;
    if (high == 0x7F && (packet->at(5 + 4 * i + 2) & 0x80u) != 0) return false;  // exponent of ones
  }
  return true;
}

// Which bytes of the frame are COBS codes.
std::vector<bool> codes_of(const Bytes& frame) {
  std::vector<bool> codes(frame.size());
  for (std::size_t at = 0; at + 1 < frame.size(); at += frame[at]) codes[at] = true;
  return codes;
}

// HERMES: a flipped bit of a data byte changes one byte by a power of two, and sum8 sees every change of one
// byte; a flipped bit of the delimiter leaves none; only a flipped COBS code, which moves zeros about, could
// leave the sum as it is.
TEST(DamagedPacket, WithSum8OneFlippedBitCanOnlySlipInACobsCode) {
  const RadioFormat& format = *find_radio_format("ulaval-hermes");
  PacketCounts counts;
  std::uint64_t in_codes = 0;
  std::uint64_t slipped = 0;
  for (const GoldenPacket& packet : golden_packets()) {
    if (packet.format != &format) continue;
    ASSERT_TRUE(hermes_accepts(packet.frame));
    const std::vector<bool> codes = codes_of(packet.frame);
    for (std::size_t byte = 0; byte < packet.frame.size(); ++byte) {
      for (int bit = 0; bit < 8; ++bit) {
        Bytes frame = packet.frame;
        frame[byte] = static_cast<std::uint8_t>(frame[byte] ^ (1u << bit));
        const DecodeResult result = format.decode(frame);
        counts.count(result.error);
        in_codes += codes[byte] ? 1u : 0u;
        slipped += result.error == PacketError::kNone ? 1u : 0u;
        EXPECT_EQ(result.error == PacketError::kNone, hermes_accepts(frame)) << to_hex(frame);
        EXPECT_TRUE(result.error != PacketError::kNone || codes[byte]) << to_hex(frame);
      }
    }
  }
  print_counts("one bit flipped", format, counts);
  std::printf("ulaval-hermes: %llu of the flips hit a COBS code, %llu slipped\n",
              static_cast<unsigned long long>(in_codes), static_cast<unsigned long long>(slipped));
  EXPECT_EQ(slipped, 0u);
}

}  // namespace
}  // namespace omnihil
