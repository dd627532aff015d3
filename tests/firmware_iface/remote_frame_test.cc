// The frames between bench and board: an independent CRC and COBS agree, and no damaged frame gets through.
#include "firmware_iface/remote_shim/remote_frame.h"

#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

#include "protocols/cobs.h"

namespace omnihil {
namespace {

using Bytes = std::vector<std::uint8_t>;

// CRC by long division of the message polynomial, bit by bit: 16 zero bits appended, FFFFh added to the first
// ones.
std::uint16_t crc_by_division(Bytes message) {
  message[0] ^= 0xFF;
  message[1] ^= 0xFF;
  message.insert(message.end(), {0, 0});
  std::uint32_t remainder = 0;
  for (std::size_t bit = 0; bit < 8 * message.size(); ++bit) {
    remainder = remainder << 1 | (message[bit / 8] >> (7 - bit % 8) & 1U);
    if ((remainder & 0x10000U) != 0) remainder ^= 0x11021U;
  }
  return static_cast<std::uint16_t>(remainder);
}

Bytes random_bytes(std::mt19937& random, std::size_t n) {
  Bytes bytes(n);
  for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random() % 4 == 0 ? 0 : random());
  return bytes;
}

Bytes wire(std::uint8_t type, std::uint16_t sequence, const Bytes& payload) {
  Bytes out(OMNIHIL_REMOTE_WIRE_MAX);
  out.resize(omnihil_remote_encode(type, sequence, payload.data(), payload.size(), out.data()));
  return out;
}

// Good frames among the bytes.
int good_frames(omnihil_remote_decoder& decoder, const Bytes& bytes, omnihil_remote_frame* last = nullptr) {
  int good = 0;
  omnihil_remote_frame frame{};
  for (const std::uint8_t byte : bytes) {
    if (omnihil_remote_decode(&decoder, byte, &frame) == 0) continue;
    ++good;
    if (last != nullptr) *last = frame;
  }
  return good;
}

TEST(RemoteFrameTest, crc_has_its_published_check_value) {
  const std::string text = "123456789";
  EXPECT_EQ(omnihil_remote_crc16(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()), 0x29B1);
}

TEST(RemoteFrameTest, wire_is_cobs_of_type_sequence_payload_and_crc) {
  std::mt19937 random(1);
  for (std::size_t n = 0; n <= OMNIHIL_REMOTE_PAYLOAD_MAX; ++n) {
    const Bytes payload = random_bytes(random, n);
    Bytes body{0x82, 0x34, 0x12};
    body.insert(body.end(), payload.begin(), payload.end());
    const std::uint16_t crc = crc_by_division(body);
    body.insert(body.end(), {static_cast<std::uint8_t>(crc & 0xFF), static_cast<std::uint8_t>(crc >> 8)});
    Bytes expected;
    cobs_encode(body, expected);
    expected.push_back(0);
    ASSERT_EQ(wire(0x82, 0x1234, payload), expected) << n;
    omnihil_remote_decoder decoder{};
    omnihil_remote_frame frame{};
    ASSERT_EQ(good_frames(decoder, expected, &frame), 1) << n;
    EXPECT_EQ(frame.type, 0x82);
    EXPECT_EQ(frame.sequence, 0x1234);
    EXPECT_EQ(Bytes(frame.payload, frame.payload + frame.bytes), payload);
  }
  EXPECT_TRUE(wire(1, 0, Bytes(OMNIHIL_REMOTE_PAYLOAD_MAX + 1)).empty());
}

TEST(RemoteFrameTest, no_frame_with_one_flipped_bit_gets_through) {
  std::mt19937 random(2);
  const Bytes good = wire(0x02, 7, random_bytes(random, 37));
  for (std::size_t bit = 0; bit < 8 * good.size(); ++bit) {
    Bytes bad = good;
    bad[bit / 8] ^= static_cast<std::uint8_t>(1U << bit % 8);
    bad.push_back(0);
    omnihil_remote_decoder decoder{};
    EXPECT_EQ(good_frames(decoder, bad), 0) << "bit " << bit;
    // a byte that became a delimiter makes two of it
    const unsigned frames = bad[bit / 8] == 0 && bit / 8 > 0 ? 2U : 1U;
    EXPECT_EQ(decoder.bad_cobs + decoder.bad_crc + decoder.too_short, frames) << "bit " << bit;
  }
}

TEST(RemoteFrameTest, a_cut_frame_is_lost_alone) {
  std::mt19937 random(3);
  const Bytes good = wire(0x82, 8, random_bytes(random, 18));
  for (std::size_t cut = 1; cut < good.size() - 1; ++cut) {
    Bytes line(good.begin(), good.begin() + static_cast<long>(cut));
    line.push_back(0);
    line.insert(line.end(), good.begin(), good.end());
    omnihil_remote_decoder decoder{};
    EXPECT_EQ(good_frames(decoder, line), 1) << cut;
  }
}

TEST(RemoteFrameTest, noise_and_endless_lines_do_no_harm) {
  std::mt19937 random(4);
  omnihil_remote_decoder decoder{};
  Bytes noise = random_bytes(random, 200'000);
  noise.insert(noise.end(), 5000, 0x55);
  EXPECT_LE(good_frames(decoder, noise), 10);  // of 40 000 frames one in 65 536 passes a CRC by chance
  good_frames(decoder, {0});
  noise.push_back(0);
  unsigned too_long = 0;  // stretches between delimiters
  for (auto from = noise.begin(); from != noise.end();) {
    const auto to = std::find(from, noise.end(), std::uint8_t{0});
    too_long += to - from > long{OMNIHIL_REMOTE_WIRE_MAX} - 1 ? 1U : 0U;
    from = to + 1;
  }
  EXPECT_EQ(decoder.too_long, too_long);
  EXPECT_EQ(good_frames(decoder, wire(1, 1, {1, 2, 3})), 1);
}

}  // namespace
}  // namespace omnihil
