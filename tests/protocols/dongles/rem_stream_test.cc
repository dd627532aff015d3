// REM on the USB side: packets out of raw bytes, what a bad one costs, half packets, floods.
#include <random>

#include "tests/protocols/dongles/links_harness.h"

namespace omnihil {
namespace {

class RemStreamTest : public ::testing::TestWithParam<const char*> {
 protected:
  Bench make_bench() const {
    Bench bench(GetParam(), {.robot_ids = {0, 1, 2, 3, 4, 5}});
    bench.boot_robots();
    bench.step();
    return bench;
  }
  // Header bytes: v8 11, v5 10; the last one is payloadSize.
  static std::size_t size_at(const Bench& bench) {
    return static_cast<std::size_t>(bench.format.find("REM_Packet")->size_bytes) - 1;
  }
};

Bytes command(const Bench& bench, int robot, double rho = 1.0) {
  return bench.encode("REM_RobotCommand", {{"toRobotId", robot}, {"rho", rho}});
}
Bytes first(const Bytes& bytes, std::size_t n) {
  return Bytes(bytes.begin(), bytes.begin() + static_cast<long>(n));
}
Bytes from(const Bytes& bytes, std::size_t n) {
  return Bytes(bytes.begin() + static_cast<long>(n), bytes.end());
}

INSTANTIATE_TEST_SUITE_P(Versions, RemStreamTest, ::testing::Values("roboteam-rem-v8", "roboteam-rem-v5"),
                         [](const auto& param) { return std::string(param.param).substr(13); });

TEST_P(RemStreamTest, PacketsFollowEachOtherWithoutFraming) {
  Bench bench = make_bench();
  Bytes all;
  for (int id = 0; id < 6; ++id) all = all + command(bench, id) + bench.encode("REM_SX1280Filler", {});
  bench.write(all);
  bench.run_to(20 * kMs);
  EXPECT_EQ(bench.good(), 12u);
  EXPECT_EQ(bench.sink.heard.size(), 6u);
}

TEST_P(RemStreamTest, BadPacketIsCountedByCauseAndTheRestOfItsTransferIsLost) {
  struct Case {
    PacketError cause;
    std::size_t byte;
    std::uint8_t value;
  };
  const std::size_t size = size_at(make_bench());
  for (const Case& bad : {Case{PacketError::kVersion, 3, 0xF0}, Case{PacketError::kUnknownType, 0, 0x99},
                          Case{PacketError::kLength, size, 29}}) {
    Bench bench = make_bench();
    Bytes broken = command(bench, 1);
    broken[bad.byte] = bad.value;
    bench.write(command(bench, 0) + broken + command(bench, 2));
    bench.run_to(2 * kMs);
    bench.write(command(bench, 3));
    bench.run_to(20 * kMs);
    EXPECT_EQ(bench.refused(bad.cause), 1u) << to_string(bad.cause);
    EXPECT_EQ(bench.link->from_host().refused(), 1u) << to_string(bad.cause);
    ASSERT_EQ(bench.sink.heard.size(), 2u) << to_string(bad.cause);
    EXPECT_EQ(bench.sink.heard[0].robot, 3);  // slot 0 was over before slot 3 came
    EXPECT_EQ(bench.sink.heard[1].robot, 0);
    EXPECT_EQ(bench.answers("REM_Log").size(), 1u) << to_string(bad.cause);
  }
}

TEST_P(RemStreamTest, PacketOfTheOtherVersionIsAVersionError) {
  Bench bench = make_bench();
  const bool v8 = bench.format.id == "roboteam-rem-v8";
  Bench other(v8 ? "roboteam-rem-v5" : "roboteam-rem-v8", {.robot_ids = {1}});
  bench.write(command(other, 1));
  bench.run_to(20 * kMs);
  EXPECT_EQ(bench.refused(PacketError::kVersion), 1u);
  EXPECT_TRUE(bench.sink.heard.empty());
}

TEST_P(RemStreamTest, PacketCutByTheHostIsPutTogetherWithinFiveMilliseconds) {
  const Bytes packet = command(make_bench(), 2);
  for (std::size_t cut = 1; cut < packet.size(); ++cut) {
    Bench bench = make_bench();
    bench.write(first(packet, cut));
    bench.run_to(3 * kMs);
    bench.write(from(packet, cut));
    bench.run_to(30 * kMs);
    EXPECT_EQ(bench.sink.heard.size(), 1u) << cut;
    EXPECT_EQ(bench.link->from_host().refused(), 0u) << cut;
  }
}

TEST_P(RemStreamTest, HalfPacketIsGivenUpAfterFiveMillisecondsAndTheNextOneCounts) {
  const Bytes packet = command(make_bench(), 2);
  for (std::size_t cut = 1; cut < packet.size(); ++cut) {
    Bench bench = make_bench();
    bench.write(first(packet, cut));
    bench.run_to(5 * kMs);
    EXPECT_EQ(bench.refused(PacketError::kTooShort), 1u) << cut;
    bench.write(packet);
    bench.run_to(30 * kMs);
    EXPECT_EQ(bench.sink.heard.size(), 1u) << cut;
    EXPECT_EQ(bench.link->from_host().refused(), 1u) << cut;
  }
}

TEST_P(RemStreamTest, ClosingCountsAHalfPacketOnceAndLeavesTheQueuesToTheRobots) {
  Bench bench = make_bench();
  bench.write(command(bench, 1) + first(command(bench, 2), 12));
  bench.link->host_closed(bench.now_ns);
  bench.link->host_closed(bench.now_ns);
  bench.write(command(bench, 3));
  bench.run_to(20 * kMs);
  EXPECT_EQ(bench.refused(PacketError::kTooShort), 1u);
  EXPECT_EQ(bench.link->from_host().refused(), 1u);
  EXPECT_EQ(bench.sink.heard.size(), 2u);
}

// Good packets with, now and then, a broken or a cut one; one transfer per call.
std::vector<Bytes> mixed_transfers(const Bench& bench, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<Bytes> transfers;
  for (int i = 0; i < 60; ++i) {
    Bytes transfer;
    for (unsigned n = 1 + random() % 4; n > 0; --n) {
      Bytes packet = command(bench, static_cast<int>(random() % 7), 0.01 * i);
      if (random() % 6 == 0)
        packet[random() % packet.size()] ^= static_cast<std::uint8_t>(1u << random() % 8);
      if (random() % 12 == 0) packet.resize(random() % packet.size());
      transfer = transfer + packet + bench.encode("REM_RobotGetPIDGains", {{"toRobotId", random() % 6}});
    }
    transfers.push_back(transfer);
  }
  return transfers;
}

struct Outcome {
  std::vector<Heard> heard;
  Bytes to_host;
  PacketCounts counts;
};
Outcome play(Bench bench, unsigned seed, bool byte_by_byte) {
  bench.robots[2].battery_V = 22.2;
  for (const Bytes& transfer : mixed_transfers(bench, seed)) {
    byte_by_byte ? bench.write_byte_by_byte(transfer) : bench.write(transfer);
    bench.run_to(bench.now_ns + 10 * kMs, kMs);
  }
  return {bench.sink.heard, bench.to_host, bench.link->from_host()};
}

TEST_P(RemStreamTest, BytesOneByOneGiveWhatTheWholeWriteGives) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const Outcome whole = play(make_bench(), seed, false);
    const Outcome split = play(make_bench(), seed, true);
    EXPECT_GT(whole.heard.size(), 20u) << "seed " << seed;
    EXPECT_GT(whole.counts.refused(), 5u) << "seed " << seed;
    EXPECT_TRUE(same(whole.heard, split.heard)) << "seed " << seed;
    EXPECT_EQ(whole.to_host, split.to_host) << "seed " << seed;
    EXPECT_EQ(whole.counts.good, split.counts.good) << "seed " << seed;
    EXPECT_EQ(whole.counts.bad, split.counts.bad) << "seed " << seed;
  }
}

TEST_P(RemStreamTest, SameInputTwiceGivesTheSameBytes) {
  const Outcome one = play(make_bench(), 5, false);
  const Outcome two = play(make_bench(), 5, false);
  EXPECT_GT(one.to_host.size(), 1000u);
  EXPECT_EQ(one.to_host, two.to_host);
  EXPECT_TRUE(same(one.heard, two.heard));
}

TEST_P(RemStreamTest, EveryFlippedBitIsRefusedOrDelivered) {
  Bench reference = make_bench();
  const Bytes packet = command(reference, 2);
  std::size_t delivered = 0;
  for (std::size_t bit = 0; bit < 8 * packet.size(); ++bit) {
    Bench bench = make_bench();
    Bytes flipped = packet;
    flipped[bit / 8] ^= static_cast<std::uint8_t>(1u << bit % 8);
    bench.write(flipped);
    bench.run_to(30 * kMs, kMs);
    const std::uint64_t refused = bench.link->from_host().refused();
    EXPECT_EQ(bench.good() + refused, 1u) << "bit " << bit;
    if (refused == 1) {
      EXPECT_TRUE(bench.sink.heard.empty()) << "bit " << bit;
    }
    delivered += bench.sink.heard.size();
  }
  EXPECT_GT(delivered, 8 * packet.size() / 2);  // no checksum: most bits change their own field only
}

TEST_P(RemStreamTest, FloodOfAMillionBytesOfGarbageCostsOneTransferEach) {
  Bench bench = make_bench();
  std::mt19937 random(3);
  Bytes garbage(1'000'000);
  for (std::uint8_t& byte : garbage) byte = static_cast<std::uint8_t>(random());
  garbage[3] = 0;  // no version has number 0
  bench.write(garbage);
  EXPECT_EQ(bench.link->from_host().refused(), 1u);
  bench.run_to(1 * kMs);
  bench.write(command(bench, 1));
  bench.run_to(20 * kMs);
  EXPECT_EQ(bench.sink.heard.size(), 1u);
}

TEST_P(RemStreamTest, FloodOfAMillionBytesOfGoodPacketsFillsTheQueueOnly) {
  Bench bench = make_bench();
  const Bytes ask = bench.encode("REM_RobotGetPIDGains", {{"toRobotId", 1}});
  const std::size_t packets = 1'000'000 / ask.size();
  Bytes flood;
  flood.reserve(packets * ask.size());
  for (std::size_t i = 0; i < packets; ++i) flood.insert(flood.end(), ask.begin(), ask.end());
  bench.write(flood);
  EXPECT_EQ(bench.good(), 40u);
  EXPECT_EQ(bench.refused(PacketError::kOverrun), packets - 40);
  bench.run_to(200 * kMs, kMs);
  EXPECT_LT(bench.to_host.size(), 4000u);
}

TEST_P(RemStreamTest, HostThatDoesNotReadLosesAnswersAndNothingElse) {
  Bench bench = make_bench();
  for (int i = 0; i < 3000; ++i) {
    bench.write(bench.encode("REM_BasestationGetConfiguration", {{"toBS", 1}}));
    bench.link->poll(bench.now_ns, bench.sink);
    for (int n = 0; n < 2; ++n) bench.write(bench.encode("REM_BasestationGetConfiguration", {{"toBS", 1}}));
  }
  EXPECT_GT(bench.refused(PacketError::kOverrun), 1000u);
  bench.link->take_host_bytes(bench.now_ns, bench.to_host);
  EXPECT_LE(bench.to_host.size(), 65536u);
  EXPECT_GT(bench.to_host.size(), 65000u);
}

}  // namespace
}  // namespace omnihil
