// A format with a plain dongle is one file; this one, example_plain.cc, drives a robot by that file alone.
#include "protocols/dongles/plain_dongle.h"

#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>

#include "tests/protocols/dongles/example_plain.cc"
#include "tests/protocols/dongles/links_harness.h"

namespace omnihil {
namespace {

const RadioFormat& example() { return radio_format_example_plain(); }
Bytes move(int robot, double forward_m_s) {
  return encode(example(), "MOVE", {{"robot", robot}, {"forward", forward_m_s}});
}

std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

TEST(PlainDongle, AFormatIsOneFileOfUnder300LinesThatNothingElseNames) {
  const std::filesystem::path source(OMNIHIL_SOURCE_DIR);
  const std::string text = text_of(source / "tests/protocols/dongles/example_plain.cc");
  ASSERT_NE(text.find("radio_format_example_plain"), std::string::npos);
  EXPECT_LT(std::count(text.begin(), text.end(), '\n'), 300);
  const std::regex include("#include (\\S+)");
  // Checksums are shared with the buses behind the radio, so they lie below both.
  const std::regex allowed("<\\w+>|\"protocols/.*\\.h\"|\"firmware_iface/checksum\\.h\"");
  for (std::sregex_iterator it(text.begin(), text.end(), include), end; it != end; ++it) {
    EXPECT_TRUE(std::regex_match((*it)[1].str(), allowed)) << (*it)[1];
  }
  for (const char* folder : {"protocols", "hil", "tools"}) {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(source / folder)) {
      if (!entry.is_regular_file()) continue;
      EXPECT_EQ(text_of(entry.path()).find("example_plain"), std::string::npos) << entry.path();
    }
  }
}

TEST(PlainDongle, BytesOfAPacketAreThoseOfItsTable) {
  // forward 1 m/s: (1 + 32.768) / 0.001 = 33768 = 83E8h; 0: 8000h, one less where float32 rounds down
  const Bytes bytes = move(3, 1.0);
  ASSERT_EQ(bytes.size(), 10u);
  EXPECT_EQ(bytes[0], 0x55);
  EXPECT_EQ(bytes[1], 3);
  EXPECT_EQ(bytes[2], 1);
  EXPECT_NEAR(bytes[3] + 256 * bytes[4], 33768, 1);
  int sum = 0;
  for (std::size_t i = 0; i < 9; ++i) sum += bytes[i];
  EXPECT_EQ(bytes[9], sum % 256);
  const DecodeResult decoded = example().decode(bytes);
  ASSERT_EQ(decoded.error, PacketError::kNone);
  EXPECT_NEAR(decoded.values.number("forward"), 1.0, 1e-3);
}

TEST(PlainDongle, CommandsReachTheRobotAfterTheAirTime) {
  Bench bench(example(), {.robot_ids = {3, 5}});
  RobotCommand sent{};
  sent.mode = OMNIHIL_MODE_BODY_VELOCITY;
  sent.v_forward_m_s = 1.5, sent.v_left_m_s = -0.25, sent.omega_body_rad_s = 2.0;
  Bytes bytes;
  ASSERT_TRUE(example().encode_command(sent, {.robot_id = 3}, bytes));
  sent.mode = OMNIHIL_MODE_WHEEL_DUTY;
  sent.duty_ratio[3] = 0.5;
  ASSERT_TRUE(example().encode_command(sent, {.robot_id = 5}, bytes));
  bench.write(bytes);
  bench.run_to(2 * kMs);
  ASSERT_EQ(bench.sink.heard.size(), 2u);
  const Heard& first = bench.sink.heard[0];
  EXPECT_EQ(first.robot, 3);
  EXPECT_EQ(first.at_ns, 300 * kUs);
  EXPECT_EQ(first.message, "MOVE");
  EXPECT_EQ(first.command.mode, unsigned{OMNIHIL_MODE_BODY_VELOCITY});
  EXPECT_NEAR(first.command.v_forward_m_s, 1.5, 1e-3);  // a count is 1 mm/s
  EXPECT_NEAR(first.command.v_left_m_s, -0.25, 1e-3);
  EXPECT_NEAR(first.command.omega_body_rad_s, 2.0, 1e-3);
  EXPECT_EQ(bench.sink.heard[1].robot, 5);
  EXPECT_NEAR(bench.sink.heard[1].command.duty_ratio[3], 0.5, 2.0 / 255);
}

TEST(PlainDongle, RobotAnswersOnceItHasAState) {
  Bench bench(example(), {.robot_ids = {3}});
  bench.write(move(3, 0.0));
  bench.run_to(5 * kMs);
  EXPECT_TRUE(bench.to_host.empty()) << "it is still starting";
  bench.robots[3].battery_V = 15.67;
  bench.run_to(6 * kMs);
  bench.write(move(3, 0.0));
  bench.run_to(6 * kMs + 900 * kUs);
  EXPECT_TRUE(bench.to_host.empty());
  bench.run_to(7 * kMs);  // 300 us there, 700 us back
  EXPECT_EQ(bench.to_host, encode(example(), "STATE", {{"robot", 3}, {"decivolts", 156}}));
  EXPECT_EQ(bench.link->from_robots().good, 1u);
}

TEST(PlainDongle, FirmwareThatDecodesGetsAndSendsFrames) {
  Bench bench(example(), {.robot_ids = {3}, .firmware_decodes = true});
  bench.write(move(3, 1.0));
  bench.run_to(1 * kMs);
  ASSERT_EQ(bench.sink.heard.size(), 1u);
  EXPECT_EQ(bench.sink.heard[0].kind, Delivery::Kind::kFrame);
  EXPECT_EQ(bench.sink.heard[0].frame, move(3, 1.0));
  const Bytes state = encode(example(), "STATE", {{"robot", 3}, {"decivolts", 100}});
  bench.link->robot_frame(3, state, bench.now_ns);
  bench.link->robot_frame(4, state, bench.now_ns);         // no such robot
  bench.link->robot_frame(3, move(3, 1.0), bench.now_ns);  // a robot commands nobody
  bench.run_to(2 * kMs);
  EXPECT_EQ(bench.to_host, state);
  EXPECT_EQ(bench.link->from_robots().bad[static_cast<std::size_t>(PacketError::kAddress)], 1u);
  EXPECT_EQ(bench.link->from_robots().bad[static_cast<std::size_t>(PacketError::kDirection)], 1u);
}

TEST(PlainDongle, BadFramesAreCountedByCauseAndTheNextOneCounts) {
  Bench bench(example(), {.robot_ids = {3}});
  Bytes damaged = move(3, 1.0);
  damaged[4] ^= 0x10;
  bench.write(damaged);
  bench.write({0x00, 0x01, 0x02});  // begins no frame: one error for the run
  bench.write(move(3, 1.0));
  bench.write(encode(example(), "STATE", {{"robot", 3}}));
  bench.write(move(4, 1.0));
  bench.write_byte_by_byte(move(3, 2.0));
  bench.write({0x55, 3});
  bench.link->host_closed(bench.now_ns);
  EXPECT_EQ(bench.refused(PacketError::kChecksum), 1u);
  EXPECT_EQ(bench.refused(PacketError::kFraming), 1u);
  EXPECT_EQ(bench.refused(PacketError::kDirection), 1u);
  EXPECT_EQ(bench.refused(PacketError::kAddress), 1u);
  EXPECT_EQ(bench.refused(PacketError::kTooShort), 1u);
  EXPECT_EQ(bench.good(), 2u);
}

TEST(PlainDongle, FloodFillsTheAirAndLosesTheRest) {
  Bench bench(example(), {.robot_ids = {3}});
  for (int i = 0; i < 200; ++i) bench.write(move(3, 1.0));
  EXPECT_EQ(bench.good(), 128u);
  EXPECT_EQ(bench.refused(PacketError::kOverrun), 72u);
  bench.run_to(1 * kMs);
  EXPECT_EQ(bench.sink.heard.size(), 128u);
}

}  // namespace
}  // namespace omnihil
