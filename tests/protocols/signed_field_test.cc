// Signed and scaled integers, types in several fields, lengths that leave a header out, checksums by a rule.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "firmware_iface/checksum.h"
#include "protocols/codec.h"
#include "protocols/field_rows.h"
#include "protocols/plain_packet.h"

namespace omnihil {
namespace {

using Bytes = std::vector<std::uint8_t>;

// A packet of a type byte, one field, and zeros up to whole bytes.
struct OneField {
  std::array<Field, 3> fields;
  Message message;
  explicit OneField(Field field, BitOrder order = BitOrder::kMsbFirst) {
    const int rest = (8 - field.bits % 8) % 8;
    fields = in_order(std::array{type_code("type", 8), field, padding(rest == 0 ? 8 : rest)});
    message.name = "one";
    message.type = 7;
    message.bit_order = order;
    message.size_bytes = (8 + field.bits + (rest == 0 ? 8 : rest)) / 8;
    message.fields = fields;
  }
  PacketError encode(double number, Bytes& out) const {
    Values values;
    values.message = &message;
    values.fields[1].number = number;
    out.clear();
    return encode_packet(values, out).error;
  }
  PacketError encode(double number) const {
    Bytes out;
    return encode(number, out);
  }
  double decode(const Bytes& bytes) const {
    const DecodeResult result = decode_packet(std::span(&message, 1), bytes);
    EXPECT_EQ(result.error, PacketError::kNone);
    return result.values.fields[1].number;
  }
};

TEST(SignedField, TwosComplementCarriesItsWidthAndNoMore) {
  for (const BitOrder order : {BitOrder::kMsbFirst, BitOrder::kLsbFirst}) {
    for (const int bits : {2, 5, 8, 13, 16, 32, 53}) {
      const OneField one(signed_number("n", bits, "", ""), order);
      const double end = std::ldexp(1.0, bits - 1);
      Bytes bytes;
      for (const double number : {-end, -1.0, 0.0, 1.0, end - 1.0}) {
        ASSERT_EQ(one.encode(number, bytes), PacketError::kNone) << bits << " " << number;
        EXPECT_EQ(one.decode(bytes), number) << bits;
      }
      for (const double bad : {-end - 1.0, end, 0.5}) EXPECT_EQ(one.encode(bad), PacketError::kRange) << bits;
      EXPECT_EQ(one.encode(std::numeric_limits<double>::quiet_NaN()), PacketError::kNotFinite);
    }
  }
}

TEST(SignedField, BytesAreThoseOfTwosComplementInEitherOrder) {
  Bytes bytes;
  OneField(signed_number("n", 16, "", "")).encode(-2.0, bytes);
  EXPECT_EQ(bytes, (Bytes{7, 0xFF, 0xFE, 0}));
  OneField(signed_number("n", 16, "", ""), BitOrder::kLsbFirst).encode(-32768.0, bytes);
  EXPECT_EQ(bytes, (Bytes{7, 0x00, 0x80, 0}));
  OneField(signed_number("n", 12, "", "")).encode(-1.0, bytes);
  EXPECT_EQ(bytes, (Bytes{7, 0xFF, 0xF0}));
}

TEST(SignedField, SignAndMagnitudeKeepsBothZeros) {
  const OneField one(sign_and_magnitude("n", 10, "", ""));
  Bytes bytes;
  ASSERT_EQ(one.encode(-511.0, bytes), PacketError::kNone);
  EXPECT_EQ(bytes, (Bytes{7, 0xFF, 0xC0}));
  ASSERT_EQ(one.encode(5.0, bytes), PacketError::kNone);
  EXPECT_EQ(bytes, (Bytes{7, 0x01, 0x40}));
  for (const double bad : {-512.0, 512.0}) EXPECT_EQ(one.encode(bad), PacketError::kRange);
  const DecodeResult minus_zero = decode_packet(std::span(&one.message, 1), Bytes{7, 0x80, 0x00});
  EXPECT_EQ(minus_zero.values.fields[1].number, 0.0);
  Bytes again;
  encode_packet(minus_zero.values, again);
  EXPECT_EQ(again, (Bytes{7, 0x80, 0x00}));
}

TEST(SignedField, LimitsHoldBothWays) {
  const OneField one(signed_number("n", 8, "", "", -3, 2));
  Bytes bytes;
  for (int number = -128; number < 128; ++number) {
    const bool inside = number >= -3 && number <= 2;
    EXPECT_EQ(one.encode(number), inside ? PacketError::kNone : PacketError::kRange) << number;
    const Bytes packet{7, static_cast<std::uint8_t>(number), 0};
    EXPECT_EQ(decode_packet(std::span(&one.message, 1), packet).error,
              inside ? PacketError::kNone : PacketError::kRange)
        << number;
  }
}

// Quarters in two's complement, cut towards zero.
constexpr ScaleRule kQuarters{
    .name = "quarters",
    .says = "count = trunc(4 x)",
    .number = [](const Field&, std::int64_t count) { return static_cast<double>(count) / 4.0; },
    .count = [](const Field&, double number) { return static_cast<std::int64_t>(4.0 * number); }};
constexpr ScaleRule kClampedQuarters{kQuarters.name, kQuarters.says, kQuarters.number, kQuarters.count,
                                     Beyond::kClamped};

TEST(ScaledField, GoesByItsRule) {
  const OneField one(scaled("x", 8, Sign::kTwosComplement, kQuarters, -32.0, 31.75, "m", ""));
  Bytes bytes;
  ASSERT_EQ(one.encode(-1.9, bytes), PacketError::kNone);
  EXPECT_EQ(bytes, (Bytes{7, 0xF9, 0}));
  EXPECT_EQ(one.decode(bytes), -1.75);
  EXPECT_EQ(field_step(one.fields[1]), 0.25);
  EXPECT_EQ(one.encode(32.0), PacketError::kRange);
  EXPECT_EQ(one.encode(std::numeric_limits<double>::infinity()), PacketError::kNotFinite);
}

TEST(ScaledField, BeyondTheEndsIsTheEndWhereTheTeamClamps) {
  const OneField one(scaled("x", 8, Sign::kTwosComplement, kClampedQuarters, -32.0, 31.75, "m", ""));
  Bytes bytes;
  ASSERT_EQ(one.encode(-900.0, bytes), PacketError::kNone);
  EXPECT_EQ(one.decode(bytes), -32.0);
  ASSERT_EQ(one.encode(900.0, bytes), PacketError::kNone);
  EXPECT_EQ(one.decode(bytes), 31.75);
  EXPECT_EQ(one.encode(std::numeric_limits<double>::quiet_NaN()), PacketError::kNotFinite);
}

TEST(NearestValue, IsWithinWhatTheFieldCarries) {
  const auto nearest = [](const Field& field, double number) { return nearest_value(field, number).number; };
  EXPECT_EQ(nearest(signed_number("n", 8, "", ""), -1000.0), -128.0);
  EXPECT_EQ(nearest(signed_number("n", 8, "", ""), -1.5), -2.0);
  EXPECT_EQ(nearest(sign_and_magnitude("n", 8, "", ""), -1000.0), -127.0);
  EXPECT_EQ(nearest(number("n", 8, "", ""), 1000.0), 255.0);
  EXPECT_EQ(nearest(number("n", 8, "", ""), std::numeric_limits<double>::quiet_NaN()), 0.0);
  EXPECT_EQ(nearest(scaled("x", 8, Sign::kTwosComplement, kQuarters, -3.0, 4.0, "", ""), 9.0), 4.0);
  EXPECT_EQ(nearest(float32("x", "", ""), -1e300), -std::numeric_limits<float>::max());
}

// Type 0102h in two fields, the length without the first four bytes, CRC-32 behind them.
constexpr ChecksumRule kCrcOfTheRest{.kind = &kCrc32, .from = 4};
constexpr auto kFields =
    in_order(std::array{checksum("crc", 32, "", &kCrcOfTheRest), type_code_bits("group", 8, 8, ""),
                        length("size", 8, "", 4), type_code_bits("kind", 8, 0, ""), number("n", 8, "", "")});
constexpr std::array kMessages{
    Message{"two", 0x0102, 8, false, Direction::kBoth, BitOrder::kLsbFirst, kFields, ""}};
static_assert(all_tiled(kMessages));

TEST(PlainPacket, TypeLengthAndChecksumAreFilledIn) {
  Values values;
  values.message = &kMessages[0];
  values.set("n", 5);
  Bytes bytes;
  ASSERT_EQ(encode_packet(values, bytes).error, PacketError::kNone);
  const Bytes rest{1, 4, 2, 5};
  EXPECT_EQ(Bytes(bytes.begin() + 4, bytes.end()), rest);
  EXPECT_EQ(read_bits(bytes, 0, 32, BitOrder::kLsbFirst), crc32(rest));
  values.set("crc", crc32(rest));
  EXPECT_EQ(encode_packet(values, bytes).error, PacketError::kNone);
  values.set("crc", 1.0 + crc32(rest));
  EXPECT_EQ(encode_packet(values, bytes).error, PacketError::kChecksum);
  EXPECT_EQ(bytes.size(), 16u) << "a refused packet appends nothing";
}

TEST(PlainPacket, EachFaultHasItsCause) {
  Values values;
  values.message = &kMessages[0];
  Bytes good;
  encode_packet(values, good);
  const auto fault = [](Bytes bytes) { return decode_packet(kMessages, bytes).error; };
  EXPECT_EQ(fault(good), PacketError::kNone);
  for (std::size_t byte = 0; byte < good.size(); ++byte) {
    Bytes bad = good;
    bad[byte] ^= 0x40;
    const bool is_type = byte == 4 || byte == 6;
    EXPECT_EQ(fault(bad), is_type ? PacketError::kUnknownType : PacketError::kChecksum) << byte;
  }
  EXPECT_EQ(fault(Bytes(good.begin(), good.begin() + 6)), PacketError::kTooShort);
  EXPECT_EQ(fault(Bytes(good.begin(), good.begin() + 7)), PacketError::kTooShort);
  good.push_back(0);
  EXPECT_EQ(fault(good), PacketError::kTooLong);
}

// "123456789" is the usual check of a CRC.
TEST(Crc, GivesTheCataloguesCheckValues) {
  const std::array<std::uint8_t, 9> check{'1', '2', '3', '4', '5', '6', '7', '8', '9'};
  EXPECT_EQ(crc32(check), 0xCBF43926u);
  EXPECT_EQ(crc16_xmodem(check), 0x31C3u);
  EXPECT_EQ(crc8_maxim(check), 0xA1u);
  EXPECT_EQ(crc8_autosar(check), 0xDFu);
  EXPECT_EQ(xor8(check), 0x31u);
}

}  // namespace
}  // namespace omnihil
