// Properties over random input with a fixed seed, and over the fuzzer's corpus.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <map>
#include <random>

#include "tests/fuzz/packet_property.h"
#include "tests/protocols/accepted_share.h"
#include "tests/protocols/packet_util.h"

namespace omnihil {
namespace {

Bytes random_bytes(std::mt19937_64& random, std::size_t size) {
  Bytes bytes(size);
  for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
  return bytes;
}

TEST(PacketProperty, RandomBytesAreRefusedWithACauseOrSurviveTheRoundTrip) {
  std::mt19937_64 random(20260101);
  for (const RadioFormat* format : radio_formats()) {
    int accepted = 0;
    constexpr int kFrames = 20000;
    double expected = 0.0;
    for (int i = 0; i < kFrames; ++i) {
      const std::size_t bytes = random() % (static_cast<std::size_t>(format->max_frame_bytes) + 2);
      accepted += survives_round_trip(*format, random_bytes(random, bytes)) ? 1 : 0;
      expected += frames_share(*format, bytes);
    }
    EXPECT_NEAR(accepted, expected, count_slack(expected)) << format->id;
    std::printf("%s: %d of %d random frames accepted, %.2g expected\n", std::string(format->id).c_str(),
                accepted, kFrames, expected);
  }
}

TEST(PacketProperty, GoldenPacketsWithRandomBytesInsideAreRefusedOrSurvive) {
  std::mt19937_64 random(20260102);
  struct Count {
    int accepted = 0;
    int as_it_was = 0;  // the random bytes were those that stood there
    int all = 0;
  };
  std::map<const RadioFormat*, Count> counts;
  for (const GoldenPacket& packet : golden_packets()) {
    for (int i = 0; i < 500; ++i) {
      Bytes frame = packet.frame;
      for (std::size_t changes = 1 + random() % 4; changes > 0; --changes) {
        frame[random() % frame.size()] = static_cast<std::uint8_t>(random());
      }
      Count& count = counts[packet.format];
      count.accepted += survives_round_trip(*packet.format, frame) ? 1 : 0;
      count.as_it_was += frame == packet.frame ? 1 : 0;
      ++count.all;
    }
  }
  for (const RadioFormat* format : radio_formats()) {
    const Count& count = counts[format];
    EXPECT_GE(count.accepted, count.as_it_was) << format->id;
    EXPECT_LT(count.accepted, count.all) << format->id;  // the type's byte is among those changed
    std::printf("%s: %d of %d packets with random bytes accepted\n", std::string(format->id).c_str(),
                count.accepted, count.all);
  }
}

TEST(PacketProperty, RandomContentsOfEveryPacketSurviveTheWire) {
  std::mt19937_64 random(20260103);
  const auto formats = radio_formats();
  for (std::size_t f = 0; f < formats.size(); ++f) {
    for (std::size_t m = 0; m < formats[f]->messages.size(); ++m) {
      int accepted = 0;
      constexpr int kContents = 300;
      for (int i = 0; i < kContents; ++i) {
        Bytes input{static_cast<std::uint8_t>(0x80u | f), static_cast<std::uint8_t>(m)};
        const auto size = static_cast<std::size_t>(formats[f]->messages[m].size_bytes);
        const Bytes contents = random_bytes(random, std::max<std::size_t>(size, 100));
        input.insert(input.end(), contents.begin(), contents.end());
        accepted += check_packet_property(input) ? 1 : 0;
      }
      const double share = contents_share(formats[f]->messages[m]);
      EXPECT_NEAR(accepted, kContents * share, count_slack(kContents * share * (1.0 - share)))
          << formats[f]->id << " " << formats[f]->messages[m].name;
    }
  }
}

// The corpus names formats by their place in the list, which a new one moves: each file goes through all of them.
TEST(PacketProperty, HoldsOverTheFuzzersCorpus) {
  const auto formats = radio_formats();
  int inputs = 0;
  int accepted = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(OMNIHIL_SOURCE_DIR "/tests/fuzz/corpus/packets")) {
    std::ifstream file(entry.path(), std::ios::binary);
    Bytes input{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    ASSERT_FALSE(input.empty()) << entry.path();
    for (std::size_t f = 0; f < formats.size(); ++f) {
      input[0] = static_cast<std::uint8_t>((input[0] & 0x80u) | f);
      accepted += check_packet_property(input) ? 1 : 0;
      ++inputs;
    }
  }
  EXPECT_GE(inputs, 10);
  EXPECT_GT(accepted, 0);
  EXPECT_LT(accepted, inputs);
  std::printf("corpus: %d inputs, %d of them packets\n", inputs, accepted);
}

}  // namespace
}  // namespace omnihil
