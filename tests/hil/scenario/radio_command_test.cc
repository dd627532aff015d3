// What a radio format makes of a command reaches a robot as the same command.
#include <gtest/gtest.h>

#include "protocols/radio_format.h"
#include "protocols/radio_link.h"

namespace omnihil {
namespace {

struct Receiver : RadioSink {
  void deliver(const Delivery& delivery, std::int64_t) override {
    if (delivery.kind == Delivery::Kind::kCommand && delivery.robot_id == 5) last = delivery.command;
  }
  RobotCommand last{};
};

RobotCommand through_air(const RadioFormat& format, const RobotCommand& command) {
  RadioLinkConfig config;
  config.robot_ids = {5};
  const std::unique_ptr<RadioLink> link = format.make_link(config);
  std::vector<std::uint8_t> bytes;
  EXPECT_TRUE(format.encode_command(command, 5, bytes)) << format.id;
  Receiver receiver;
  link->host_bytes(bytes, 0);
  for (std::int64_t now_ns = 0; now_ns <= 50'000'000; now_ns += 1'000'000) link->poll(now_ns, receiver);
  return receiver.last;
}

TEST(RadioCommand, VelocityAndDutyArriveAsSent) {
  int formats = 0;
  for (const RadioFormat* format : radio_formats()) {
    if (format->encode_command == nullptr) continue;
    ++formats;
    RobotCommand velocity{};
    velocity.mode = OMNIHIL_MODE_BODY_VELOCITY;
    velocity.v_forward_m_s = 1.25, velocity.v_left_m_s = -0.5, velocity.omega_body_rad_s = 3.0;
    const RobotCommand got = through_air(*format, velocity);
    EXPECT_EQ(got.mode, velocity.mode);
    EXPECT_EQ(got.v_forward_m_s, 1.25);
    EXPECT_EQ(got.v_left_m_s, -0.5);
    EXPECT_EQ(got.omega_body_rad_s, 3.0);
    RobotCommand duty{};
    duty.mode = OMNIHIL_MODE_WHEEL_DUTY;
    duty.duty_ratio[2] = -0.25;
    EXPECT_EQ(through_air(*format, duty).mode, duty.mode);
    EXPECT_EQ(through_air(*format, duty).duty_ratio[2], -0.25);
  }
  EXPECT_GE(formats, 1);
}

TEST(RadioCommand, WhatAFormatCannotSayLeavesNoBytes) {
  const RadioFormat& hermes = *find_radio_format("ulaval-hermes");
  RobotCommand wheels{};
  wheels.mode = OMNIHIL_MODE_WHEEL_SPEED;
  RobotCommand kick{};
  kick.mode = OMNIHIL_MODE_BODY_VELOCITY;
  kick.kick = OMNIHIL_KICK_STRAIGHT;
  for (const RobotCommand& command : {wheels, kick}) {
    std::vector<std::uint8_t> bytes{7};
    EXPECT_FALSE(hermes.encode_command(command, 1, bytes));
    EXPECT_EQ(bytes.size(), 1u);
  }
}

}  // namespace
}  // namespace omnihil
