// A stick that is opened, against a stick that is offered: both ends of both languages over a pseudo-terminal.
#include "hil/wire/stick_wire.h"

#include <gtest/gtest.h>
#include <poll.h>
#include <unistd.h>

#include <filesystem>

#include "hil/wire/open_wire.h"
#include "tests/firmware_iface/motor_bus/bus_harness.h"

namespace omnihil::test {
namespace {

struct Ends {
  std::filesystem::path folder;
  std::unique_ptr<FrameWire> device, host;

  explicit Ends(const std::string& scheme, const std::string& more = "") {
    folder = std::filesystem::temp_directory_path() / ("omnihil-stick-" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder);
    const std::string url = scheme + ":" + (folder / "can").string();
    WireProblem problem;
    device = open_frame_wire(read_wire_url(url), {}, problem);
    EXPECT_TRUE(device) << problem.text();
    host = open_frame_wire(read_wire_url(url + more), {{"stick", "1"}}, problem);
    EXPECT_TRUE(host) << problem.text();
  }
  ~Ends() {
    host.reset(), device.reset();
    std::filesystem::remove_all(folder);
  }
  // What `to` reads of what `from` wrote; a terminal hands on by itself, but when is its own affair.
  static BusFrame across(FrameWire& from, FrameWire& to, const BusFrame& frame) {
    BusFrame got;
    got.id = ~0U;
    EXPECT_TRUE(from.write(frame));
    for (int n = 0; n < 100 && !to.read(got); ++n) {
      pollfd waits{to.handle(), POLLIN, 0};
      ::poll(&waits, waits.fd >= 0 ? 1 : 0, 100);
    }
    return got;
  }
};

void expect_same(const BusFrame& a, const BusFrame& b) {
  EXPECT_EQ(a.id, b.id);
  EXPECT_EQ(data_of(a), data_of(b));
  EXPECT_EQ(a.extended, b.extended);
  EXPECT_EQ(a.remote, b.remote);
  EXPECT_EQ(a.fd, b.fd);
  EXPECT_EQ(a.bitrate_switch, b.bitrate_switch);
}

TEST(StickWire, FramesOfEveryKindCrossAnSlcanStickBothWays) {
  Ends ends("slcan", "?bitrate=250000");
  const BusFrame frames[] = {frame(0x007, "0800000000000000"), remote_frame(0x009),
                             fd_frame(0x8001, "0100080d1b00002040110050"), fd_frame(0x100, "210008")};
  // The device hears nothing before the host has opened the channel; that is on its way already.
  for (const BusFrame& f : frames) {
    expect_same(Ends::across(*ends.host, *ends.device, f), f);
    expect_same(Ends::across(*ends.device, *ends.host, f), f);
  }
}

TEST(StickWire, FramesCrossAnFdcanusbBothWays) {
  Ends ends("fdcanusb");
  BusFrame classic = frame(0x12, "0102");
  for (const BusFrame& f :
       {fd_frame(0x8001, "0100080d1b00002040110050"), fd_frame(0x100, "210008"), classic}) {
    expect_same(Ends::across(*ends.host, *ends.device, f), f);
    expect_same(Ends::across(*ends.device, *ends.host, f), f);
  }
  EXPECT_FALSE(ends.host->write(remote_frame(1)));  // its language has none
}

TEST(StickWire, ABitRateThatNoStickHasIsRefused) {
  WireProblem problem;
  EXPECT_EQ(open_frame_wire(read_wire_url("slcan:/dev/null?stick=1&bitrate=333000"), {}, problem), nullptr);
  EXPECT_NE(problem.text().find("bit rate 333000; allowed: 10000, 20000"), std::string::npos)
      << problem.text();
}

TEST(StickWire, WhatIsNoSerialPortIsRefusedWithItsName) {
  WireProblem problem;
  EXPECT_EQ(open_frame_wire(read_wire_url("slcan:/nowhere/can?stick=1"), {}, problem), nullptr);
  EXPECT_NE(problem.text().find("/nowhere/can"), std::string::npos) << problem.text();
}

}  // namespace
}  // namespace omnihil::test
