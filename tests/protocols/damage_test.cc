// Every golden packet cut at each byte and with each single bit flipped.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <optional>

#include "protocols/codec.h"
#include "protocols/plain_packet.h"
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

// Packets without a type are told by their length alone: what is as long is one, whatever it was cut from.
bool is_told_by_length(const DecodeResult& result) {
  return result.error == PacketError::kNone &&
         std::ranges::none_of(result.values.message->fields,
                              [](const Field& field) { return field.kind == FieldKind::kType; });
}

TEST(DamagedPacket, CutAtEachByteIsRefusedWithACause) {
  std::map<const RadioFormat*, PacketCounts> counts;
  std::map<const RadioFormat*, std::uint64_t> by_length;
  for (const GoldenPacket& packet : golden_packets()) {
    for (std::size_t size = 0; size < packet.frame.size(); ++size) {
      const DecodeResult result = packet.format->decode(std::span(packet.frame).first(size));
      if (is_told_by_length(result)) {
        EXPECT_EQ(static_cast<std::size_t>(result.values.message->size_bytes), size);
        ++by_length[packet.format];
      } else {
        EXPECT_NE(result.error, PacketError::kNone) << to_hex(packet.frame) << " cut to " << size;
      }
      counts[packet.format].count(result.error);
    }
  }
  for (const auto& [format, count] : counts) {
    EXPECT_EQ(count.good, by_length[format]);
    EXPECT_TRUE(count.good == 0 || format->id == "robojackets-2024") << format->id;
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

// What one flipped bit does to the field that owns it, by the table.
enum class Fate : std::uint8_t { kRefused, kChangesItsField, kEither };

Fate fate_of(const GoldenPacket& packet, const Field* owner, const Bytes& flipped) {
  if (owner == nullptr) return Fate::kChangesItsField;  // a letter of the text
  const std::uint64_t raw = read_bits(flipped, owner->bit, owner->bits, packet.message->bit_order);
  const double number = field_number(*owner, raw);
  const bool limited = owner->lo != owner->hi;
  switch (owner->kind) {
    case FieldKind::kConst:
    case FieldKind::kLength:
    case FieldKind::kChecksum:
      return Fate::kRefused;
    case FieldKind::kType: {  // the type of a packet as long is that packet
      const auto as_long = [&](const Message& other) {
        return has_type_of(other, flipped) &&
               (other.text_tail || other.size_bytes == packet.message->size_bytes);
      };
      const bool may_be =
          std::any_of(packet.format->messages.begin(), packet.format->messages.end(), as_long);
      return may_be ? Fate::kEither : Fate::kRefused;
    }
    case FieldKind::kFloat32:
      if (!std::isfinite(number)) return Fate::kRefused;
      [[fallthrough]];
    case FieldKind::kInteger:
      return limited && (number < owner->lo || number > owner->hi) ? Fate::kRefused : Fate::kChangesItsField;
    case FieldKind::kRanged32:
    case FieldKind::kScaled:
    case FieldKind::kReserved:
      return Fate::kChangesItsField;
  }
  return Fate::kRefused;
}

void expect_owner_alone_changed(const GoldenPacket& packet, const Field* owner, const DecodeResult& result) {
  const DecodeResult before = packet.format->decode(packet.frame);
  ASSERT_EQ(result.values.message, packet.message);
  EXPECT_EQ(result.values.text != before.values.text, owner == nullptr);
  for (std::size_t i = 0; i < packet.message->fields.size(); ++i) {
    const bool changed = result.values.fields[i].raw != before.values.fields[i].raw;
    EXPECT_EQ(changed, &packet.message->fields[i] == owner) << packet.message->fields[i].name;
  }
}

bool has_checksum(const Message& message) {
  return std::any_of(message.fields.begin(), message.fields.end(),
                     [](const Field& field) { return field.kind == FieldKind::kChecksum; });
}

void expect_fate(const GoldenPacket& packet, std::size_t byte, int bit, PacketCounts& counts) {
  SCOPED_TRACE(to_hex(packet.frame) + " byte " + std::to_string(byte) + " bit " + std::to_string(bit));
  Bytes frame = packet.frame;
  frame[byte] = static_cast<std::uint8_t>(frame[byte] ^ (1u << bit));
  const DecodeResult result = packet.format->decode(frame);
  counts.count(result.error);
  const Field* owner = owner_of(*packet.message, byte, bit);
  const Fate fate = fate_of(packet, owner, frame);
  const bool refused = result.error != PacketError::kNone;
  if (fate == Fate::kRefused || (fate == Fate::kEither && refused)) {
    EXPECT_TRUE(refused);
  } else if (fate == Fate::kEither) {
    EXPECT_NE(result.values.message, packet.message);
  } else if (!refused) {
    expect_owner_alone_changed(packet, owner, result);
  } else {
    EXPECT_TRUE(has_checksum(*packet.message)) << to_string(result.error);
  }
}

// A sum or CRC sees every single flipped bit of what it is taken over; what it is not taken over, and all of a
// packet that has none, is refused by its field's own rule or changes that field and nothing else.
TEST(DamagedPacket, UnframedWithOneFlippedBitIsRefusedOrChangesTheFieldThatOwnsIt) {
  for (const RadioFormat* format : radio_formats()) {
    if (format->framing != Framing::kNone) {
      std::printf("%s: left out, a bit of its frame is no bit of a field\n", std::string(format->id).c_str());
      continue;
    }
    PacketCounts counts;
    std::uint64_t flips = 0;
    for (const GoldenPacket& packet : golden_packets()) {
      if (packet.format != format) continue;
      flips += 8 * packet.frame.size();
      for (std::size_t byte = 0; byte < packet.frame.size(); ++byte) {
        for (int bit = 0; bit < 8; ++bit) expect_fate(packet, byte, bit, counts);
      }
    }
    EXPECT_EQ(counts.good + counts.refused(), flips) << format->id;
    EXPECT_GT(flips, 0u) << format->id;
    print_counts("one bit flipped", *format, counts);
  }
}

// A second, plain decoder of COBS: the packet behind the frame, or nothing.
std::optional<Bytes> unstuffed(const Bytes& frame) {
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
  const std::optional<Bytes> packet = unstuffed(frame);
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

// ER-Force: an exclusive or sees every change of one byte, but not two equal bytes: a flipped code in a run of zeros
// (01 01 01 to 03 01 01) puts 01 01 in their place, and that slips. What is accepted is what a second decoder lets
// through as well; of that, only a packet's kind or its prescribed zeros refuse more.
TEST(DamagedPacket, WithXor8OneFlippedBitSlipsOnlyInACobsCodeWhereTheSumStays) {
  for (const char* id : {"erforce-proto2025", "erforce-proto2025-bridge"}) {
    const RadioFormat& format = *find_radio_format(id);
    PacketCounts counts;
    std::uint64_t in_codes = 0, sum_stays = 0, flips = 0;
    for (const GoldenPacket& packet : golden_packets()) {
      if (packet.format != &format) continue;
      const std::vector<bool> codes = codes_of(packet.frame);
      for (std::size_t byte = 0; byte < packet.frame.size(); ++byte) {
        for (int bit = 0; bit < 8; ++bit, ++flips) {
          Bytes frame = packet.frame;
          frame[byte] = static_cast<std::uint8_t>(frame[byte] ^ (1u << bit));
          const PacketError error = format.decode(frame).error;
          counts.count(error);
          in_codes += codes[byte] ? 1u : 0u;
          const std::optional<Bytes> bytes = unstuffed(frame);
          std::uint8_t sum = 0;
          for (const std::uint8_t each : bytes.value_or(Bytes{1})) sum ^= each;
          const bool fits =
              bytes && sum == 0 && bytes->size() + 2 == static_cast<std::size_t>(format.max_frame_bytes);
          sum_stays += fits ? 1u : 0u;
          EXPECT_FALSE(fits && !codes[byte]) << to_hex(frame);
          EXPECT_TRUE(fits || error != PacketError::kNone) << to_hex(frame);
          EXPECT_TRUE(!fits || error == PacketError::kNone || error == PacketError::kUnknownType ||
                      error == PacketError::kConstant)
              << to_hex(frame);
        }
      }
    }
    EXPECT_EQ(counts.good + counts.refused(), flips) << id;
    EXPECT_GT(sum_stays, 0u) << "there are runs of zeros";
    print_counts("one bit flipped", format, counts);
    std::printf("%s: %llu of the flips hit a COBS code, %llu leave the sum as it is\n", id,
                static_cast<unsigned long long>(in_codes), static_cast<unsigned long long>(sum_stays));
  }
}

}  // namespace
}  // namespace omnihil
