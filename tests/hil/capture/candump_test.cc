#include "hil/capture/candump.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "hil/capture/decimal_time.h"
#include "hil/text/recording_text.h"
#include "tests/hil/capture/peers.h"

namespace omnihil {
namespace {

using peers::can_frame;
using peers::counting;
using peers::notes_say;

constexpr std::int64_t kStart_ns = 1'700'000'000'250'000'000;

// As candump -l of can-utils 2020.11 writes them.
const char* const kLog =
    "(1700000000.250000) can0 7E0#0001020304050607\n"
    "(1700000000.250500) can0 7E8#01\n"
    "(1700000000.500000) can0 12345678#FF00\n"
    "(1700000000.500000) can0 001#\n"
    "(1700000001.250001) can0 7E0##1000102030405060708090A0B\n";

TEST(Candump, LogIsRead) {
  const Capture capture = read_candump(kLog, "bus.log");
  ASSERT_EQ(capture.pieces.size(), 5U);
  EXPECT_EQ(capture.pieces[0], can_frame(kStart_ns, 0x7E0, counting(8)));
  EXPECT_EQ(capture.pieces[1], can_frame(kStart_ns + 500'000, 0x7E8, {1}));
  EXPECT_EQ(capture.pieces[2].can_id, 0x12345678U);
  EXPECT_TRUE(capture.pieces[2].extended);
  EXPECT_FALSE(capture.pieces[3].extended);
  EXPECT_TRUE(capture.pieces[3].bytes.empty());
  EXPECT_TRUE(capture.pieces[4].fd && capture.pieces[4].bitrate_switch);
  EXPECT_EQ(capture.pieces[4].bytes, counting(12));
  EXPECT_TRUE(capture.unix_time);
  EXPECT_TRUE(capture.notes.empty());
}

TEST(Candump, WritesWhatItReads) { EXPECT_EQ(write_candump(read_candump(kLog, "x").pieces, "can0"), kLog); }

TEST(Candump, NineDecimalsAreNanoseconds) {
  const Capture capture = read_candump("(1700000000.250000001) can0 001#00\n", "x");
  ASSERT_EQ(capture.pieces.size(), 1U);
  EXPECT_EQ(capture.pieces[0].at_ns, kStart_ns + 1);
}

TEST(Candump, ConsoleIsReadWithEachKindOfStamp) {
  struct {
    const char* line;
    std::int64_t at_ns;
    CaptureWay way;
  } const cases[] = {
      {"  can0  7E0   [3]  01 02 03\n", 0, CaptureWay::kUnknown},
      {" (1700000000.250000)  can0  7E0   [3]  01 02 03\n", kStart_ns, CaptureWay::kUnknown},
      {" (2023-11-14 22:13:20.250000)  can0  7E0   [3]  01 02 03\n", kStart_ns, CaptureWay::kUnknown},
      {" (000.000500)  can0  7E0   [3]  01 02 03\n", 500'000, CaptureWay::kUnknown},
      {" (000.000500)  can0  TX - -  7E0   [3]  01 02 03   '.#('\n", 500'000, CaptureWay::kFromHost},
      {" (000.000500)  can0  RX - -  7E0   [3]  01 02 03\n", 500'000, CaptureWay::kToHost},
  };
  for (const auto& each : cases) {
    const Capture capture = read_candump(each.line, "x");
    ASSERT_EQ(capture.pieces.size(), 1U) << each.line;
    EXPECT_EQ(capture.pieces[0], can_frame(each.at_ns, 0x7E0, {1, 2, 3}, each.way)) << each.line;
  }
  const Capture fd =
      read_candump(" (000.0)  can0  RX B -  7E0  [12]  00 01 02 03 04 05 06 07 08 09 0A 0B\n", "x");
  ASSERT_EQ(fd.pieces.size(), 1U);
  EXPECT_TRUE(fd.pieces[0].fd && fd.pieces[0].bitrate_switch);
  EXPECT_EQ(fd.pieces[0].bytes, counting(12));
}

TEST(Candump, WhatIsNoDataFrameIsLeftOutAndSaidWithItsLine) {
  const Capture capture = read_candump(
      "(1.000000) can0 001#00\r\n"
      "(1.100000) can0 20000080#0000000000000000\r\n"
      "(1.200000) can0 123#R4\r\n"
      "hello\r\n"
      "(1.300000) can1 002#11\r\n"
      "(1.300000) can1 800#11\r\n"                  // an 11-bit id has no such value
      "(1.300000) can1 002#112233445566778899\r\n"  // nine bytes
      "(1.350000) can1 00#22\r\n"
      "(1.250000) can0 003#33\r\n"
      "(1.400000) can0 004#4",
      "bus.log");
  ASSERT_EQ(capture.pieces.size(), 3U);
  EXPECT_EQ(capture.pieces[1].can_id, 3U);  // sorted by time
  for (const char* note : {"bus.log:2: error frame: left out", "bus.log:3: remote frame: left out",
                           "bus.log:4: no frame of candump: left out (and 3 more of it)",
                           "bus.log:10: the last line is cut: left out", "bus.log: lines end with CR LF",
                           "bus.log: time goes backwards 1 times: sorted by time",
                           "bus.log: frames of several interfaces are taken together: can0, can1"})
    EXPECT_TRUE(notes_say(capture, note)) << note;
}

TEST(Candump, DifferencesAreSummed) {
  std::string text;
  std::vector<std::int64_t> at_ns;
  std::int64_t now_us = 0;
  for (int i = 0; i < 40; ++i) {
    const int gap_us = i == 0 ? 0 : 900 + i * 37 % 200;
    now_us += gap_us;
    at_ns.push_back(now_us * 1000);
    text += fmt::format(" (000.{:06})  can0  123   [1]  {:02X}\n", gap_us, i);
  }
  const Capture capture = read_candump(text, "x");
  ASSERT_EQ(capture.pieces.size(), at_ns.size());
  for (std::size_t i = 0; i < at_ns.size(); ++i) EXPECT_EQ(capture.pieces[i].at_ns, at_ns[i]);
  EXPECT_TRUE(notes_say(capture, "taken as differences"));
}

TEST(Candump, TimesFromZeroThatSwapAreNoDifferences) {
  std::string text;
  for (int i = 0; i < 40; ++i) {
    const int at_us = 1000 * i + (i % 5 == 4 ? -1500 : 0);  // every fifth comes late
    text += fmt::format(" (000.{:06})  can0  123   [1]  {:02X}\n", at_us, i);
  }
  const Capture capture = read_candump(text, "x");
  ASSERT_EQ(capture.pieces.size(), 40U);
  EXPECT_EQ(capture.pieces.back().at_ns, 38'000'000);
  EXPECT_FALSE(notes_say(capture, "taken as differences"));
  EXPECT_TRUE(notes_say(capture, "time goes backwards 8 times"));
}

TEST(Candump, WriterRefusesWhatAFrameCannotHold) {
  const auto refusal = [](std::vector<Captured> pieces) {
    try {
      write_candump(pieces, "can0");
    } catch (const BadCapture& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(refusal({can_frame(1, 1, {}), can_frame(0, 1, {})}),
            "frame 2: time: found 0 ns, allowed: 1 ns or later");
  EXPECT_EQ(refusal({can_frame(0, 0x800, {})}), "frame 1: id: found 800, allowed: 0 to 7FF");
  EXPECT_EQ(refusal({can_frame(0, 1, counting(9))}),
            "frame 1: length: found 9, allowed: 0 to 8, of CAN FD 12, 16, 20, 24, 32, 48, 64");
  Captured serial;
  EXPECT_EQ(refusal({serial}), "frame 1: found no CAN frame, allowed: CAN frames");
  EXPECT_EQ(refusal({can_frame(0, 0x7FF, counting(8))}), "");
}

// All that python-can printed of one frame, as can_peer.py has it.
std::string printed(const Captured& frame) {
  return fmt::format("{} {:X} {} {} {} {}\n", (frame.at_ns + 500) / 1000, frame.can_id,
                     frame.extended ? "EXTENDED" : "STANDARD",
                     frame.bitrate_switch ? "FDBRS"
                     : frame.fd           ? "FD"
                                          : "CLASSIC",
                     frame.way == CaptureWay::kFromHost ? "TX" : "RX",
                     frame.bytes.empty() ? "-" : to_hex(frame.bytes));
}

TEST(Candump, IsWhatPythonCanWritesAndReads) {
  if (!peers::has_python_can()) GTEST_SKIP() << "python3-can is not installed";
  const fake::TempFolder folder;
  const peers::Said wrote = peers::can_peer("write", folder / "theirs.log");
  ASSERT_EQ(wrote.exit_code, 0) << wrote.text;
  const Capture theirs = read_candump(fake::read_text(folder / "theirs.log"), "theirs.log");
  ASSERT_EQ(theirs.pieces.size(), 7U);
  EXPECT_EQ(theirs.pieces[0], can_frame(kStart_ns, 0x7E0, counting(8), CaptureWay::kToHost));
  EXPECT_EQ(theirs.pieces[6].at_ns - theirs.pieces[0].at_ns, 86'400 * kSecond_ns);
  EXPECT_TRUE(notes_say(theirs, "theirs.log:4: remote frame"));
  EXPECT_TRUE(notes_say(theirs, "theirs.log:6: error frame"));
  fake::write_text(folder / "ours.log", write_candump(theirs.pieces, "can0"));
  const peers::Said read = peers::can_peer("read", folder / "ours.log");
  std::string expected;
  for (const Captured& each : theirs.pieces) expected += printed(each);
  EXPECT_EQ(read.text, expected);
}

// log2asc is can-utils' own reader of its logs.
TEST(Candump, IsReadByCanUtils) {
  if (!peers::is_installed("log2asc")) GTEST_SKIP() << "can-utils is not installed";
  const fake::TempFolder folder;
  fake::write_text(folder / "ours.log", write_candump(read_candump(kLog, "x").pieces, "can0"));
  const peers::Said said = peers::run("log2asc -I '" + (folder / "ours.log").string() + "' can0");
  EXPECT_EQ(said.exit_code, 0);
  EXPECT_NE(said.text.find("0.000500 1  7E8             Rx   d 1 01"), std::string::npos) << said.text;
  EXPECT_NE(said.text.find("0.250000 1  12345678x       Rx   d 2 FF 00"), std::string::npos) << said.text;
}

TEST(Candump, DamageDoesNoHarm) {
  const std::string golden = std::string(kLog) + " (1700000002.0) can0  TX B -  7E0   [3]  01 02 03\n";
  EXPECT_GT(peers::survive_damage(golden, 1, [](const std::string& text) { return read_candump(text, "x"); }),
            10'000U);
}

}  // namespace
}  // namespace omnihil
