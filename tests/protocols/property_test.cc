// Properties over random input with a fixed seed, and over the fuzzer's corpus.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <map>
#include <random>

#include "tests/fuzz/packet_property.h"
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
    for (int i = 0; i < kFrames; ++i) {
      accepted += survives_round_trip(*format, random_bytes(random, random() % 110)) ? 1 : 0;
    }
    // Chance alone hardly meets type, version and length (REM: 2^-20 per frame) or the sum on top.
    EXPECT_LE(accepted, 5);
    std::printf("%s: %d of %d random frames accepted\n", std::string(format->id).c_str(), accepted, kFrames);
  }
}

TEST(PacketProperty, GoldenPacketsWithRandomBytesInsideAreRefusedOrSurvive) {
  std::mt19937_64 random(20260102);
  std::map<const RadioFormat*, std::pair<int, int>> accepted_of;
  for (const GoldenPacket& packet : golden_packets()) {
    for (int i = 0; i < 500; ++i) {
      Bytes frame = packet.frame;
      for (std::size_t changes = 1 + random() % 4; changes > 0; --changes) {
        frame[random() % frame.size()] = static_cast<std::uint8_t>(random());
      }
      auto& [accepted, all] = accepted_of[packet.format];
      accepted += survives_round_trip(*packet.format, frame) ? 1 : 0;
      ++all;
    }
  }
  for (const RadioFormat* format : radio_formats()) {
    const auto [accepted, all] = accepted_of[format];
    EXPECT_GT(accepted, 0);
    EXPECT_LT(accepted, all);
    std::printf("%s: %d of %d packets with random bytes accepted\n", std::string(format->id).c_str(),
                accepted, all);
  }
}

TEST(PacketProperty, RandomContentsOfEveryPacketSurviveTheWire) {
  std::mt19937_64 random(20260103);
  const auto formats = radio_formats();
  for (std::size_t f = 0; f < formats.size(); ++f) {
    for (std::size_t m = 0; m < formats[f]->messages.size(); ++m) {
      int accepted = 0;
      for (int i = 0; i < 300; ++i) {
        Bytes input{static_cast<std::uint8_t>(0x80u | f), static_cast<std::uint8_t>(m)};
        const Bytes contents = random_bytes(random, 100);
        input.insert(input.end(), contents.begin(), contents.end());
        accepted += check_packet_property(input) ? 1 : 0;
      }
      // Only floats can be refused: one random pattern in 256 is NaN or infinite.
      EXPECT_GT(accepted, 280) << formats[f]->messages[m].name;
    }
  }
}

TEST(PacketProperty, HoldsOverTheFuzzersCorpus) {
  int files = 0;
  int accepted = 0;
  for (const auto& entry : std::filesystem::directory_iterator(OMNIHIL_SOURCE_DIR "/tests/fuzz/corpus")) {
    std::ifstream file(entry.path(), std::ios::binary);
    const Bytes input{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    accepted += check_packet_property(input) ? 1 : 0;
    ++files;
  }
  EXPECT_GE(files, 10);
  EXPECT_GT(accepted, 0);
  EXPECT_LT(accepted, files);
  std::printf("corpus: %d files, %d of them packets\n", files, accepted);
}

}  // namespace
}  // namespace omnihil
