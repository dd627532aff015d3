#include "hil/capture/asc.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "hil/capture/candump.h"
#include "hil/capture/decimal_time.h"
#include "hil/text/recording_text.h"
#include "tests/hil/capture/peers.h"

namespace omnihil {
namespace {

using peers::can_frame;
using peers::counting;
using peers::notes_say;

constexpr std::int64_t kDay_ns = 1'637'161'302'342'000'000;  // 2021-11-17 15:01:42.342 UTC

// As Vector's tools lay it out, with what else stands in such a log.
const char* const kLog =
    "date Wed Nov 17 03:01:42.342 pm 2021\n"
    "base hex  timestamps absolute\n"
    "internal events logged\n"
    "// version 8.5.0\n"
    "Begin Triggerblock Wed Nov 17 03:01:42.342 pm 2021\n"
    "   0.000000 Start of measurement\n"
    "   0.010000 1  7E0             Rx   d 8 00 01 02 03 04 05 06 07  Length = 244000 BitCount = 126 ID = "
    "2016\n"
    "   0.010500 1  7E8             Tx   d 1 01\n"
    "   0.020000 CAN 1 Status:chip status error active\n"
    "   0.030000 1  ErrorFrame\n"
    "   0.040000 1  7E0             Rx   r\n"
    "   0.050000 2  12345678x       Rx   d 0\n"
    "   1.000000 CANFD   1 Rx        7E0                                   1 0 9 12 00 01 02 03 04 05 06 07 "
    "08 09 0A 0B"
    "   130000  130 303000 e0006659 46500250 4b140250 20011736 2001040d\n"
    "   1.100000 CANFD   1 Rx        7E0  Engine_Status                    0 0 3  3 00 01 02   0 0 1000 0 0 "
    "0 0 0\n"
    "End TriggerBlock\n";

TEST(Asc, LogIsRead) {
  const Capture capture = read_asc(kLog, "drive.asc", 0);
  ASSERT_EQ(capture.pieces.size(), 5U);
  EXPECT_EQ(capture.pieces[0], can_frame(kDay_ns + 10'000'000, 0x7E0, counting(8), CaptureWay::kToHost));
  EXPECT_EQ(capture.pieces[1], can_frame(kDay_ns + 10'500'000, 0x7E8, {1}, CaptureWay::kFromHost));
  EXPECT_TRUE(capture.pieces[2].extended);
  EXPECT_EQ(capture.pieces[2].can_id, 0x12345678U);
  EXPECT_TRUE(capture.pieces[3].fd && capture.pieces[3].bitrate_switch);
  EXPECT_EQ(capture.pieces[3].bytes, counting(12));
  EXPECT_EQ(capture.pieces[4].bytes, counting(3));
  EXPECT_FALSE(capture.pieces[4].bitrate_switch);
  EXPECT_TRUE(capture.unix_time);
  for (const char* note : {"drive.asc:6: an event that is no CAN frame: left out (and 1 more of it)",
                           "drive.asc:10: error frame: left out", "drive.asc:11: remote frame: left out",
                           "drive.asc: frames of several channels are taken together",
                           "drive.asc: a date without a time zone: read as UTC"})
    EXPECT_TRUE(notes_say(capture, note)) << note;
}

TEST(Asc, DecimalBaseCountsIdsAndBytesByTen) {
  const Capture capture =
      read_asc("base dec timestamps absolute\n0.5 1 2016 Rx d 2 255 10\n0.6 1 99999 Rx d 0\n", "x", 0);
  ASSERT_EQ(capture.pieces.size(), 1U);
  EXPECT_EQ(capture.pieces[0], can_frame(500'000'000, 0x7E0, {255, 10}, CaptureWay::kToHost));
  EXPECT_TRUE(notes_say(capture, "x:3: an id that is no number of the log's base, or too large"));
  EXPECT_FALSE(capture.unix_time);
  EXPECT_TRUE(notes_say(capture, "no date"));
}

// Relative times count from the event before, whatever it is.
TEST(Asc, RelativeTimesAreSummedOverAllEvents) {
  const Capture capture = read_asc(
      "base hex timestamps relative\n0.1 Start of measurement\n0.2 1 1 Rx d 0\n0.3 1 ErrorFrame\n0.4 1 2 Rx "
      "d 0\n",
      "x", 0);
  ASSERT_EQ(capture.pieces.size(), 2U);
  EXPECT_EQ(capture.pieces[0].at_ns, 300'000'000);
  EXPECT_EQ(capture.pieces[1].at_ns, 1'000'000'000);
}

TEST(Asc, MillisecondsAreTakenWhereTheFileOrTheCallerSaysSo) {
  const char* const frame = "10.5 1 1 Rx d 0\n";
  const Capture seconds = read_asc(std::string("base hex timestamps absolute\n") + frame, "x", 0);
  const Capture said =
      read_asc(std::string("// timestamps in ms\nbase hex timestamps absolute\n") + frame, "x", 0);
  const Capture asked = read_asc(std::string("base hex timestamps absolute\n") + frame, "x", kMillisecond_ns);
  ASSERT_EQ(seconds.pieces.size() + said.pieces.size() + asked.pieces.size(), 3U);
  EXPECT_EQ(seconds.pieces[0].at_ns, 10'500'000'000);
  EXPECT_EQ(said.pieces[0].at_ns, 10'500'000);
  EXPECT_EQ(asked.pieces[0].at_ns, 10'500'000);
  EXPECT_TRUE(notes_say(said, "times are in milliseconds, as the file says"));
}

// A second block counts on from the first, or begins again at its own date.
TEST(Asc, LaterTriggerBlocksCountOnOrBeginAgain) {
  const std::string head =
      "date Wed Nov 17 03:01:42.342 pm 2021\nbase hex timestamps absolute\n"
      "Begin Triggerblock Wed Nov 17 03:01:42.342 pm 2021\n1.0 1 1 Rx d 0\nEnd TriggerBlock\n"
      "Begin Triggerblock Wed Nov 17 03:02:42.342 pm 2021\n";
  const Capture on = read_asc(head + "60.5 1 2 Rx d 0\n", "x", 0);
  const Capture again = read_asc(head + "0.5 1 2 Rx d 0\n", "x", 0);
  ASSERT_EQ(on.pieces.size(), 2U);
  ASSERT_EQ(again.pieces.size(), 2U);
  EXPECT_EQ(on.pieces[1].at_ns, kDay_ns + 60'500'000'000);
  EXPECT_EQ(again.pieces[1].at_ns, kDay_ns + 60'500'000'000);
  EXPECT_EQ(on.pieces[0].at_ns, kDay_ns + 1'000'000'000);
}

TEST(Asc, WhatIsCutOrWrongIsLeftOutAndSaid) {
  const Capture capture = read_asc(
      "date some day\r\n0.1 1 7E0 Rx d 2 01\r\n0.2 1 7E0 Rx d 1 1FF\r\nhello\r\n0.3 1 7E0 Rx d 1 01\r\n0.4 1 "
      "7E0 Rx d 2 0",
      "x", 0);
  ASSERT_EQ(capture.pieces.size(), 1U);
  for (const char* note : {"x: date not understood: some day",
                           "x:2: fewer bytes than its length says: left out (and 1 more of it)",
                           "x:4: no line of an ASC log", "x:6: the last line is cut: left out",
                           "x: lines end with CR LF", "x: no \"base hex\" or \"base dec\": read as hex"})
    EXPECT_TRUE(notes_say(capture, note)) << note;
}

TEST(Asc, IsReadAgainAsItWasWritten) {
  std::vector<Captured> pieces = read_asc(kLog, "x", 0).pieces;
  EXPECT_EQ(read_asc(write_asc(pieces), "x", 0).pieces, pieces);
  for (Captured& each : pieces) each.way = CaptureWay::kToHost;  // ASC has no word for an unknown way
  for (const int size : {0, 1, 7, 8, 12, 16, 20, 24, 32, 48, 64}) {
    Captured frame = can_frame(pieces.back().at_ns + 1000, 0x1FFFFFFF, counting(size), CaptureWay::kFromHost);
    frame.extended = true;
    frame.fd = size > 0;
    frame.bitrate_switch = size > 8;
    pieces.push_back(frame);
  }
  EXPECT_EQ(read_asc(write_asc(pieces), "x", 0).pieces, pieces);
}

TEST(Asc, IsWhatPythonCanWritesAndReads) {
  if (!peers::has_python_can()) GTEST_SKIP() << "python3-can is not installed";
  const fake::TempFolder folder;
  ASSERT_EQ(peers::can_peer("write", folder / "theirs.asc").exit_code, 0);
  ASSERT_EQ(peers::can_peer("write", folder / "theirs.log").exit_code, 0);
  const Capture asc = read_asc(fake::read_text(folder / "theirs.asc"), "theirs.asc", 0);
  const Capture log = read_candump(fake::read_text(folder / "theirs.log"), "theirs.log");
  EXPECT_EQ(asc.pieces, log.pieces);  // the same frames in both of its forms
  ASSERT_EQ(asc.pieces.size(), 7U);
  EXPECT_TRUE(notes_say(asc, "remote frame: left out"));
  EXPECT_TRUE(notes_say(asc, "error frame: left out"));
  fake::write_text(folder / "ours.asc", write_asc(asc.pieces));
  fake::write_text(folder / "ours.log", write_candump(asc.pieces, "can0"));
  const peers::Said read = peers::can_peer("read", folder / "ours.asc");
  EXPECT_EQ(std::ranges::count(read.text, '\n'), 7) << read.text;
  EXPECT_EQ(read.text, peers::can_peer("read", folder / "ours.log").text);
}

// can-utils' converter both ways.
TEST(Asc, IsWhatCanUtilsMakesOfALog) {
  if (!peers::is_installed("log2asc")) GTEST_SKIP() << "can-utils is not installed";
  const fake::TempFolder folder;
  const std::vector<Captured> pieces{can_frame(kDay_ns, 0x7E0, counting(8), CaptureWay::kToHost),
                                     can_frame(kDay_ns + 1'500'000, 0x7E8, {1, 2}, CaptureWay::kToHost)};
  fake::write_text(folder / "a.log", write_candump(pieces, "can0"));
  const std::string file = (folder / "a.").string();
  ASSERT_EQ(peers::run("log2asc -I " + file + "log -O " + file + "asc can0").exit_code, 0);
  const Capture theirs = read_asc(fake::read_text(folder / "a.asc"), "a.asc", 0);
  ASSERT_EQ(theirs.pieces.size(), 2U);
  EXPECT_EQ(theirs.pieces[0].bytes, pieces[0].bytes);
  EXPECT_EQ(theirs.pieces[1].at_ns - theirs.pieces[0].at_ns, 1'500'000);
  fake::write_text(folder / "b.asc", write_asc(pieces));
  const std::string other = (folder / "b.").string();
  ASSERT_EQ(peers::run("asc2log -I " + other + "asc -O " + other + "log").exit_code, 0);
  const Capture back = read_candump(fake::read_text(folder / "b.log"), "b.log");
  ASSERT_EQ(back.pieces.size(), 2U);
  EXPECT_EQ(back.pieces[1].bytes, pieces[1].bytes);
  EXPECT_EQ(back.pieces[1].at_ns - back.pieces[0].at_ns, 1'500'000);
}

TEST(Asc, DamageDoesNoHarm) {
  EXPECT_GT(peers::survive_damage(kLog, 2, [](const std::string& text) { return read_asc(text, "x", 0); }),
            10'000U);
}

// Times that would overflow when they are added: refused or left out, never wrapped.
TEST(Asc, HugeTimesAreLeftOut) {
  std::string text = "date Wed Nov 17 03:01:42.342 pm 2021\nbase hex timestamps relative\n1.0 1 1 Rx d 0\n";
  for (int i = 0; i < 5; ++i) text += "3999999999.0 1 1 Rx d 0\n";
  const Capture capture = read_asc(text, "x", 0);
  ASSERT_EQ(capture.pieces.size(), 1U);
  EXPECT_TRUE(notes_say(capture, "x:4: a time after the year 2096: left out (and 4 more of it)"));
}

}  // namespace
}  // namespace omnihil
