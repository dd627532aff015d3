#include "protocols/cobs.h"

#include <gtest/gtest.h>

#include <array>
#include <random>

#include "firmware_iface/checksum.h"

namespace omnihil {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes encoded(const Bytes& data) {
  Bytes out;
  cobs_encode(data, out);
  return out;
}

Bytes run_of(std::uint8_t first, int count) {
  Bytes bytes;
  for (int i = 0; i < count; ++i) bytes.push_back(static_cast<std::uint8_t>(first + i));
  return bytes;
}

Bytes joined(Bytes a, const Bytes& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

// The examples everyone's COBS agrees on.
TEST(Cobs, EncodesTheTextbookExamples) {
  EXPECT_EQ(encoded({}), (Bytes{0x01}));
  EXPECT_EQ(encoded({0x00}), (Bytes{0x01, 0x01}));
  EXPECT_EQ(encoded({0x00, 0x00}), (Bytes{0x01, 0x01, 0x01}));
  EXPECT_EQ(encoded({0x11, 0x22, 0x00, 0x33}), (Bytes{0x03, 0x11, 0x22, 0x02, 0x33}));
  EXPECT_EQ(encoded({0x11, 0x00, 0x00, 0x00}), (Bytes{0x02, 0x11, 0x01, 0x01, 0x01}));
  EXPECT_EQ(encoded(run_of(0x01, 254)), joined({0xFF}, run_of(0x01, 254)));
  EXPECT_EQ(encoded(joined({0x00}, run_of(0x01, 254))), joined({0x01, 0xFF}, run_of(0x01, 254)));
  EXPECT_EQ(encoded(run_of(0x01, 255)), joined(joined({0xFF}, run_of(0x01, 254)), {0x02, 0xFF}));
}

TEST(Cobs, DecodesWhatItEncodedWithoutAnyZeroBetween) {
  std::mt19937 random(1);
  for (int round = 0; round < 5000; ++round) {
    Bytes data(random() % 600);
    for (auto& byte : data) byte = static_cast<std::uint8_t>(random() % 4 == 0 ? 0 : random());
    const Bytes stuffed = encoded(data);
    ASSERT_LE(stuffed.size(), cobs_max_size(data.size()));
    for (std::uint8_t byte : stuffed) ASSERT_NE(byte, 0);
    Bytes back(data.size());
    const CobsResult result = cobs_decode(stuffed, back);
    ASSERT_EQ(result.status, CobsStatus::kOk);
    ASSERT_EQ(result.size, data.size());
    ASSERT_EQ(back, data);
  }
}

TEST(Cobs, RefusesZerosInsideCodesPastTheEndAndTooMuch) {
  std::array<std::uint8_t, 3> out{};
  EXPECT_EQ(cobs_decode(Bytes{0x02, 0x00}, out).status, CobsStatus::kBadCode);
  EXPECT_EQ(cobs_decode(Bytes{0x00}, out).status, CobsStatus::kBadCode);
  EXPECT_EQ(cobs_decode(Bytes{0x03, 0x11}, out).status, CobsStatus::kBadCode);
  EXPECT_EQ(cobs_decode(Bytes{0x04, 0x11, 0x22, 0x33}, out).status, CobsStatus::kOk);
  EXPECT_EQ(cobs_decode(Bytes{0x05, 0x11, 0x22, 0x33, 0x44}, out).status, CobsStatus::kTooLong);
  EXPECT_EQ(cobs_decode(Bytes{0x01, 0x01, 0x01, 0x01, 0x01}, out).status, CobsStatus::kTooLong);
}

TEST(Sum8, IsTheSumModulo256) {
  EXPECT_EQ(sum8({}), 0);
  EXPECT_EQ(sum8(Bytes{0x01, 0xFE, 0x03}), (1 + 254 + 3) % 256);
}

}  // namespace
}  // namespace omnihil
