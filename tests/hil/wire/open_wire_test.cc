// Wires opened by their names, both ends in this process: bytes cross, comings and goings are seen.
#include "hil/wire/open_wire.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <numeric>

#include "hil/wire/burst_wire.h"
#include "hil/wire/descriptor.h"

namespace omnihil {
namespace {

using Bytes = std::vector<std::uint8_t>;

std::unique_ptr<ByteWire> opened(const std::string& url, const WireQuery& usual = {}) {
  WireProblem problem;
  auto wire = open_byte_wire(read_wire_url(url), usual, problem);
  EXPECT_EQ(problem.text(), "");
  return wire;
}

Bytes all_values(std::size_t n) {
  Bytes bytes(n);
  std::iota(bytes.begin(), bytes.end(), std::uint8_t{0});
  return bytes;
}

// Reads until `n` bytes are there; each wait ends as soon as bytes come.
Bytes read_all(ByteWire& wire, std::size_t n, std::size_t limit = 4096) {
  Bytes bytes;
  for (int tries = 0; bytes.size() < n && tries < 1000; ++tries) {
    wait_for(wire.handle(), 10'000'000, false);
    EXPECT_FALSE(wire.read(bytes, limit));
  }
  return bytes;
}

void write_all(ByteWire& wire, std::span<const std::uint8_t> bytes) {
  std::error_code error;
  while (!bytes.empty() && !error) {
    bytes = bytes.subspan(wire.write(bytes, error));
    wait_for(wire.handle(), 10'000'000, true);
  }
  EXPECT_FALSE(error) << error.message();
}

bool closed(ByteWire& wire) {
  Bytes rest;
  for (int tries = 0; tries < 1000; ++tries) {
    EXPECT_FALSE(wire.read(rest, 4096));
    if (wire.take_peer_closed()) return true;
    wait_for(wire.handle(), 10'000'000, false);
  }
  return false;
}

class OpenWireTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (std::filesystem::temp_directory_path() / "omnihil-wire-XXXXXX").string();
    ASSERT_NE(::mkdtemp(pattern.data()), nullptr);
    folder_ = pattern;
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::string path(const std::string& name) const { return folder_ + "/" + name; }

  std::string folder_;
};

TEST_F(OpenWireTest, WhatAPtyOffersASerialWireOpens) {
  const auto bench = opened("pty:" + path("dongle"));
  auto host = opened("serial:" + path("dongle") + "?baud=9600&parity=even");  // of no meaning at a pty
  const Bytes sent = all_values(512);
  write_all(*host, sent);
  EXPECT_EQ(read_all(*bench, 512), sent);
  write_all(*bench, sent);
  EXPECT_EQ(read_all(*host, 512), sent);
  host.reset();
  EXPECT_TRUE(closed(*bench));
  EXPECT_FALSE(bench->peer_present());
}

TEST_F(OpenWireTest, ASerialWireWhosePtyGoesAwayIsAnError) {
  auto bench = opened("pty:" + path("dongle"));
  const auto host = opened("serial:" + path("dongle"));
  bench.reset();
  Bytes bytes;
  EXPECT_EQ(host->read(bytes, 100), std::errc::io_error);
}

TEST_F(OpenWireTest, ADeviceThatIsNotThereIsNamedWithTheSystemsReason) {
  WireProblem problem;
  EXPECT_EQ(open_byte_wire(read_wire_url("serial:" + path("nothing")), {}, problem), nullptr);
  EXPECT_EQ(problem.code, std::errc::no_such_file_or_directory);
  EXPECT_NE(problem.text().find(path("nothing")), std::string::npos) << problem.text();
  EXPECT_EQ(open_byte_wire(read_wire_url("serail:x"), {}, problem), nullptr);
  EXPECT_FALSE(problem.code);
  EXPECT_NE(problem.text().find("did you mean serial?"), std::string::npos) << problem.text();
}

// Both kinds of socket, the same: a loopback socket between two ends of ours.
class SocketWireTest : public ::testing::TestWithParam<std::string> {};

TEST_P(SocketWireTest, BytesCrossBothWaysOnTheLoopback) {
  const auto bench = opened(GetParam() + ":0", {{"listen", "1"}});  // the system picks a port
  ASSERT_EQ(std::string(bench->name()).find(GetParam() + ":127.0.0.1:"), 0U) << bench->name();
  EXPECT_FALSE(bench->peer_present());
  const auto host = opened(std::string(bench->name()));
  const Bytes sent = all_values(3000);
  write_all(*host, sent);
  EXPECT_EQ(read_all(*bench, 3000, 700), sent);  // a portion ends anywhere
  EXPECT_TRUE(bench->peer_present());
  write_all(*bench, sent);
  EXPECT_EQ(read_all(*host, 3000), sent);
}

TEST_P(SocketWireTest, AnAddressThatIsNoneIsNamed) {
  WireProblem problem;
  EXPECT_EQ(open_byte_wire(read_wire_url(GetParam() + ":127.0.0.1:http"), {}, problem), nullptr);
  EXPECT_NE(problem.text().find("port \"http\""), std::string::npos) << problem.text();
}

INSTANTIATE_TEST_SUITE_P(Sockets, SocketWireTest, ::testing::Values("tcp", "udp"),
                         [](const auto& each) { return each.param; });

TEST(UdpWireTest, WithSeekItSendsToTheAddressAndThenToWhoeverAnswers) {
  const auto group = opened("udp:0?listen=1");  // where robots look for hosts
  const auto robot = opened(std::string(group->name()) + "?seek=1");
  write_all(*robot, Bytes{1, 2, 3});
  EXPECT_EQ(read_all(*group, 3), (Bytes{1, 2, 3}));
  write_all(*group, Bytes{4});
  EXPECT_EQ(read_all(*robot, 1), Bytes{4});
}

int port_of(const ByteWire& wire) {
  const std::string name(wire.name());
  return std::stoi(name.substr(name.rfind(':') + 1));
}

TEST(UdpWireTest, WithFromItSendsFromAPortOfItsOwnChoice) {
  const auto host = opened("udp:0?listen=1");
  const int own = port_of(*opened("udp:0?listen=1"));  // free again
  for (const char* seek : {"0", "1"}) {
    const auto robot = opened(std::string(host->name()) + "?from=" + std::to_string(own) + "&seek=" + seek);
    write_all(*robot, Bytes{1, 2, 3});
    EXPECT_EQ(read_all(*host, 3), (Bytes{1, 2, 3}));
    const auto by_port = opened("udp:" + std::to_string(own));  // knows the port alone
    if (*seek == '0') continue;                                 // it hears its host alone
    write_all(*by_port, Bytes{4});
    EXPECT_EQ(read_all(*robot, 1), Bytes{4});
  }
}

TEST(UdpWireTest, WithToItAnswersAtThatPortOfWhoeverSent) {
  const auto hears = opened("udp:0?listen=1");
  const auto dongle = opened("udp:0?listen=1&to=" + std::to_string(port_of(*hears)));
  const auto writes = opened(std::string(dongle->name()));  // from a port where nobody listens
  write_all(*writes, Bytes{7});
  EXPECT_EQ(read_all(*dongle, 1), Bytes{7});
  write_all(*dongle, Bytes{8, 9});
  EXPECT_EQ(read_all(*hears, 2), (Bytes{8, 9}));
}

TEST(TcpWireTest, TheNextClientComesWhenTheOneBeforeHasLeft) {
  const auto bench = opened("tcp:0?listen=1");
  auto first = opened(std::string(bench->name()));
  write_all(*first, Bytes{1, 2, 3});
  EXPECT_EQ(read_all(*bench, 3), (Bytes{1, 2, 3}));
  const auto second = opened(std::string(bench->name()));
  write_all(*second, Bytes{4});
  first.reset();
  EXPECT_TRUE(closed(*bench));
  EXPECT_EQ(read_all(*bench, 1), Bytes{4});
}

TEST(TcpWireTest, AServerThatGoesAwayIsAnErrorAndNotASignal) {
  auto bench = opened("tcp:0?listen=1");
  const auto host = opened(std::string(bench->name()));
  write_all(*host, Bytes{1});
  EXPECT_EQ(read_all(*bench, 1), Bytes{1});
  bench.reset();
  Bytes bytes;
  std::error_code error;
  for (int tries = 0; !error && tries < 1000; ++tries) {
    wait_for(host->handle(), 10'000'000, false);
    error = host->read(bytes, 100);
  }
  EXPECT_TRUE(error);
  for (int tries = 0; tries < 3; ++tries) host->write(Bytes{1}, error);  // SIGPIPE would end this process
  EXPECT_TRUE(error);
}

TEST(TcpWireTest, NobodyListensIsSaidWithTheSystemsReason) {
  auto bench = opened("tcp:0?listen=1");
  const std::string name(bench->name());
  bench.reset();
  WireProblem problem;
  EXPECT_EQ(open_byte_wire(read_wire_url(name), {}, problem), nullptr);
  EXPECT_EQ(problem.code, std::errc::connection_refused);
}

TEST(BurstWireTest, ABurstOfALineIsAFrameThatEndsWhereAPollBringsNothing) {
  const auto bench_names = [](const ByteWire& wire) { return std::string(wire.name()); };
  std::vector<std::unique_ptr<ByteWire>> motors;
  std::vector<std::unique_ptr<ByteWire>> hosts;
  for (int m = 0; m < 2; ++m) {
    motors.push_back(opened("tcp:0?listen=1"));
    hosts.push_back(opened(bench_names(*motors.back())));
  }
  const auto bus = make_burst_wire(std::move(motors));
  write_all(*hosts[1], Bytes{7, 8, 9});
  BusFrame frame;
  bool whole = false;
  for (int polls = 0; !whole && polls < 1'000'000; ++polls) whole = bus->read(frame);
  ASSERT_TRUE(whole);
  EXPECT_EQ(frame.id, 1U);
  EXPECT_EQ(Bytes(frame.bytes().begin(), frame.bytes().end()), (Bytes{7, 8, 9}));
  BusFrame answer = can_frame(1, 2);
  answer.data = {5, 6};
  EXPECT_TRUE(bus->write(answer));
  EXPECT_EQ(read_all(*hosts[1], 2), (Bytes{5, 6}));
}

TEST_F(OpenWireTest, AStickOnAPtyCarriesFrames) {
  WireProblem problem;
  const auto bus = open_frame_wire(read_wire_url("slcan:" + path("can")), {}, problem);
  ASSERT_TRUE(bus) << problem.text();
  const auto host = opened("serial:" + path("can"));
  const std::string words = "O\rt0072AB01\r";
  write_all(*host, {reinterpret_cast<const std::uint8_t*>(words.data()), words.size()});
  BusFrame frame;
  bool came = false;
  for (int polls = 0; !came && polls < 1'000'000; ++polls) came = bus->read(frame);
  ASSERT_TRUE(came);
  EXPECT_EQ(frame.id, 7U);
  EXPECT_EQ(Bytes(frame.bytes().begin(), frame.bytes().end()), (Bytes{0xAB, 0x01}));
  const Bytes answer = read_all(*host, 3);
  EXPECT_EQ(std::string(answer.begin(), answer.end()), "\rz\r");
}

}  // namespace
}  // namespace omnihil
