#include "hil/capture/timed_csv.h"

#include <gtest/gtest.h>

#include "hil/capture/decimal_time.h"
#include "tests/hil/capture/peers.h"

namespace omnihil {
namespace {

using peers::notes_say;

TEST(TimedCsv, ColumnsAreThoseOfItsHeader) {
  const Capture capture = read_timed_csv(
      "Direction;Data;length;Time [ms]\n"
      "TX;03 01 FE;3;33,5\n"
      "RX;0x80 0x01;2;34,25\n",
      "uart.csv", 0);
  ASSERT_EQ(capture.pieces.size(), 2U);
  EXPECT_EQ(capture.pieces[0].at_ns, 33'500'000);
  EXPECT_EQ(capture.pieces[0].way, CaptureWay::kFromHost);
  EXPECT_EQ(capture.pieces[0].bytes, (std::vector<std::uint8_t>{3, 1, 0xFE}));
  EXPECT_EQ(capture.pieces[1].at_ns, 34'250'000);
  EXPECT_EQ(capture.pieces[1].way, CaptureWay::kToHost);
  EXPECT_EQ(capture.pieces[1].bytes, (std::vector<std::uint8_t>{0x80, 1}));
  EXPECT_TRUE(capture.notes.empty());
}

TEST(TimedCsv, UnitsOfTheHeaderHoldUnlessTheCallerSaysOne) {
  struct {
    const char* name;
    std::int64_t ns;
  } const units[] = {{"time", kSecond_ns}, {"time_s", kSecond_ns},       {"Time(s)", kSecond_ns},
                     {"t", kSecond_ns},    {"time_ms", kMillisecond_ns}, {"Time [us]", kMicrosecond_ns},
                     {"timestamp_ns", 1}};
  for (const auto& unit : units) {
    const std::string text = std::string(unit.name) + ",hex\n7,00\n";
    ASSERT_EQ(read_timed_csv(text, "x", 0).pieces.size(), 1U) << unit.name;
    EXPECT_EQ(read_timed_csv(text, "x", 0).pieces[0].at_ns, 7 * unit.ns) << unit.name;
    EXPECT_EQ(read_timed_csv(text, "x", 10).pieces[0].at_ns, 70) << unit.name;
  }
}

TEST(TimedCsv, WithoutAHeaderTheColumnsAreTimeHexWay) {
  const Capture capture = read_timed_csv("1700000000.25\t0301\t<\n1700000000.5\t03:02\n", "x", 0);
  ASSERT_EQ(capture.pieces.size(), 2U);
  EXPECT_EQ(capture.pieces[0].way, CaptureWay::kToHost);
  EXPECT_EQ(capture.pieces[1].bytes, (std::vector<std::uint8_t>{3, 2}));
  EXPECT_EQ(capture.pieces[1].way, CaptureWay::kUnknown);
  EXPECT_TRUE(capture.unix_time);
}

TEST(TimedCsv, WhatIsNoRowIsLeftOutAndSaid) {
  const Capture capture =
      read_timed_csv("time,hex\r\n# a comment\r\n1,00\r\nx,00\r\n2,0\r\n3\r\n0.5,11", "x", 0);
  ASSERT_EQ(capture.pieces.size(), 2U);
  EXPECT_EQ(capture.pieces[0].at_ns, 500'000'000);
  for (const char* note :
       {"x:4: no row of time and hex: left out (and 2 more of it)", "x:7: no line end behind the last line",
        "x: time goes backwards 1 times", "x: lines end with CR LF"})
    EXPECT_TRUE(notes_say(capture, note)) << note;
}

TEST(TimedCsv, IsReadAgainAsItWasWritten) {
  std::vector<Captured> pieces(3);
  pieces[0].at_ns = 1'700'000'000'250'000'001;
  pieces[0].bytes = {1, 2, 0xFF};
  pieces[0].way = CaptureWay::kFromHost;
  pieces[1].at_ns = pieces[0].at_ns + 1;
  pieces[1].bytes = {0};
  pieces[1].way = CaptureWay::kToHost;
  pieces[2].at_ns = pieces[1].at_ns;
  pieces[2].bytes = {7};
  EXPECT_EQ(read_timed_csv(write_timed_csv(pieces), "x", 0).pieces, pieces);
  pieces[1].carrier = CaptureCarrier::kUdp;
  pieces[1].from_port = 40'000;
  pieces[1].to_port = 10'301;
  pieces[2] = peers::can_frame(pieces[1].at_ns, 0x12345, {1});
  pieces[2].extended = true;
  pieces.push_back(peers::can_frame(pieces[1].at_ns, 0x7E0, peers::counting(8)));
  pieces.push_back(peers::can_frame(pieces[1].at_ns, 0x7E0, {}));
  EXPECT_EQ(read_timed_csv(write_timed_csv(pieces), "x", 0).pieces, pieces);
  std::swap(pieces[0], pieces[1]);
  EXPECT_THROW(write_timed_csv(pieces), BadCapture);
}

TEST(TimedCsv, OtherTextIsNone) {
  EXPECT_TRUE(looks_like_timed_csv("time_s,hex"));
  EXPECT_TRUE(looks_like_timed_csv("0.5;00 11"));
  for (const char* line : {"1.0 > 03ff", "1.0\t>\t03ff", "a,b", "", "time only",
                           "# {\"format\":\"omnihil-recording/1\",\"t\":1}", "time_s,duty_1,duty_2"})
    EXPECT_FALSE(looks_like_timed_csv(line)) << line;
}

TEST(TimedCsv, DamageDoesNoHarm) {
  const std::string golden =
      "time_ms,way,data\n33.3,>,03 01 FE\n34,<,80:01\n35.25,,0x11 0x22\n1700000000000.5,>,00\n";
  EXPECT_GT(
      peers::survive_damage(golden, 3, [](const std::string& text) { return read_timed_csv(text, "x", 0); }),
      10'000U);
}

}  // namespace
}  // namespace omnihil
