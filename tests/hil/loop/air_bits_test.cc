// Bits that the air flips, and what a checksum lets pass of it: against theory, with exact binomial bounds that a right
// program leaves once in 10^6 seeds on each side.
#include "hil/loop/air_bits.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "firmware_iface/checksum.h"
#include "tests/binomial_bounds.h"

namespace omnihil {
namespace {

constexpr double kTail = 1e-6;

// Each bit by itself: flips of all bits, of each place of a byte, and packets without any.
TEST(AirBits, EachBitHasTheSameChance) {
  constexpr double kRate = 0.003;
  constexpr std::size_t kBytes = 25;
  constexpr std::uint64_t kPackets = 40'000;
  AirBits bits(kRate, 21);
  std::array<std::uint64_t, 8> by_place{};
  std::uint64_t clean = 0, first = 0, last = 0;
  for (std::uint64_t n = 0; n < kPackets; ++n) {
    std::array<std::uint8_t, kBytes> packet{};
    const bool flipped = bits.flip(packet);
    std::uint64_t ones = 0;
    for (const std::uint8_t byte : packet) {
      for (std::size_t i = 0; i < 8; ++i) {
        by_place[i] += byte >> i & 1U;
        ones += byte >> i & 1U;
      }
    }
    EXPECT_EQ(flipped, ones > 0);
    clean += ones == 0 ? 1 : 0;
    first += packet.front() & 1U;
    last += packet.back() >> 7;
  }
  for (const std::uint64_t count : by_place) {
    const auto [low, high] = binomial_bounds(kPackets * kBytes, kRate, kTail);
    EXPECT_GE(count, low);
    EXPECT_LE(count, high);
  }
  const auto [low, high] = binomial_bounds(kPackets, std::pow(1.0 - kRate, 8.0 * kBytes), kTail);
  EXPECT_GE(clean, low);
  EXPECT_LE(clean, high);
  for (const std::uint64_t count : {first, last}) {
    const auto [end_low, end_high] = binomial_bounds(kPackets, kRate, kTail);
    EXPECT_GE(count, end_low);
    EXPECT_LE(count, end_high);
  }
}

TEST(AirBits, NoneAndTheLeastRate) {
  std::array<std::uint8_t, 4> packet{1, 2, 3, 4};
  EXPECT_FALSE(AirBits(0.0, 1).flip(packet));
  AirBits rare(1e-12, 1);
  for (int n = 0; n < 1'000; ++n) EXPECT_FALSE(rare.flip(packet));
  EXPECT_EQ(packet, (std::array<std::uint8_t, 4>{1, 2, 3, 4}));
}

class ChecksumOnTheAir : public testing::TestWithParam<const ChecksumKind*> {};

// Twelve bytes and their checksum, half of the bits wrong: 2^-n of what is wrong passes a checksum of n bits.
TEST_P(ChecksumOnTheAir, LetsPassOneInTwoToTheNumberOfItsBits) {
  const ChecksumKind& kind = *GetParam();
  const auto checked = static_cast<std::size_t>(kind.bits / 8);
  constexpr std::size_t kData = 12;
  const std::uint64_t packets = kind.bits == 8 ? 200'000 : 600'000;
  std::vector<std::uint8_t> sent(kData + checked);
  for (std::size_t i = 0; i < kData; ++i) sent[i] = static_cast<std::uint8_t>(17 * i + 3);
  const std::uint64_t right = kind.of(std::span(sent).first(kData));
  for (std::size_t i = 0; i < checked; ++i) sent[kData + i] = static_cast<std::uint8_t>(right >> (8 * i));
  AirBits bits(0.5, 31);
  std::uint64_t passed = 0, wrong = 0;
  std::vector<std::uint8_t> packet(sent.size());
  for (std::uint64_t n = 0; n < packets; ++n) {
    packet = sent;
    bits.flip(packet);
    if (packet == sent) continue;
    ++wrong;
    const std::uint64_t sum = kind.of(std::span(packet).first(kData));
    bool fits = true;
    for (std::size_t i = 0; i < checked; ++i)
      fits = fits && packet[kData + i] == static_cast<std::uint8_t>(sum >> (8 * i));
    passed += fits ? 1 : 0;
  }
  const double theory = std::ldexp(1.0, -kind.bits);
  const auto [low, high] = binomial_bounds(wrong, theory, kTail);
  EXPECT_GE(passed, low);
  EXPECT_LE(passed, high);
  std::printf("%s: %llu of %llu damaged packets pass, theory %.2f, 1e-6 bounds %llu to %llu\n",
              std::string(kind.name).c_str(), static_cast<unsigned long long>(passed),
              static_cast<unsigned long long>(wrong), theory * static_cast<double>(wrong),
              static_cast<unsigned long long>(low), static_cast<unsigned long long>(high));
}

// One wrong bit never passes any of them.
TEST_P(ChecksumOnTheAir, SeesEverySingleFlip) {
  const ChecksumKind& kind = *GetParam();
  std::array<std::uint8_t, 12> data{};
  for (std::size_t i = 0; i < data.size(); ++i) data[i] = static_cast<std::uint8_t>(29 * i + 5);
  const std::uint64_t right = kind.of(data);
  for (std::size_t bit = 0; bit < 8 * data.size(); ++bit) {
    auto wrong = data;
    wrong[bit / 8] ^= static_cast<std::uint8_t>(1U << (bit % 8));
    EXPECT_NE(kind.of(wrong), right) << bit;
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, ChecksumOnTheAir, testing::ValuesIn(kChecksumKinds), [](const auto& param) {
  std::string name(param.param->name);
  std::erase(name, '-');
  return name;
});

}  // namespace
}  // namespace omnihil
