// Recordings as captures of other tools: pcap by its own bytes, MCAP by @mcap/core.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstring>
#include <nlohmann/json.hpp>

#include "hil/recording/mcap_export.h"
#include "hil/recording/pcap_export.h"
#include "hil/recording/recorded_packets.h"
#include "hil/text/json_text.h"
#include "tests/hil/recording/real_run.h"

namespace omnihil {
namespace {

const Recording& recording() {
  static const Recording made = real::record(real::setup(real::kHermes), 2500);
  return made;
}
const RadioFormat& format() { return *find_radio_format(recording().header.radio_format); }

std::uint32_t u32(const std::string& bytes, std::size_t at) {
  std::uint32_t value = 0;
  std::memcpy(&value, bytes.data() + at, sizeof value);  // little endian, as every computer that this runs on
  return value;
}

TEST(AllPackets, AreThoseOfBothWaysInTheOrderOfTheirTimes) {
  const auto all = all_packets(recording(), format());
  std::size_t from_host = 0, refused = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    from_host += all[i].from_host ? 1 : 0;
    refused += all[i].packet.frame.understood ? 0 : 1;
    EXPECT_LE(all[i > 0 ? i - 1 : 0].packet.now_ns, all[i].packet.now_ns);
  }
  EXPECT_EQ(all.size() - from_host, dongle_packets(recording(), format()).size());
  EXPECT_GT(from_host, 200U);
  EXPECT_GT(refused, 0U);  // the host sent damage too
  std::size_t bytes = 0, written = 0;
  for (const PassedPacket& passed : all) bytes += passed.from_host ? passed.packet.frame.bytes.size() : 0;
  for (const RecordedChunk& chunk : recording().chunks)
    written += chunk.kind == RecordedChunk::Kind::kHostBytes ? chunk.bytes.size() : 0;
  EXPECT_EQ(bytes, written);  // none lost, none twice
}

TEST(Pcap, HasEveryPacketAtItsTime) {
  const std::string file = pcap_of(recording(), format());
  const auto all = all_packets(recording(), format());
  EXPECT_EQ(u32(file, 0), 0xa1b23c4dU);
  EXPECT_EQ(u32(file, 20), 147U);
  std::size_t at = 24;
  for (const PassedPacket& passed : all) {
    ASSERT_LE(at + 16, file.size());
    const std::uint64_t ns = u32(file, at) * 1'000'000'000ULL + u32(file, at + 4);
    EXPECT_EQ(ns, recording().header.epoch_ms * 1'000'000 + static_cast<std::uint64_t>(passed.packet.now_ns));
    const auto& bytes = passed.packet.frame.bytes;
    ASSERT_EQ(u32(file, at + 8), bytes.size());
    EXPECT_EQ(std::memcmp(file.data() + at + 16, bytes.data(), bytes.size()), 0);
    at += 16 + bytes.size();
  }
  EXPECT_EQ(at, file.size());
}

std::string as_json(const Values& values) {
  nlohmann::ordered_json fields;
  for (std::size_t i = 0; i < values.message->fields.size(); ++i)
    fields[std::string(values.message->fields[i].name)] = values.fields[i].number;
  return json_text({{"packet", values.message->name}, {"fields", fields}});
}

TEST(Mcap, IsReadBackByTheirLibrary) {
  fake::TempFolder folder;
  const std::string file = folder / "run.mcap";
  fake::write_text(file, mcap_of(recording(), format(), as_json));
  const std::string command = "OMNIHIL_MCAP_NPM='" OMNIHIL_BUILD_DIR "/npm/mcap' node '" OMNIHIL_SOURCE_DIR
                              "/tests/mcap/read.mjs' '" +
                              file + "' 2>&1";
  std::FILE* pipe = ::popen(command.c_str(), "r");
  ASSERT_NE(pipe, nullptr);
  std::string said;
  char buffer[4096];
  for (std::size_t n; (n = std::fread(buffer, 1, sizeof buffer, pipe)) > 0;) said.append(buffer, n);
  const int status = ::pclose(pipe);
  if (WEXITSTATUS(status) == 77 || WEXITSTATUS(status) == 127) GTEST_SKIP() << said;
  ASSERT_EQ(status, 0) << said;
  const auto read = json_of(said);
  std::size_t samples = 0, packets = 0;
  for (const RecordedChunk& chunk : recording().chunks)
    samples += chunk.kind == RecordedChunk::Kind::kSample ? 1 : 0;
  for (const PassedPacket& passed : all_packets(recording(), format()))
    packets += passed.packet.frame.understood ? 1 : 0;
  EXPECT_EQ(read["statistics"], samples + packets);
  EXPECT_EQ(read["topics"]["/robot0"].get<std::size_t>() + read["topics"]["/robot3"].get<std::size_t>(),
            samples);
  EXPECT_EQ(read["topics"], read["again"]);  // by its indexes as in a row
  EXPECT_EQ(read["ordered"], true);
  EXPECT_EQ(read["schemas"]["/robot0"], "object");
  EXPECT_EQ(read["start"], std::to_string(recording().header.epoch_ms * 1'000'000));
}

}  // namespace
}  // namespace omnihil
