#include <set>

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

TEST(GoldenPackets, EncodeAppendsAndLeavesNothingBehindWhenItRefuses) {
  for (const RadioFormat* format : radio_formats()) {
    for (const Message& message : format->messages) {
      Values values;
      values.message = &message;
      const Field* type = nullptr;
      for (const Field& field : message.fields) {
        if (field.kind == FieldKind::kType) type = &field;
      }
      ASSERT_NE(type, nullptr);
      values.set(type->name, message.type + 1.0);
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
