// Protobuf frames: what an encoder writes is taken, every other spelling of the same is refused with its cause.
#include "protocols/protobuf_list.h"

#include "protocols/packet_list.h"
#include "tests/protocols/packet_util.h"

namespace omnihil {
namespace {

const RadioFormat& namec() { return *find_radio_format("namec-pc-to-base"); }

// A frame of one packet with these bytes.
Bytes framed(const Bytes& packet) {
  Bytes frame{static_cast<std::uint8_t>(packet.size() + 2), 0x0A, static_cast<std::uint8_t>(packet.size())};
  frame.insert(frame.end(), packet.begin(), packet.end());
  return frame;
}
PacketError refusal(const Bytes& packet) { return namec().decode(framed(packet)).error; }

TEST(ProtobufList, OtherSpellingsOfAPacketAreRefusedWithTheirCause) {
  EXPECT_EQ(refusal({0x08, 0x03, 0x28, 0x01}), PacketError::kNone);     // robot 3, flat kick
  EXPECT_EQ(refusal({0x28, 0x01, 0x08, 0x03}), PacketError::kFraming);  // in another order
  EXPECT_EQ(refusal({0x08, 0x03, 0x08, 0x03}), PacketError::kFraming);  // twice
  EXPECT_EQ(refusal({0x08, 0x00}), PacketError::kFraming);              // a written zero
  EXPECT_EQ(refusal({0x08, 0x83, 0x00}), PacketError::kFraming);        // a longer varint
  EXPECT_EQ(refusal({0x08}), PacketError::kFraming);                    // cut off
  EXPECT_EQ(refusal({0x15, 0x00, 0x00}), PacketError::kTooShort);       // a float's four bytes, cut off
  EXPECT_EQ(refusal({0x38, 0x02}), PacketError::kUnknownType);  // number 7 is no command's, 2 no answer's ir
  EXPECT_EQ(refusal({0x50, 0x01}), PacketError::kUnknownType);  // number 10
  EXPECT_EQ(refusal({0x08, 0x10}), PacketError::kRange);        // robot 16
  EXPECT_EQ(refusal({0x28, 0xAC, 0x02}), PacketError::kRange);  // a kick of 300
  EXPECT_EQ(refusal({0x15, 0x00, 0x00, 0xC0, 0x7F}), PacketError::kNotFinite);
}

TEST(ProtobufList, AFrameWhoseLengthsDoNotFitIsRefused) {
  EXPECT_EQ(namec().decode(Bytes{}).error, PacketError::kTooShort);
  EXPECT_EQ(namec().decode(Bytes{5, 0x0A, 2, 0x08, 0x03}).error, PacketError::kTooShort);
  EXPECT_EQ(namec().decode(Bytes{4, 0x0A, 2, 0x08, 0x03, 0}).error, PacketError::kTooLong);
  EXPECT_EQ(namec().decode(Bytes{4, 0x0A, 3, 0x08, 0x03}).error, PacketError::kFraming);
  EXPECT_EQ(namec().decode(Bytes{4, 0x12, 2, 0x08, 0x03}).error, PacketError::kFraming) << "number 2";
  EXPECT_EQ(namec().decode(Bytes{0}).error, PacketError::kLength) << "a list of none";
}

TEST(ProtobufList, SixPacketsComeBackAndSevenAreTooMany) {
  std::vector<Values> packets;
  for (int robot = 0; robot < 7; ++robot) {
    Values& values = packets.emplace_back();
    values.message = namec().find("BaseCommand");
    values.set("robot_id", robot);
    values.set("normal_velocity", 0.5 * robot);
    values.set("charge", robot % 2);
  }
  Bytes frame;
  ASSERT_EQ(encode_list(namec(), std::span(packets).first(6), frame).error, PacketError::kNone);
  EXPECT_EQ(frame.size(), 1u + frame[0]);
  ASSERT_EQ(listed_packets(namec(), frame), 6u);
  EXPECT_TRUE(is_frame(namec(), frame));
  for (std::size_t i = 0; i < 6; ++i) {
    const DecodeResult result = decode_listed(namec(), frame, i);
    ASSERT_EQ(result.error, PacketError::kNone);
    EXPECT_EQ(result.values.number("robot_id"), i);
    EXPECT_EQ(result.values.number("normal_velocity"), 0.5 * static_cast<double>(i));
  }
  const Bytes before = frame;
  EXPECT_EQ(encode_list(namec(), packets, frame).error, PacketError::kTooLong);
  EXPECT_EQ(frame, before) << "nothing is left behind";
}

// A robot that stands still: its battery tells its answer from a command.
TEST(ProtobufList, AStandingRobotsAnswerIsNoCommand) {
  Values values;
  values.message = namec().find("BaseFeedback");
  values.set("robot_id", 4);
  values.set("voltage", 24.0);
  Bytes frame;
  ASSERT_EQ(namec().encode(values, frame).error, PacketError::kNone);
  EXPECT_EQ(namec().decode(frame).values.message->name, "BaseFeedback");
}

TEST(ProtobufList, TheMostBytesOfAPacketAreThoseOfItsLargestValues) {
  const Message& message = *namec().find("BaseCommand");
  // Keys of one byte; robot_id has 32 bits, hence up to five bytes; five floats; two bytes for each of the small numbers.
  EXPECT_EQ(most_protobuf_bytes(message), (1 + 5) + 5 * (1 + 4) + 2 * (1 + 2));
  EXPECT_EQ(protobuf_frame_bytes(10, 3), 1 + 3 * 12);
  EXPECT_EQ(protobuf_frame_bytes(100, 6), 256);
}

}  // namespace
}  // namespace omnihil
