// HERMES on the USB side: frames out of any stream of bytes, refusals by cause, floods.
#include <random>

#include "protocols/cobs.h"
#include "tests/protocols/dongles/links_harness.h"

namespace omnihil {
namespace {

Bench make_bench() {
  Bench bench("ulaval-hermes", {.robot_ids = {0, 1, 2, 3, 4, 5}});
  bench.boot_robots();
  bench.step();
  return bench;
}

Bytes speed(const Bench& bench, int robot, double vx) {
  return bench.encode("SPEED_MOVE", {{"robot", robot}, {"vx", vx}});
}

// The 17 bytes of a SPEED_MOVE, changed by `edit`, with a right checksum unless told, as a frame.
template <class Edit>
Bytes forged(Edit&& edit, bool right_checksum = true) {
  Bytes packet{1, 0xFE, 0, 2, 0, 0, 0, 0x80, 0x3F, 0, 0, 0, 0, 0, 0, 0, 0};
  edit(packet);
  packet[4] = 0;
  unsigned sum = 0;
  for (const std::uint8_t byte : packet) sum += byte;
  packet[4] = static_cast<std::uint8_t>(right_checksum ? sum : sum + 1);
  Bytes frame;
  cobs_encode(packet, frame);
  frame.push_back(0);
  return frame;
}

void expect_refused(const Bytes& frame, PacketError cause) {
  Bench bench = make_bench();
  bench.write(frame);
  bench.run_to(10 * kMs);
  EXPECT_EQ(bench.refused(cause), 1u) << to_string(cause);
  EXPECT_EQ(bench.link->from_host().refused(), 1u) << to_string(cause);
  EXPECT_EQ(bench.good(), 0u) << to_string(cause);
  EXPECT_TRUE(bench.sink.heard.empty()) << to_string(cause);
}

TEST(HermesStreamTest, ForgedFrameIsGoodAsLongAsNothingIsWrong) {
  Bench bench = make_bench();
  bench.write(forged([](Bytes&) {}));
  bench.run_to(2 * kMs);
  ASSERT_EQ(bench.sink.heard.size(), 1u);
  EXPECT_EQ(bench.sink.heard[0].command.v_forward_m_s, 1.0);
}

TEST(HermesStreamTest, BadPacketsAreCountedByCauseAndNeverDelivered) {
  expect_refused(forged([](Bytes& p) { p[0] = 2; }), PacketError::kVersion);
  expect_refused(forged([](Bytes& p) { p[3] = 10; }), PacketError::kUnknownType);
  expect_refused(forged([](Bytes&) {}, false), PacketError::kChecksum);
  expect_refused(forged([](Bytes& p) { p[7] = 0x80, p[8] = 0x7F; }), PacketError::kNotFinite);
  expect_refused(forged([](Bytes& p) { p[6] = 1, p[7] = 0x80, p[8] = 0xFF; }), PacketError::kNotFinite);
  expect_refused(forged([](Bytes& p) { p.pop_back(); }), PacketError::kTooShort);
  expect_refused(forged([](Bytes& p) { p.push_back(0); }), PacketError::kTooLong);
  expect_refused(forged([](Bytes& p) { p.resize(4 + 1), p[3] = 1; }), PacketError::kDirection);
  expect_refused(forged([](Bytes& p) { p[2] = 9; }), PacketError::kAddress);
  expect_refused(Bytes{9, 1, 2, 0}, PacketError::kFraming);
  expect_refused(Bytes{3, 1, 1, 0}, PacketError::kTooShort);
  expect_refused(Bytes(24, 0x55) + Bytes{0}, PacketError::kFraming);
}

TEST(HermesStreamTest, EmptyFramesBetweenDelimitersAreNotErrors) {
  Bench bench = make_bench();
  bench.write(Bytes{0, 0, 0} + speed(bench, 0, 1.0) + Bytes{0, 0} + speed(bench, 1, 1.0));
  bench.run_to(5 * kMs);
  EXPECT_EQ(bench.sink.heard.size(), 2u);
  EXPECT_EQ(bench.link->from_host().refused(), 0u);
}

TEST(HermesStreamTest, GarbageCostsOneFrameAndTheNextDelimiterResynchronises) {
  Bench bench = make_bench();
  bench.write(speed(bench, 0, 1.0) + Bytes{7, 7, 7} + speed(bench, 1, 1.0) + speed(bench, 2, 1.0));
  bench.run_to(10 * kMs);
  ASSERT_EQ(bench.sink.heard.size(), 2u);
  EXPECT_EQ(bench.sink.heard[1].robot, 2);
  EXPECT_EQ(bench.link->from_host().refused(), 1u);
}

TEST(HermesStreamTest, OverLongFrameIsOneFramingErrorHoweverLong) {
  for (const std::size_t length : {24u, 25u, 100u, 5000u}) {
    Bench bench = make_bench();
    bench.write(Bytes(length, 0x11) + Bytes{0} + speed(bench, 1, 1.0));
    bench.run_to(5 * kMs);
    EXPECT_EQ(bench.refused(PacketError::kFraming), 1u) << length;
    EXPECT_EQ(bench.link->from_host().refused(), 1u) << length;
    EXPECT_EQ(bench.sink.heard.size(), 1u) << length;
  }
}

// A stream of good frames, half frames and garbage, the same for the same seed.
Bytes mixed_stream(const Bench& bench, unsigned seed) {
  std::mt19937 random(seed);
  Bytes stream;
  for (int i = 0; i < 60; ++i) {
    const Bytes frame = speed(bench, i % 6, 0.01 * i);
    const unsigned kind = random() % 4;
    if (kind < 2) stream = stream + frame;
    if (kind == 2)
      stream = stream + Bytes(frame.begin(), frame.begin() + static_cast<std::ptrdiff_t>(random() % 15));
    for (unsigned n = kind == 3 ? random() % 40 : 0; n > 0; --n)
      stream.push_back(static_cast<std::uint8_t>(random()));
  }
  return stream;
}

TEST(HermesStreamTest, BytesOneByOneGiveWhatTheWholeWriteGives) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    Bench whole = make_bench();
    Bench split = make_bench();
    const Bytes stream = mixed_stream(whole, seed);
    whole.write(stream);
    split.write_byte_by_byte(stream);
    whole.run_to(100 * kMs);
    split.run_to(100 * kMs);
    EXPECT_GT(whole.sink.heard.size(), 5u) << "seed " << seed;
    EXPECT_TRUE(same(whole.sink.heard, split.sink.heard)) << "seed " << seed;
    EXPECT_EQ(whole.link->from_host().bad, split.link->from_host().bad) << "seed " << seed;
  }
}

TEST(HermesStreamTest, SameInputTwiceGivesTheSameBytes) {
  const auto run = [] {
    Bench bench = make_bench();
    bench.robots[3].battery_V = 22.2;
    for (unsigned seed = 1; seed <= 10; ++seed) {
      bench.write(mixed_stream(bench, seed) + Bytes{0} + bench.encode("GET_BATTERIE", {{"robot", 3}}));
      bench.run_to(bench.now_ns + 50 * kMs);
    }
    return std::pair(bench.to_host, bench.sink.heard);
  };
  const auto first = run();
  const auto second = run();
  EXPECT_EQ(first.first.size(),
            10 * (6u + 2u));  // ten answers of six bytes, each with COBS code and delimiter
  EXPECT_EQ(first.first, second.first);
  EXPECT_TRUE(same(first.second, second.second));
}

TEST(HermesStreamTest, EveryFlippedBitIsRefusedOrDeliveredAsWhatItSays) {
  Bench reference = make_bench();
  const Bytes frame = speed(reference, 2, 0.7);
  for (std::size_t bit = 0; bit < 8 * (frame.size() - 1); ++bit) {
    Bench bench = make_bench();
    Bytes flipped = frame;
    flipped[bit / 8] ^= static_cast<std::uint8_t>(1u << bit % 8);
    bench.write(flipped + Bytes{0});
    bench.run_to(3 * kMs);
    EXPECT_EQ(bench.sink.heard.size(), bench.good()) << "bit " << bit;
    EXPECT_GE(bench.good() + bench.link->from_host().refused(), 1u) << "bit " << bit;
  }
}

TEST(HermesStreamTest, FloodOfAMillionBytesIsCountedAndTheDongleGoesOn) {
  Bench bench = make_bench();
  std::mt19937 random(7);
  Bytes garbage(1'000'000);
  for (std::uint8_t& byte : garbage) byte = static_cast<std::uint8_t>(random());
  bench.write(garbage + Bytes{0});
  EXPECT_GT(bench.link->from_host().refused(), 3000u);
  EXPECT_EQ(bench.good(), 0u);
  Bytes frames;
  while (frames.size() < 1'000'000) frames = std::move(frames) + speed(bench, 0, 1.0);
  bench.write(frames);
  EXPECT_EQ(bench.good(), 149u);
  bench.run_to(200 * kMs);
  EXPECT_EQ(bench.sink.heard.size(), 149u);
  bench.write(speed(bench, 1, 1.0));
  bench.run_to(210 * kMs);
  EXPECT_EQ(bench.sink.heard.back().robot, 1);
}

}  // namespace
}  // namespace omnihil
