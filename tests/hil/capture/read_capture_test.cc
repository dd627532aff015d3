#include "hil/capture/read_capture.h"

#include <gtest/gtest.h>

#include "hil/capture/asc.h"
#include "hil/capture/candump.h"
#include "hil/capture/decimal_time.h"
#include "hil/capture/pcapng.h"
#include "hil/capture/timed_csv.h"
#include "tests/hil/capture/peers.h"

namespace omnihil {
namespace {

using peers::can_frame;

std::vector<Captured> talk() {
  return {can_frame(1'700'000'000 * kSecond_ns, 0x7E0, {1, 2}, CaptureWay::kFromHost),
          can_frame(1'700'000'001 * kSecond_ns, 0x7E8, {3}, CaptureWay::kToHost),
          can_frame(1'700'000'002 * kSecond_ns, 0x100, {4}, CaptureWay::kToHost)};
}

TEST(ReadCapture, EveryFormIsKnownByHowItBegins) {
  const std::string with_comment = "\xef\xbb\xbf# from the field\n\n" + write_candump(talk(), "can0");
  for (const std::string& text :
       {with_comment, write_asc(talk()), write_pcapng(talk(), "omnihil"), write_timed_csv(talk())}) {
    EXPECT_TRUE(is_capture(text)) << text.substr(0, 60);
    EXPECT_EQ(read_capture(text, "x", {}).pieces, talk());
  }
  for (const char* text :
       {"", "\n", "# {\"format\":\"omnihil-recording/1\"}\n> 0 00\n", "0.5 > 0301\n", "hello", "\x1f\x8b"})
    EXPECT_FALSE(is_capture(text)) << text;
  try {
    read_capture("hello world\n", "x.txt", {});
    ADD_FAILURE();
  } catch (const BadCapture& error) {
    EXPECT_EQ(std::string(error.what()),
              "x.txt: found 'hello world', allowed: pcap, pcapng, candump, asc, CSV of time and hex");
  }
}

Capture udp_between(std::initializer_list<std::pair<int, int>> ports) {
  Capture capture;
  for (const auto& [from, to] : ports) {
    Captured piece;
    piece.carrier = CaptureCarrier::kUdp;
    piece.at_ns = 5 * kSecond_ns + static_cast<std::int64_t>(capture.pieces.size());
    piece.from_port = static_cast<std::uint16_t>(from);
    piece.to_port = static_cast<std::uint16_t>(to);
    piece.bytes = {1};
    capture.pieces.push_back(piece);
  }
  return capture;
}

TEST(HostBytes, OfOneTalkByUdpAreThoseToThePortSpokenToFirst) {
  const HostBytes both = host_bytes(udp_between({{40'000, 10'301}, {10'301, 40'000}}), {}, "x");
  ASSERT_EQ(both.pieces.size(), 2U);
  EXPECT_EQ(both.pieces[0].way, CaptureWay::kFromHost);
  EXPECT_EQ(both.pieces[1].way, CaptureWay::kToHost);
  EXPECT_EQ(both.start_ns, 5 * kSecond_ns);
  EXPECT_EQ(both.pieces[0].at_ns, 0);
  EXPECT_EQ(both.notes.back(), "x: UDP port 10301 is taken as the dongle's");
}

TEST(HostBytes, OfSeveralTalksNeedThePort) {
  const Capture capture = udp_between({{40'000, 10'301}, {10'301, 40'000}, {5, 6}});
  try {
    host_bytes(capture, {}, "x");
    ADD_FAILURE();
  } catch (const BadCapture& error) {
    EXPECT_EQ(std::string(error.what()),
              "x: UDP port of the dongle: found none, allowed: 6 (1 packets), 10301 (1 packets), 40000 (1 "
              "packets)");
  }
  CaptureFilter filter;
  filter.udp_port = 10'301;
  const HostBytes both = host_bytes(capture, filter, "x");
  EXPECT_EQ(both.pieces.size(), 2U);
  EXPECT_EQ(both.notes.back(), "x: 1 packets or frames of others: left out");
}

TEST(HostBytes, OfCanAreThoseOfTheUsualIdsOrOfThoseNamed) {
  Capture capture;
  capture.pieces = talk();
  const HostBytes usual = host_bytes(capture, {}, "x");
  ASSERT_EQ(usual.pieces.size(), 2U);
  EXPECT_EQ(usual.pieces[1].way, CaptureWay::kToHost);
  CaptureFilter filter;
  filter.can_id = 0x100;
  const HostBytes named = host_bytes(capture, filter, "x");
  ASSERT_EQ(named.pieces.size(), 1U);
  EXPECT_EQ(named.pieces[0].bytes, std::vector<std::uint8_t>{4});
  EXPECT_EQ(named.pieces[0].way, CaptureWay::kFromHost);
  filter.can_id = 0x555;
  EXPECT_THROW(host_bytes(capture, filter, "x"), BadCapture);
  for (Captured& each : capture.pieces) each.can_id += 0x10;
  try {
    host_bytes(capture, {}, "x");
    ADD_FAILURE();
  } catch (const BadCapture& error) {
    EXPECT_EQ(std::string(error.what()),
              "x: CAN id of the host: found none, allowed: 110 (1 frames), 7F0 (1 frames), 7F8 (1 frames)");
  }
}

TEST(CanId, IsHexOf29BitsAtMost) {
  EXPECT_EQ(parse_can_id("7E0"), 0x7E0U);
  EXPECT_EQ(parse_can_id("0x1fffffff"), 0x1FFFFFFFU);
  for (const char* text : {"", "0x", "20000000", "7E0h", "-1", "7 E"})
    EXPECT_FALSE(parse_can_id(text)) << text;
}

TEST(CanFrames, OfBytesAreCutAsTheWireForBytesOverCanDoes) {
  std::vector<Captured> pieces(2);
  pieces[0].at_ns = pieces[1].at_ns = 7;
  pieces[0].way = CaptureWay::kFromHost;
  pieces[0].bytes = peers::counting(19);
  pieces[1].way = CaptureWay::kToHost;
  pieces[1].bytes = peers::counting(1, 9);
  const std::vector<Captured> frames = as_can_frames(pieces);
  ASSERT_EQ(frames.size(), 4U);
  EXPECT_EQ(frames[0], can_frame(7, 0x7E0, peers::counting(8), CaptureWay::kFromHost));
  EXPECT_EQ(frames[2], can_frame(7, 0x7E0, peers::counting(3, 16), CaptureWay::kFromHost));
  EXPECT_EQ(frames[3], can_frame(7, 0x7E8, {9}, CaptureWay::kToHost));
  pieces[1].way = CaptureWay::kUnknown;
  EXPECT_THROW(as_can_frames(pieces), BadCapture);
}

}  // namespace
}  // namespace omnihil
