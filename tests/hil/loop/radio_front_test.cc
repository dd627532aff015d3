// Commands to a firmware that decodes by itself: every one as frames that its format reads back to the same command, at once.
#include "hil/loop/radio_front.h"

#include <gtest/gtest.h>

namespace omnihil {
namespace {

// Keeps what its radio got.
class Receiver final : public Firmware {
 public:
  std::string_view name() const override { return "receiver"; }
  std::string_view radio_format() const override { return "any"; }
  std::int64_t control_period_ns() const override { return 1'000'000; }
  void command(const RobotCommand&, std::int64_t) override { ++commands; }
  void radio_receive(std::span<const std::uint8_t> frame, std::int64_t now_ns) override {
    frames.emplace_back(frame.begin(), frame.end());
    times_ns.push_back(now_ns);
  }
  std::size_t radio_transmit(std::span<std::uint8_t>) override { return 0; }
  bool set_gains(const RobotGains&) override { return false; }
  RobotGains gains() const override { return {}; }
  RobotDrive tick(const RobotSensors&) override { return {}; }
  RobotFeedback feedback() const override { return {}; }

  std::vector<std::vector<std::uint8_t>> frames;
  std::vector<std::int64_t> times_ns;
  int commands = 0;
};

RobotCommand ahead(double v_m_s) {
  RobotCommand c{};
  c.mode = OMNIHIL_MODE_BODY_VELOCITY;
  c.v_forward_m_s = v_m_s;
  return c;
}

TEST(RadioFront, EachCommandIsTheFrameThatAHostsPacketBecomes) {
  const RadioFormat& format = *find_radio_format("ulaval-hermes");
  RadioFront front(format, 3, 0.027);
  Receiver robot;
  for (int n = 1; n <= 50; ++n) {
    ASSERT_TRUE(front.say(ahead(0.01 * n), robot, n * 20'000'000));
    // one, within its own call, but for the register that the robot is told first
    ASSERT_EQ(robot.frames.size(), static_cast<std::size_t>(n + 1));
    const DecodeResult read = format.decode(robot.frames.back());
    ASSERT_EQ(read.error, PacketError::kNone);
    EXPECT_EQ(read.values.number("robot"), 3.0);
    EXPECT_NEAR(read.values.number("vx"), 0.01 * n, 1e-6);  // a float
    EXPECT_EQ(robot.times_ns.back(), n * 20'000'000);
  }
  EXPECT_EQ(robot.commands, 0);
}

// Whatever its dongle's turns, retries and repetitions are. A format whose robots are spoken to after a handshake, or that
// has no packet for this, is none for an image.
TEST(RadioFront, EveryFormatGivesEachCommandItsOwnFramesAtOnce) {
  int formats = 0;
  for (const RadioFormat* format : radio_formats()) {
    if (!format->has_dongle() || !can_say(*format, ahead(0.1))) continue;
    SCOPED_TRACE(format->id);
    RadioFront front(*format, 0, 0.027);
    Receiver robot;
    for (std::size_t n = 1, before = 0; n <= 20; ++n) {
      ASSERT_TRUE(front.say(ahead(0.1), robot, static_cast<std::int64_t>(n)));
      const std::size_t now = robot.frames.size();
      EXPECT_TRUE(n == 1 || now - before == 1) << n << ": " << now - before;
      EXPECT_TRUE(now == 0 || robot.times_ns.back() == static_cast<std::int64_t>(n)) << n;
      before = now;
    }
    ++formats;
  }
  EXPECT_GE(formats, 1);
}

TEST(RadioFront, WhatTheFormatCannotSayIsNotSent) {
  const RadioFormat& format = *find_radio_format("ulaval-hermes");
  RadioFront front(format, 3, 0.027);
  Receiver robot;
  RobotCommand wheels{};
  wheels.mode = OMNIHIL_MODE_WHEEL_SPEED;  // no packet of HERMES
  EXPECT_FALSE(can_say(format, wheels));
  EXPECT_FALSE(front.say(wheels, robot, 0));
  EXPECT_TRUE(can_say(format, ahead(0.5)));
  EXPECT_TRUE(robot.frames.empty());
}

}  // namespace
}  // namespace omnihil
