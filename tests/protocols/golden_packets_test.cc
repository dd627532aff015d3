#include <algorithm>
#include <cmath>
#include <set>

#include "protocols/codec.h"
#include "tests/protocols/packet_util.h"

namespace omnihil {
namespace {

TEST(GoldenPackets, CoverEveryPacketTypeOfEveryFormat) {
  std::set<const Message*> covered;
  for (const GoldenPacket& packet : golden_packets()) covered.insert(packet.message);
  for (const RadioFormat* format : radio_formats()) {
    for (const Message& message : format->messages) {
      EXPECT_TRUE(covered.contains(&message)) << format->id << " " << message.name;
    }
  }
}

TEST(GoldenPackets, EncodeToTheSameBytes) {
  for (const GoldenPacket& packet : golden_packets()) {
    std::string text;
    Bytes frame;
    const auto result = packet.format->encode(values_from_json(*packet.message, packet.given, text), frame);
    EXPECT_EQ(result.error, PacketError::kNone) << packet.message->name << " field " << result.field;
    EXPECT_EQ(to_hex(frame), to_hex(packet.frame)) << packet.format->id << " " << packet.message->name;
  }
}

TEST(GoldenPackets, DecodeToTheirTypeAndComeBackByteForByte) {
  for (const GoldenPacket& packet : golden_packets()) {
    const DecodeResult result = packet.format->decode(packet.frame);
    ASSERT_EQ(result.error, PacketError::kNone) << packet.message->name << " field " << result.field;
    EXPECT_EQ(result.values.message, packet.message);
    EXPECT_TRUE(survives_round_trip(*packet.format, packet.frame));
  }
}

// One count of a ranged field is what encoding may lose; the rest is exact, floats to their own precision.
TEST(GoldenPackets, DecodeToTheValuesThatTheyWereMadeOf) {
  for (const GoldenPacket& packet : golden_packets()) {
    const DecodeResult result = packet.format->decode(packet.frame);
    std::string text;
    const Values given = values_from_json(*packet.message, packet.given, text);
    EXPECT_EQ(result.values.text, given.text);
    for (std::size_t i = 0; i < packet.message->fields.size(); ++i) {
      const Field& field = packet.message->fields[i];
      const std::string name(field.name.substr(0, field.name.find_first_of("[.")));
      if (!packet.given.contains(name)) continue;
      const double wanted = given.fields[i].number;
      if (std::isnan(wanted)) {
        EXPECT_TRUE(std::isnan(result.values.fields[i].number)) << field.name;
        continue;
      }
      const bool ranged = field.kind == FieldKind::kRanged32 || field.kind == FieldKind::kScaled;
      const double step = ranged ? field_step(field) : 0.0;
      const bool single = ranged || field.kind == FieldKind::kFloat32;
      const double rounding =
          single ? 1.2e-7 * std::max({std::abs(wanted), std::abs(field.lo), field.hi}) : 0.0;
      EXPECT_NEAR(result.values.fields[i].number, wanted, step + rounding)
          << packet.format->id << " " << packet.message->name << "." << field.name;
    }
  }
}

TEST(GoldenPackets, EncodeAppendsAndLeavesNothingBehindWhenItRefuses) {
  for (const RadioFormat* format : radio_formats()) {
    for (const Message& message : format->messages) {
      Values values;
      values.message = &message;
      const Field* type = nullptr;
      for (const Field& field : message.fields) {
        if (field.kind == FieldKind::kType) type = &field;
      }
      if (type == nullptr) continue;  // told by its length
      values.set(type->name, static_cast<double>(required_raw(*type, message, 0)) + 1.0);
      Bytes out{0xAA};
      const auto result = format->encode(values, out);
      EXPECT_EQ(result.error, PacketError::kUnknownType) << message.name;
      EXPECT_EQ(result.field, type->name);
      EXPECT_EQ(out, Bytes{0xAA});
    }
  }
}

}  // namespace
}  // namespace omnihil
