// How often damage passes HERMES' checksum, against what theory gives.
#include <cmath>
#include <cstdio>
#include <random>

#include "protocols/cobs.h"
#include "tests/protocols/packet_util.h"

namespace omnihil {
namespace {

const RadioFormat& hermes() { return *find_radio_format("ulaval-hermes"); }

// A HERMES packet before COBS with a checksum that fits, and the same with other contents but that checksum.
struct Packet {
  Bytes bytes;
  explicit Packet(Bytes given) : bytes(std::move(given)) {
    unsigned sum = 0;
    for (std::uint8_t byte : bytes) sum += byte;
    bytes[4] = static_cast<std::uint8_t>(sum - bytes[4]);
  }
  bool accepted_with_payload(const Bytes& payload) const {
    Bytes changed = bytes;
    std::copy(payload.begin(), payload.end(), changed.begin() + 5);
    Bytes frame;
    cobs_encode(changed, frame);
    frame.push_back(0);
    return hermes().decode(frame).error == PacketError::kNone;
  }
};

// Of the 65536 contents of two bytes, 256 have any given sum: the true one and 255 others.
TEST(Sum8Rate, OfAllContentsOfTwoBytesExactly255OthersPass) {
  const Packet packet({1, 0xFE, 3, 3, 0, 2, 1});  // SET_REGISTER
  int passed = 0;
  for (int a = 0; a < 256; ++a) {
    for (int b = 0; b < 256; ++b) {
      passed +=
          packet.accepted_with_payload({static_cast<std::uint8_t>(a), static_cast<std::uint8_t>(b)}) ? 1 : 0;
    }
  }
  EXPECT_EQ(passed, 1 + 255);
  std::printf("sum8: %d of 65535 wrong contents of two bytes pass (1 in %.1f)\n", passed - 1,
              65535.0 / (passed - 1));
}

// Random wrong contents of n bytes pass with p = (256^(n-1) - 1) / (256^n - 1).
TEST(Sum8Rate, RandomContentsPassOnceIn256) {
  const Packet packet({1, 9, 0, 8, 0, 0xEF, 0xBE, 0xAD, 0xDE});  // NUM_REQUEST_RESPONSE
  const Bytes truth{0xEF, 0xBE, 0xAD, 0xDE};
  std::mt19937 random(20260104);
  constexpr int kTrials = 400000;
  int passed = 0;
  for (int i = 0; i < kTrials; ++i) {
    Bytes payload(4);
    do {
      for (std::uint8_t& byte : payload) byte = static_cast<std::uint8_t>(random());
    } while (payload == truth);
    passed += packet.accepted_with_payload(payload) ? 1 : 0;
  }
  const double p = (std::pow(256.0, 3) - 1.0) / (std::pow(256.0, 4) - 1.0);
  const double expected = kTrials * p;
  const double sigma = std::sqrt(kTrials * p * (1.0 - p));
  EXPECT_GT(passed, expected - 4.0 * sigma);
  EXPECT_LT(passed, expected + 4.0 * sigma);
  std::printf("sum8: %d of %d random contents pass, theory %.1f +- %.1f\n", passed, kTrials, expected, sigma);
}

// Two flipped bits cancel in the sum when they have the same weight and go opposite ways, or both have
// weight 128 (2 * 128 = 256).
TEST(Sum8Rate, PairsOfFlippedBitsPassExactlyWhereTheyCancel) {
  const Packet packet({1, 9, 0, 8, 0, 0xEF, 0xBE, 0xAD, 0xDE});
  const Bytes truth{0xEF, 0xBE, 0xAD, 0xDE};
  int passed = 0;
  int expected = 0;
  int pairs = 0;
  for (int i = 0; i < 32; ++i) {
    for (int j = 0; j < i; ++j) {
      Bytes payload = truth;
      const auto bit_of = [&](int n) { return truth[static_cast<std::size_t>(n / 8)] >> (n % 8) & 1; };
      payload[static_cast<std::size_t>(i / 8)] ^= static_cast<std::uint8_t>(1u << (i % 8));
      payload[static_cast<std::size_t>(j / 8)] ^= static_cast<std::uint8_t>(1u << (j % 8));
      const bool cancel = i % 8 == j % 8 && (i % 8 == 7 || bit_of(i) != bit_of(j));
      expected += cancel ? 1 : 0;
      const bool pass = packet.accepted_with_payload(payload);
      EXPECT_EQ(pass, cancel) << i << " and " << j;
      passed += pass ? 1 : 0;
      ++pairs;
    }
  }
  EXPECT_EQ(passed, expected);
  std::printf("sum8: %d of %d pairs of flipped bits pass, as worked out\n", passed, pairs);
}

}  // namespace
}  // namespace omnihil
