// What decides byte-exactness, and what is easily got wrong.
#include <cmath>
#include <cstring>
#include <limits>

#include "firmware_iface/checksum.h"
#include "protocols/cobs.h"
#include "protocols/rem_packet.h"
#include "tests/protocols/packet_util.h"

namespace omnihil {
namespace {

const RadioFormat& hermes() { return *find_radio_format("ulaval-hermes"); }
const RadioFormat& rem_v8() { return *find_radio_format("roboteam-rem-v8"); }
const RadioFormat& rem_v5() { return *find_radio_format("roboteam-rem-v5"); }

Values values_of(const RadioFormat& format, const char* packet) {
  Values values;
  values.message = format.find(packet);
  return values;
}

Bytes frame_of(const RadioFormat& format, const Values& values) {
  Bytes frame;
  const auto result = format.encode(values, frame);
  EXPECT_EQ(result.error, PacketError::kNone) << result.field;
  return frame;
}

// A HERMES frame around any packet, with the right checksum.
Bytes hermes_frame(Bytes packet) {
  packet[4] = static_cast<std::uint8_t>(sum8(packet) - packet[4]);
  Bytes frame;
  cobs_encode(packet, frame);
  frame.push_back(0);
  return frame;
}

TEST(RemTraps, KickAtFullPowerIsOneCountShort) {
  Values values = values_of(rem_v8(), "REM_RobotCommand");
  values.set("kickChipPower", 8.0);
  EXPECT_EQ(frame_of(rem_v8(), values)[25], 0xFE);
}

TEST(RemTraps, TheTimestampIsMillisecondsIn48BitsOrCentisecondsIn40) {
  Values values = values_of(rem_v8(), "REM_Packet");
  values.set("timestamp", 0x0123456789ABull);
  const Bytes v8 = frame_of(rem_v8(), values);
  EXPECT_EQ(Bytes(v8.begin() + 4, v8.begin() + 10), (Bytes{0x01, 0x23, 0x45, 0x67, 0x89, 0xAB}));
  EXPECT_EQ(rem_v8().find("REM_Packet")->fields[13].unit, "ms");
  values = values_of(rem_v5(), "REM_Packet");
  values.set("timestamp", 0x23456789ABull);
  const Bytes v5 = frame_of(rem_v5(), values);
  EXPECT_EQ(Bytes(v5.begin() + 4, v5.begin() + 9), (Bytes{0x23, 0x45, 0x67, 0x89, 0xAB}));
  EXPECT_EQ(rem_v5().find("REM_Packet")->fields[13].unit, "10 ms");
}

TEST(RemTraps, TheRangeOfUnlabelIsNotSymmetric) {
  Values values = values_of(rem_v8(), "REM_RobotSetPIDGains");
  values.set("unlabel3", -1000.0);
  EXPECT_EQ(frame_of(rem_v8(), values).size(), 67u);
  values.set("unlabel3", 101.0);
  Bytes frame;
  const auto result = rem_v8().encode(values, frame);
  EXPECT_EQ(result.error, PacketError::kRange);
  EXPECT_EQ(result.field, "unlabel3");
}

TEST(RemTraps, FieldsAreMsbFirst) {
  Values values = values_of(rem_v8(), "REM_RobotCommand");
  values.set("toRobotId", 3);
  values.set("toColor", 1);
  values.set("toPC", 1);
  values.set("messageId", 5);
  values.set("doKick", 1);
  values.set("reboot", 1);
  const Bytes frame = frame_of(rem_v8(), values);
  EXPECT_EQ(frame[0], 0x22);
  EXPECT_EQ(frame[1], 0b0011'1001);
  EXPECT_EQ(frame[3], 0x85);
  EXPECT_EQ(frame[10], 28);
  EXPECT_EQ(frame[26], 0x80);
  EXPECT_EQ(frame[27], 0x01);
}

TEST(RemTraps, TheOtherVersionIsRefusedAsSuch) {
  Values values = values_of(rem_v5(), "REM_RobotSetPIDGains");  // type 35h, which version 8 has as well
  Bytes frame = frame_of(rem_v5(), values);
  frame.resize(49);
  const DecodeResult result = rem_v8().decode(frame);
  EXPECT_EQ(result.error, PacketError::kVersion);
  EXPECT_EQ(result.field, "remVersion");
}

TEST(RemTraps, SizesAreCheckedAgainstTypePayloadSizeAndBytes) {
  const Values values = values_of(rem_v8(), "REM_RobotCommand");
  const Bytes good = frame_of(rem_v8(), values);
  Bytes frame = good;
  frame[10] = 27;
  EXPECT_EQ(rem_v8().decode(frame).error, PacketError::kLength);
  EXPECT_EQ(rem_v8().decode(frame).field, "payloadSize");
  frame = good;
  frame.push_back(0);
  EXPECT_EQ(rem_v8().decode(frame).error, PacketError::kTooLong);
  frame = good;
  frame.pop_back();
  EXPECT_EQ(rem_v8().decode(frame).error, PacketError::kTooShort);
  frame = good;
  frame[0] = 0x23;
  EXPECT_EQ(rem_v8().decode(frame).error, PacketError::kUnknownType);
  EXPECT_EQ(rem_v8().decode({}).error, PacketError::kTooShort);
}

TEST(RemTraps, ALogCarriesItsTextWithinPayloadSize) {
  for (const RadioFormat* format : {&rem_v8(), &rem_v5()}) {
    Values values = values_of(*format, "REM_Log");
    const auto fields = static_cast<std::size_t>(values.message->size_bytes);
    values.text = "kick";
    const Bytes frame = frame_of(*format, values);
    ASSERT_EQ(frame.size(), fields + 4);
    EXPECT_EQ(frame[fields - 1], fields + 4);
    const DecodeResult result = format->decode(frame);
    ASSERT_EQ(result.error, PacketError::kNone);
    EXPECT_EQ(result.values.text, "kick");
    EXPECT_EQ(format->decode(std::span(frame).first(frame.size() - 1)).error, PacketError::kTooShort);
    EXPECT_EQ(rem::packet_bytes(format->messages, frame), frame.size());
    const std::string longest(255 - fields, 'x');
    values.text = longest;
    EXPECT_EQ(frame_of(*format, values).size(), 255u);
    const std::string too_long = longest + "x";
    values.text = too_long;
    Bytes out;
    EXPECT_EQ(format->encode(values, out).error, PacketError::kTooLong);
    EXPECT_TRUE(out.empty());
  }
}

TEST(RemTraps, PacketsThatFollowEachOtherAreFoundByTheirTypes) {
  Bytes stream;
  std::vector<const GoldenPacket*> expected;
  const auto golden = golden_packets();
  for (const GoldenPacket& packet : golden) {
    if (packet.format != &rem_v8()) continue;
    stream.insert(stream.end(), packet.frame.begin(), packet.frame.end());
    expected.push_back(&packet);
  }
  std::size_t at = 0;
  for (const GoldenPacket* packet : expected) {
    const auto size = rem::packet_bytes(rem_v8().messages, std::span(stream).subspan(at));
    ASSERT_EQ(size, packet->frame.size());
    at += *size;
  }
  EXPECT_EQ(at, stream.size());
  EXPECT_EQ(rem::packet_bytes(rem_v8().messages, {}), std::nullopt);
  EXPECT_EQ(rem::packet_bytes(rem_v8().messages, Bytes{0x2D, 0x00}), std::nullopt)
      << "its length comes later";
  EXPECT_EQ(rem::packet_bytes(rem_v8().messages, Bytes{0x00}), 0u);
}

TEST(HermesTraps, FloatsAreLittleEndian) {
  Values values = values_of(hermes(), "SPEED_MOVE");
  values.set("robot", 3);
  values.set("vx", 1.0);   // 3F800000h
  values.set("vy", -2.5);  // C0200000h
  Bytes packet{1, 0xFE, 3, 2, 0, 0, 0, 0x80, 0x3F, 0, 0, 0x20, 0xC0, 0, 0, 0, 0};
  EXPECT_EQ(frame_of(hermes(), values), hermes_frame(packet));
}

TEST(HermesTraps, ChargeIsTheHighestBitOfTheDribblersByte) {
  Values values = values_of(hermes(), "SPEED_MOVE_ADVANCE");
  values.set("robot", 1);
  values.set("dribbler", 3);
  values.set("charge", 1);
  values.set("kick_force", 10);
  Bytes packet{1, 0xFE, 1, 9, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x83, 10};
  EXPECT_EQ(frame_of(hermes(), values), hermes_frame(packet));
}

TEST(HermesTraps, NanAndInfinityAreRefusedWithTheirField) {
  for (float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    Bytes packet{1, 0xFE, 1, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0};
    std::memcpy(packet.data() + 9, &bad, 4);
    const DecodeResult result = hermes().decode(hermes_frame(packet));
    EXPECT_EQ(result.error, PacketError::kNotFinite);
    EXPECT_EQ(result.field, "vy");
    Values values = values_of(hermes(), "SPEED_MOVE");
    values.set("vtheta", bad);
    Bytes out;
    const auto encoded = hermes().encode(values, out);
    EXPECT_EQ(encoded.error, PacketError::kNotFinite);
    EXPECT_EQ(encoded.field, "vtheta");
    EXPECT_TRUE(out.empty());
  }
}

TEST(HermesTraps, EachDamageHasItsCause) {
  const Bytes packet{1, 0xFE, 2, 5, 0};
  const auto with = [&](std::size_t at, std::uint8_t value) {
    Bytes changed = packet;
    changed[at] = value;
    return hermes().decode(hermes_frame(changed));
  };
  EXPECT_EQ(hermes().decode(hermes_frame(packet)).error, PacketError::kNone);
  EXPECT_EQ(with(0, 2).error, PacketError::kVersion);
  EXPECT_EQ(with(1, 0x05).error, PacketError::kConstant);
  EXPECT_EQ(with(1, 0x05).field, "source");
  EXPECT_EQ(with(3, 10).error, PacketError::kUnknownType);
  EXPECT_EQ(with(3, 2).error, PacketError::kTooShort) << "SPEED_MOVE needs 17 bytes";
  EXPECT_EQ(hermes().decode(hermes_frame({1, 0xFE, 2, 5, 0, 9})).error, PacketError::kTooLong);
  EXPECT_EQ(hermes().decode(hermes_frame({1, 2, 7, 1, 0})).error, PacketError::kAddress);
  Bytes frame = hermes_frame(packet);
  frame[frame.size() - 2] ^= 1;  // the checksum
  EXPECT_EQ(hermes().decode(frame).error, PacketError::kChecksum);
  EXPECT_EQ(hermes().decode(Bytes{0}).error, PacketError::kTooShort);
  EXPECT_EQ(hermes().decode({}).error, PacketError::kTooShort);
  EXPECT_EQ(hermes().decode(Bytes{1, 1, 1}).error, PacketError::kFraming);
  EXPECT_EQ(hermes().decode(Bytes{9, 1, 0}).error, PacketError::kFraming);
  EXPECT_EQ(hermes().decode(Bytes(30, 1)).error, PacketError::kFraming) << "no delimiter";
  Bytes too_long(30, 1);
  too_long.back() = 0;
  EXPECT_EQ(hermes().decode(too_long).error, PacketError::kTooLong);
}

}  // namespace
}  // namespace omnihil
