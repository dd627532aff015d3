#include "protocols/codec.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>

#include "protocols/field_rows.h"
#include "protocols/radio_format.h"

namespace omnihil {
namespace {

constexpr double kPi = 3.141592653589793;

TEST(Bits, MsbFirstRunsOnAcrossBytesFromTheHighestBit) {
  const std::array<std::uint8_t, 3> bytes{0b1010'0001, 0b1000'0000, 0xFF};
  EXPECT_EQ(read_bits(bytes, 0, 4, BitOrder::kMsbFirst), 0b1010u);
  EXPECT_EQ(read_bits(bytes, 7, 2, BitOrder::kMsbFirst), 0b11u);
  EXPECT_EQ(read_bits(bytes, 0, 24, BitOrder::kMsbFirst), 0xA180FFu);
}

TEST(Bits, LsbFirstRunsUpwardFromTheLowestBit) {
  const std::array<std::uint8_t, 3> bytes{0b1010'0001, 0b1000'0000, 0xFF};
  EXPECT_EQ(read_bits(bytes, 0, 4, BitOrder::kLsbFirst), 0b0001u);
  EXPECT_EQ(read_bits(bytes, 7, 2, BitOrder::kLsbFirst), 0b01u);
  EXPECT_EQ(read_bits(bytes, 0, 24, BitOrder::kLsbFirst), 0xFF80A1u);
}

TEST(Bits, WrittenBitsAreReadBackAndTheOthersStay) {
  for (BitOrder order : {BitOrder::kMsbFirst, BitOrder::kLsbFirst}) {
    for (int bit = 0; bit < 24; ++bit) {
      for (int bits = 1; bits <= 64; ++bits) {
        std::array<std::uint8_t, 12> bytes{};
        bytes.fill(0xFF);
        const std::uint64_t raw = 0x123456789ABCDEF1ull & (bits == 64 ? ~0ull : (1ull << bits) - 1);
        write_bits(bytes, bit, bits, order, raw);
        ASSERT_EQ(read_bits(bytes, bit, bits, order), raw);
        write_bits(bytes, bit, bits, order, ~0ull);
        for (std::uint8_t byte : bytes) ASSERT_EQ(byte, 0xFF);
      }
    }
  }
}

// The rule as RoboTeam's generator has it: print the scale with 16 decimals, read it as a float32 literal.
float printed_scale(double lo, double hi, int bits) {
  char literal[64];
  std::snprintf(literal, sizeof literal, "%.16f", (hi - lo) / (std::ldexp(1.0, bits) - 1.0));
  return std::strtof(literal, nullptr);
}

TEST(RangedField, ScaleOfEveryTableRowIsThePrintedLiteral) {
  int rows = 0;
  for (const RadioFormat* format : radio_formats()) {
    for (const Message& message : format->messages) {
      for (const Field& field : message.fields) {
        if (field.kind != FieldKind::kRanged32) continue;
        EXPECT_EQ(ranged_scale(field), printed_scale(field.lo, field.hi, field.bits)) << field.name;
        ++rows;
      }
    }
  }
  EXPECT_GT(rows, 150);
}

TEST(RangedField, LargestDecodedValueIsWithinOneRoundingOfTheUpperEnd) {
  const Field field = ranged("x", 16, -kPi, kPi, "rad", "");
  EXPECT_EQ(ranged_value(field, 0), static_cast<float>(-kPi));
  EXPECT_NEAR(ranged_value(field, 65535), kPi, 1e-6);
}

TEST(RangedField, TruncatesInFloat32AsTheTeamDoes) {
  // 0 rad lies half a count above 7FFFh and is cut down to it: -scale / 2 comes back.
  const Field angle = ranged("theta", 16, -kPi, kPi, "rad", "");
  EXPECT_EQ(ranged_raw(angle, 0.0F), 0x7FFFu);
  EXPECT_FLOAT_EQ(ranged_value(angle, 0x7FFF), -4.79221344e-05F);
  // 8 m/s is the largest value, yet 8 / 0.0313725490196078F is a little below 255 in float32.
  const Field kick = ranged("kickChipPower", 8, 0.0, 8.0, "m/s", "");
  EXPECT_EQ(ranged_raw(kick, 8.0F), 0xFEu);
}

TEST(RangedField, A32BitFieldAtItsUpperEndWrapsToZeroAsTheTeamsDoes) {
  const Field yaw = ranged("xsensYaw", 32, -50000.0, 50000.0, "rad", "");
  EXPECT_EQ(ranged_raw(yaw, 50000.0F), 0u);
  EXPECT_EQ(ranged_value(yaw, 0), -50000.0F);
  EXPECT_EQ(ranged_raw(yaw, 0.0F), 0x80000000u);
}

// Packets of one field each, for the rules of encoding.
struct OneField {
  std::array<Field, 1> fields;
  Message message;
  explicit OneField(const Field& field) : fields{field} {
    message.name = "one";
    message.type = 7;
    message.size_bytes = (field.bits + 7) / 8;
    message.fields = fields;
  }
  PacketError encode(Value value, std::array<std::uint8_t, 8>& bytes) const {
    Values values;
    values.message = &message;
    values.fields[0] = value;
    bytes.fill(0);
    const FieldFault fault = encode_fields(values, static_cast<std::size_t>(message.size_bytes), bytes);
    EXPECT_EQ(fault.field.empty(), fault.error == PacketError::kNone);
    return fault.error;
  }
  PacketError encode(double number) const {
    std::array<std::uint8_t, 8> bytes{};
    return encode({.number = number, .raw = 0}, bytes);
  }
};

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(EncodeField, RefusesIntegersThatDoNotFit) {
  const OneField byte(number("n", 8, "", ""));
  EXPECT_EQ(byte.encode(255.0), PacketError::kNone);
  for (double bad : {256.0, -1.0, 0.5, 1e300}) EXPECT_EQ(byte.encode(bad), PacketError::kRange) << bad;
  for (double bad : {kNan, kInfinity}) EXPECT_EQ(byte.encode(bad), PacketError::kNotFinite) << bad;
  const OneField limited(number("n", 8, "", "", 2, 5));
  EXPECT_EQ(limited.encode(2.0), PacketError::kNone);
  EXPECT_EQ(limited.encode(5.0), PacketError::kNone);
  EXPECT_EQ(limited.encode(1.0), PacketError::kRange);
  EXPECT_EQ(limited.encode(6.0), PacketError::kRange);
}

TEST(EncodeField, RefusesFloatsThatAreNotFiniteOrBecomeInfinite) {
  const OneField field(float32("x", "", ""));
  EXPECT_EQ(field.encode(3.4028234663852886e38), PacketError::kNone);
  EXPECT_EQ(field.encode(1.401298464324817e-45), PacketError::kNone);
  EXPECT_EQ(field.encode(3.5e38), PacketError::kRange);
  for (double bad : {kNan, kInfinity, -kInfinity}) EXPECT_EQ(field.encode(bad), PacketError::kNotFinite);
}

TEST(EncodeField, ComparesRangesAfterRoundingToFloat32) {
  const OneField field(ranged("acc", 16, -156.96, 156.96, "m/s^2", ""));
  EXPECT_EQ(field.encode(156.9600067138672), PacketError::kNone);  // the float32 next to 156.96
  EXPECT_EQ(field.encode(156.97), PacketError::kRange);
  EXPECT_EQ(field.encode(-156.97), PacketError::kRange);
  EXPECT_EQ(field.encode(1e300), PacketError::kRange);
  EXPECT_EQ(field.encode(kNan), PacketError::kNotFinite);
}

TEST(EncodeField, FillsInWhatWasLeftOutAndRefusesWhatContradicts) {
  EXPECT_EQ(OneField(constant("c", 8, 0xFE, "")).encode(0.0), PacketError::kNone);
  EXPECT_EQ(OneField(constant("c", 8, 0xFE, "")).encode(254.0), PacketError::kNone);
  EXPECT_EQ(OneField(constant("c", 8, 0xFE, "")).encode(1.0), PacketError::kConstant);
  EXPECT_EQ(OneField(type_code("t", 8)).encode(7.0), PacketError::kNone);
  EXPECT_EQ(OneField(type_code("t", 8)).encode(8.0), PacketError::kUnknownType);
  EXPECT_EQ(OneField(length("l", 8, "")).encode(1.0), PacketError::kNone);
  EXPECT_EQ(OneField(length("l", 8, "")).encode(2.0), PacketError::kLength);
}

TEST(EncodeField, IntegersWiderThanADoubleKeepEveryBit) {
  const OneField wide(reserved("filler", 56, ""));
  for (std::uint64_t raw : {0xFFFFFFFFFFFFFFull, 0x80000000000001ull, 1ull}) {
    std::array<std::uint8_t, 8> bytes{};
    EXPECT_EQ(wide.encode({.number = static_cast<double>(raw), .raw = raw}, bytes), PacketError::kNone);
    EXPECT_EQ(read_bits(bytes, 0, 56, BitOrder::kMsbFirst), raw);
  }
}

TEST(EncodeField, RawDecidesOnlyWhereItStandsForTheNumber) {
  const OneField field(ranged("theta", 16, -kPi, kPi, "rad", ""));
  std::array<std::uint8_t, 8> bytes{};
  for (std::uint64_t raw = 0; raw < 65536; ++raw) {
    const double decoded = ranged_value(field.fields[0], raw);
    ASSERT_EQ(field.encode({.number = decoded, .raw = raw}, bytes), PacketError::kNone);
    ASSERT_EQ(read_bits(bytes, 0, 16, BitOrder::kMsbFirst), raw);
  }
  EXPECT_EQ(field.encode({.number = 1.0, .raw = 5}, bytes), PacketError::kNone);
  EXPECT_EQ(read_bits(bytes, 0, 16, BitOrder::kMsbFirst), ranged_raw(field.fields[0], 1.0F));
}

TEST(DecodeField, RefusesValuesOutsideTheTable) {
  const OneField limited(number("n", 8, "", "", 2, 5));
  Values values;
  for (int raw = 0; raw < 256; ++raw) {
    const std::array<std::uint8_t, 1> bytes{static_cast<std::uint8_t>(raw)};
    const FieldFault fault = decode_fields(limited.message, bytes, 1, values);
    EXPECT_EQ(fault.error, raw >= 2 && raw <= 5 ? PacketError::kNone : PacketError::kRange) << raw;
  }
}

TEST(FieldTable, GapsAndOverlapsAreSeen) {
  std::array fields = in_order(std::array{number("a", 4, "", ""), number("b", 12, "", "")});
  Message message;
  message.size_bytes = 2;
  message.fields = fields;
  EXPECT_TRUE(is_tiled(message));
  message.size_bytes = 3;
  EXPECT_FALSE(is_tiled(message)) << "gap at the end";
  message.size_bytes = 2;
  fields[1].bit = 3;
  EXPECT_FALSE(is_tiled(message)) << "overlap, and a gap at the end";
  fields[1].bit = 5;
  EXPECT_FALSE(is_tiled(message)) << "past the end";
}

}  // namespace
}  // namespace omnihil
