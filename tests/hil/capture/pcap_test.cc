#include "hil/capture/pcap.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "hil/capture/decimal_time.h"
#include "hil/capture/pcapng.h"
#include "hil/text/recording_text.h"
#include "tests/hil/capture/pcap_builder.h"
#include "tests/hil/capture/peers.h"

namespace omnihil {
namespace {

using namespace peers;

constexpr std::int64_t kStart_ns = 1'700'000'000 * kSecond_ns;
constexpr int kEthernet = 1, kNull = 0, kRaw = 101, kSll = 113, kUser0 = 147, kCan = 227, kSll2 = 276;
const std::vector<std::uint8_t> kPayload{'a', 'b', 'c'};

Captured only_piece(int link, const std::string& packet) {
  const Capture capture = read_pcap(pcap_file(false, true, link, {packet}), "x");
  EXPECT_EQ(capture.pieces.size(), 1U) << link;
  return capture.pieces.empty() ? Captured() : capture.pieces[0];
}

TEST(Pcap, EveryByteOrderAndResolutionGivesTheSameTimes) {
  const std::vector<std::string> packets{"one", "two", "three"};
  std::vector<std::string> files;
  for (const bool big : {false, true})
    for (const bool nanoseconds : {false, true})
      files.push_back(pcap_file(big, nanoseconds, kUser0, packets));
  for (const bool big : {false, true}) {
    for (const int resolution : {-1, 9}) {
      std::string file = section(big) + peers::interface(big, kUser0, resolution);
      const std::uint64_t per_s = resolution == 9 ? 1'000'000'000 : 1'000'000;
      for (std::uint64_t i = 0; i < packets.size(); ++i)
        file += packet(big, 1'700'000'000 * per_s + i * per_s / 1000, packets[i]);
      files.push_back(file);
    }
  }
  for (const std::string& file : files) {
    ASSERT_TRUE(looks_like_pcap(file));
    const Capture capture = read_pcap(file, "x");
    ASSERT_EQ(capture.pieces.size(), 3U);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_EQ(capture.pieces[i].at_ns, kStart_ns + static_cast<std::int64_t>(i) * kMillisecond_ns);
      EXPECT_EQ(std::string(capture.pieces[i].bytes.begin(), capture.pieces[i].bytes.end()), packets[i]);
      EXPECT_EQ(capture.pieces[i].carrier, CaptureCarrier::kSerial);
    }
    EXPECT_TRUE(capture.notes.empty());
  }
}

TEST(Pcap, NanosecondsAreNotLost) {
  std::string file =
      section(true) + peers::interface(true, kUser0, 9) + packet(true, 1'700'000'000'000'000'001, "x");
  EXPECT_EQ(read_pcap(file, "x").pieces.at(0).at_ns, kStart_ns + 1);
  file = section(false) + peers::interface(false, kUser0, 0x8A, 1'700'000'000) + packet(false, 512, "x");
  EXPECT_EQ(read_pcap(file, "x").pieces.at(0).at_ns, kStart_ns + kSecond_ns / 2);  // 512 of 1024 a second
}

TEST(Pcap, UdpIsFoundInEveryLinkType) {
  const std::string v4 = ipv4(udp(40'000, 10'301, "abc")), v6 = ipv6(udp(40'000, 10'301, "abc"));
  const std::string vlan = net().u16(7).u16(0x0800).bytes(v4).text;
  const std::vector<std::pair<int, std::string>> packets{
      {kEthernet, ethernet(v4)},
      {kEthernet, ethernet(v6, 0x86DD)},
      {kEthernet, ethernet(vlan, 0x8100)},
      {kEthernet, ethernet(v4) + std::string(30, '\0')},  // padded
      {kSll, cooked(v4, 0, 0x0800)},
      {kSll, cooked(v6, 0, 0x86DD)},
      {kSll2, cooked2(v4, 0, 0x0800)},
      {kRaw, v4},
      {kRaw, v6},
      {kNull, std::string("\2\0\0\0", 4) + v4}};
  for (const auto& [link, bytes] : packets) {
    const Captured piece = only_piece(link, bytes);
    EXPECT_EQ(piece.carrier, CaptureCarrier::kUdp);
    EXPECT_EQ(piece.from_port, 40'000) << link;
    EXPECT_EQ(piece.to_port, 10'301) << link;
    EXPECT_EQ(piece.bytes, kPayload) << link;
  }
}

TEST(Pcap, CanFramesAreFoundBareAndCooked) {
  const Captured bare = only_piece(kCan, socketcan(0x7E0, "abc"));
  EXPECT_EQ(bare, can_frame(kStart_ns, 0x7E0, kPayload));
  EXPECT_TRUE(only_piece(kCan, socketcan(0x92345678, "abc")).extended);
  EXPECT_EQ(only_piece(kCan, socketcan(0x92345678, "abc")).can_id, 0x12345678U);
  const Captured fd = only_piece(kCan, socketcan(0x7E0, "abc", 0x05));
  EXPECT_TRUE(fd.fd && fd.bitrate_switch);
  EXPECT_EQ(only_piece(kSll, cooked(socketcan(0x7E0, "abc"), 4, 0x000C)).way, CaptureWay::kFromHost);
  EXPECT_EQ(only_piece(kSll, cooked(socketcan(0x7E0, "abc"), 0, 0x000C)).way, CaptureWay::kToHost);
  EXPECT_TRUE(only_piece(kSll2, cooked2(socketcan(0x7E0, "abc"), 0, 0x000D)).fd);
}

TEST(Pcap, WhatIsNoDataIsLeftOutAndSaidWithItsPacket) {
  const Capture can =
      read_pcap(pcap_file(false, true, kCan,
                          {socketcan(1, "x"), socketcan(0x20000080, "12345678"), socketcan(0x40000001, ""),
                           std::string("\0\0\0\1\5\0\0\0x", 9), "short", socketcan(2, "")}),
                "bus.pcap");
  ASSERT_EQ(can.pieces.size(), 2U);
  EXPECT_TRUE(can.pieces[1].bytes.empty());  // a frame says something without data, too
  for (const char* note : {"bus.pcap:packet 2: error frame", "bus.pcap:packet 3: remote frame",
                           "bus.pcap:packet 4: a CAN frame that is cut: left out (and 1 more of it)"})
    EXPECT_TRUE(notes_say(can, note)) << note;
  const std::string tcp = ethernet(ipv4("0123456789abcdefghij", 6)), arp = ethernet("x", 0x0806);
  const std::string fragment = ethernet(ipv4(udp(1, 2, "x"), 17, 0x2000));
  std::string short_udp = udp(1, 2, "xyz");
  short_udp.pop_back();
  const Capture lan =
      read_pcap(pcap_file(false, true, kEthernet,
                          {tcp, arp, fragment, ethernet(ipv4(short_udp)), ethernet(ipv4(udp(1, 2, "")))}),
                "lan.pcap");
  EXPECT_TRUE(lan.pieces.empty());
  for (const char* note :
       {"lan.pcap:packet 1: a packet that is neither UDP nor CAN: left out (and 1 more of it)",
        "lan.pcap:packet 3: a fragment of a UDP packet", "lan.pcap:packet 4: a UDP packet that is cut",
        "lan.pcap:packet 5: a packet without payload"})
    EXPECT_TRUE(notes_say(lan, note)) << note;
}

// A damaged fraction of a second is no time, and none below 0.
TEST(Pcap, TimesThatAreNoneAreLeftOut) {
  for (const bool nanoseconds : {false, true}) {
    std::string file = pcap_file(false, nanoseconds, kUser0, {"one", "two"});
    file.replace(24 + 4, 4, "\xff\xff\xff\xff");
    const Capture capture = read_pcap(file, "x");
    ASSERT_EQ(capture.pieces.size(), 1U);
    EXPECT_EQ(capture.pieces[0].at_ns, kStart_ns + kMillisecond_ns);
    EXPECT_TRUE(notes_say(capture, "x:packet 1: a time before 1970, after 2096, or that is none: left out"));
  }
}

TEST(Pcap, UnknownLinkTypesAreRefusedByName) {
  try {
    read_pcap(pcap_file(false, true, 105, {"x"}), "air.pcap");
    ADD_FAILURE();
  } catch (const BadCapture& error) {
    EXPECT_EQ(std::string(error.what()),
              "air.pcap: link type: found IEEE802_11, allowed: Ethernet, Linux cooked, raw IP, "
              "loopback, SocketCAN, USER0");
  }
}

TEST(Pcapng, WaysAreThoseOfEachPacketInEitherByteOrder) {
  for (const bool big : {false, true}) {
    const std::string two =
        section(big) + peers::interface(big, kUser0, 9) + peers::interface(big, kUser0, 6);
    const Capture capture = read_pcap(two + packet(big, 1'000, "a", 2, 0) + block(big, 5, "statistics..") +
                                          packet(big, 2, "b", 1, 1) + packet(big, 3'000, "c", 0, 0) +
                                          packet(big, 4'000, "d", 2, 0),
                                      "x");
    ASSERT_EQ(capture.pieces.size(), 4U);
    EXPECT_EQ(capture.pieces[0].way, CaptureWay::kFromHost);
    EXPECT_EQ(capture.pieces[1].way, CaptureWay::kToHost);
    EXPECT_EQ(capture.pieces[2].way, CaptureWay::kUnknown);
    EXPECT_EQ(capture.pieces[3].way, CaptureWay::kFromHost);
    EXPECT_EQ(capture.pieces[1].at_ns, 2'000);  // the second interface counts microseconds
  }
}

std::vector<Captured> both_ways(CaptureCarrier carrier) {
  std::vector<Captured> pieces;
  for (int i = 0; i < 20; ++i) {
    Captured piece = can_frame(kStart_ns + 1'000'001LL * i, 0, counting(i % 8 + 1, i),
                               i % 3 == 0 ? CaptureWay::kToHost : CaptureWay::kFromHost);
    piece.carrier = carrier;
    if (carrier == CaptureCarrier::kCan) {
      piece.can_id = i % 3 == 0 ? 0x7E8 : 0x7E0;
      piece.extended = i % 5 == 0;
      piece.fd = i % 2 == 0;
      piece.bitrate_switch = i % 4 == 0;
    }
    pieces.push_back(piece);
  }
  return pieces;
}

TEST(Pcapng, IsReadAgainAsItWasWritten) {
  for (const CaptureCarrier carrier : {CaptureCarrier::kSerial, CaptureCarrier::kCan}) {
    const std::vector<Captured> pieces = both_ways(carrier);
    const Capture capture = read_pcap(write_pcapng(pieces, "omnihil"), "x");
    EXPECT_EQ(capture.pieces, pieces);
    EXPECT_TRUE(capture.notes.empty());
  }
  std::vector<Captured> mixed = both_ways(CaptureCarrier::kSerial);
  mixed[1].carrier = CaptureCarrier::kCan;
  EXPECT_THROW(write_pcapng(mixed, "omnihil"), BadCapture);
}

// Wireshark reads ours: times, ways, bytes.
TEST(Pcapng, IsReadByTshark) {
  if (!is_installed("tshark")) GTEST_SKIP() << "tshark is not installed";
  const fake::TempFolder folder;
  for (const CaptureCarrier carrier : {CaptureCarrier::kSerial, CaptureCarrier::kCan}) {
    const std::vector<Captured> pieces = both_ways(carrier);
    fake::write_text(folder / "ours.pcapng", write_pcapng(pieces, "omnihil"));
    const bool can = carrier == CaptureCarrier::kCan;
    const Said said = run("tshark -r '" + (folder / "ours.pcapng").string() +
                          "' -T fields -e frame.time_epoch -e frame.packet_flags_direction -e data.data" +
                          (can ? " -e can.id -e can.flags.xtd" : "") + " 2>/dev/null");
    std::string expected;
    for (const Captured& each : pieces) {
      expected +=
          fmt::format("{}\t{}\t{}", decimal_time(each.at_ns, 9),
                      each.way == CaptureWay::kToHost ? "0x00000001" : "0x00000002", to_hex(each.bytes));
      if (can) expected += fmt::format("\t{}\t{}", each.can_id, each.extended ? 1 : 0);
      expected += '\n';
    }
    EXPECT_EQ(said.text, expected);
  }
}

// Wireshark's own files, in each of its forms: UDP by text2pcap, converted by editcap, put together by mergecap.
TEST(Pcap, OfWiresharkInEachFormIsRead) {
  if (!is_installed("text2pcap") || !is_installed("editcap") || !is_installed("mergecap"))
    GTEST_SKIP() << "Wireshark's tools are not installed";
  const fake::TempFolder folder;
  fake::write_text(folder / "a.txt",
                   "O 2023-11-14T22:13:20.000000Z\n0000 61 62 63\nO 2023-11-14T22:13:20.001000Z\n0000 64\n");
  fake::write_text(folder / "b.txt", "I 2023-11-14T22:13:20.000500Z\n0000 65 66\n");
  // With -D the ports are those of what comes in; of what goes out they are swapped.
  const std::string at = folder.path().string() + "/";
  ASSERT_EQ(run("text2pcap -q -D -t ISO -u 10301,40000 " + at + "a.txt " + at + "a.pcapng").exit_code, 0);
  ASSERT_EQ(run("text2pcap -q -D -t ISO -u 10301,40000 " + at + "b.txt " + at + "b.pcapng").exit_code, 0);
  ASSERT_EQ(run("mergecap -w " + at + "both.pcapng " + at + "a.pcapng " + at + "b.pcapng").exit_code, 0);
  for (const char* form : {"pcap", "nsecpcap", "pcapng"}) {
    const std::string file = at + "both." + form + ".out";
    ASSERT_EQ(run("editcap -F " + std::string(form) + " " + at + "both.pcapng " + file).exit_code, 0) << form;
    const Capture capture = read_pcap(fake::read_text(file), form);
    ASSERT_EQ(capture.pieces.size(), 3U) << form;
    EXPECT_EQ(capture.pieces[0].bytes, kPayload);
    EXPECT_EQ(capture.pieces[0].at_ns, kStart_ns);
    EXPECT_EQ(capture.pieces[1].from_port, 10'301);
    EXPECT_EQ(capture.pieces[1].at_ns, kStart_ns + 500'000);
    EXPECT_EQ(capture.pieces[2].to_port, 10'301);
    if (form == std::string("pcapng")) {
      EXPECT_EQ(capture.pieces[0].way, CaptureWay::kFromHost);
      EXPECT_EQ(capture.pieces[1].way, CaptureWay::kToHost);
    }
  }
}

TEST(Pcap, ACutEndIsSaidAndTheRestIsRead) {
  const std::string file = pcap_file(false, true, kUser0, {"one", "two", "three"});
  const Capture capture = read_pcap(file.substr(0, file.size() - 1), "field.pcap");
  EXPECT_EQ(capture.pieces.size(), 2U);
  EXPECT_TRUE(notes_say(capture, "field.pcap: the end is missing: "));
}

TEST(Pcap, DamageDoesNoHarm) {
  const auto read = [](const std::string& bytes) { return read_pcap(bytes, "x"); };
  const std::string lan = ethernet(ipv4(udp(1, 2, "abc"))), six = ethernet(ipv6(udp(2, 1, "abc")), 0x86DD);
  EXPECT_GT(survive_damage(pcap_file(false, true, kEthernet, {lan, six, lan}), 4, read), 5'000U);
  EXPECT_GT(
      survive_damage(pcap_file(true, false, kSll2,
                               {cooked2(socketcan(1, "x"), 4, 12), cooked2(ipv4(udp(1, 2, "")), 0, 0x800)}),
                     5, read),
      5'000U);
  EXPECT_GT(survive_damage(write_pcapng(both_ways(CaptureCarrier::kCan), "omnihil"), 6, read), 1'000U);
  const std::string big =
      section(true) + peers::interface(true, kUser0, 9) + packet(true, 1, "abc", 1) + packet(true, 2, "d", 2);
  EXPECT_GT(survive_damage(big, 7, read), 1'000U);
}

}  // namespace
}  // namespace omnihil
