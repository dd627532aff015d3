#include "hil/wire/pacer.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <numeric>
#include <vector>

namespace omnihil {
namespace {

constexpr std::int64_t kMs = 1'000'000;
constexpr std::int64_t kS = 1'000'000'000;

std::vector<std::uint8_t> counting(std::size_t n) {
  std::vector<std::uint8_t> bytes(n);
  std::iota(bytes.begin(), bytes.end(), std::uint8_t{0});
  return bytes;
}

TEST(PacerTest, Carries11520BytesPerSecondAt115200Baud8N1) {
  // 115200 bit/s / (1 start + 8 data + 1 stop) = 11520 byte/s, exactly.
  Pacer line({115200, 10}, 100'000);
  line.push(counting(50'000), 0);
  std::vector<std::uint8_t> out;
  for (int second = 1; second <= 4; ++second) {
    line.pop(second * kS - 1, out);
    EXPECT_EQ(out.size(), 11520u * static_cast<unsigned>(second) - 1) << second;
    line.pop(second * kS, out);
    EXPECT_EQ(out.size(), 11520u * static_cast<unsigned>(second)) << second;
  }
}

TEST(PacerTest, GivesTheSameBytesInWhateverStepsItIsAsked) {
  const std::vector<std::uint8_t> in = counting(2000);
  std::vector<std::uint8_t> coarse, fine;
  Pacer a({57600, 11}, 4096), b({57600, 11}, 4096);
  a.push(in, 7);
  b.push(in, 7);
  a.pop(7 + 123 * kMs, coarse);
  for (std::int64_t t = 0; t <= 123 * kMs; t += 333) b.pop(7 + t, fine);
  b.pop(7 + 123 * kMs, fine);
  EXPECT_EQ(coarse, fine);
  // 0.123 s * 57600 / 11 = 644.07 bytes
  EXPECT_EQ(coarse.size(), 644u);
  EXPECT_TRUE(std::equal(coarse.begin(), coarse.end(), in.begin()));
}

TEST(PacerTest, AByteNeedsItsWholeTimeAfterAnIdleLine) {
  // 9600 baud 8N1: 1 byte = 10 / 9600 s = 1041666.67 ns
  Pacer line({9600, 10}, 16);
  std::vector<std::uint8_t> out;
  line.push(counting(1), 5 * kS);
  line.pop(5 * kS + 1'041'666, out);
  EXPECT_TRUE(out.empty());
  line.pop(5 * kS + 1'041'667, out);
  EXPECT_EQ(out.size(), 1u);
}

TEST(PacerTest, SteadyTrafficBelowTheRateIsNotHeldBack) {
  Pacer line({115200, 10}, 64);
  std::vector<std::uint8_t> out;
  for (int ms = 0; ms < 1000; ++ms) {
    ASSERT_EQ(line.push(counting(11), ms * kMs), 11u);  // 11 < 11.52 per ms
    line.pop((ms + 1) * kMs, out);
    EXPECT_EQ(line.waiting(), 0u);
  }
  EXPECT_EQ(out.size(), 11000u);
}

TEST(PacerTest, SteadyTrafficAboveTheRateLeavesAtTheRate) {
  Pacer line({115200, 10}, 64);
  std::vector<std::uint8_t> out;
  for (int ms = 0; ms < 10'000; ++ms) {
    line.push(counting(20), ms * kMs);
    line.pop((ms + 1) * kMs, out);
  }
  EXPECT_EQ(out.size(), 115200u);  // 10 s
}

TEST(PacerTest, UnpacedLineGivesEverythingAtOnce) {
  Pacer line({0, 10}, 4096);
  std::vector<std::uint8_t> out;
  line.push(counting(4000), 42);
  line.pop(42, out);
  EXPECT_EQ(out, counting(4000));
}

TEST(PacerTest, TakesNoMoreThanItsRoom) {
  Pacer line({115200, 10}, 10);
  EXPECT_EQ(line.push(counting(25), 0), 10u);
  EXPECT_EQ(line.room(), 0u);
  line.clear();
  EXPECT_EQ(line.room(), 10u);
}

TEST(PacerTest, StaysExactAfterAnHourOfBusyLine) {
  Pacer line({115200, 10}, 1024);
  std::vector<std::uint8_t> out;
  std::uint64_t total = 0;
  const std::vector<std::uint8_t> chunk(1024, 0x55);
  const std::int64_t hour_ns = 3'600 * kS;
  // 50 ms at a time: 576 bytes cross, the queue is never empty, so it is one busy period.
  for (std::int64_t t = 0; t < hour_ns; t += 50 * kMs) {
    line.push(chunk, t);
    out.clear();
    line.pop(t + 50 * kMs, out);
    total += out.size();
  }
  EXPECT_EQ(total, 3'600ull * 11'520ull);
}

}  // namespace
}  // namespace omnihil
