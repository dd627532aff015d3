// grSim's packets: what becomes of each field, and what is refused.
#include "hil/league/grsim.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "hil/league/messages/grsim.pb.h"
#include "tests/hil/recording/real_run.h"

namespace omnihil {
namespace {

const RobotModel& model() {
  static const RobotModel robot = session_config(real::setup(real::kHermes)).robots[0];
  return robot;
}

std::vector<LeagueRobot> robots() {
  return {{0, &model(), {}, Team::kBlue}, {3, &model(), {}, Team::kBlue}, {3, &model(), {}, Team::kYellow}};
}

grsim::RobotCommand& add_command(grsim::Packet& packet, std::uint32_t id, bool yellow = false) {
  packet.mutable_commands()->set_timestamp(0.0);
  packet.mutable_commands()->set_isteamyellow(yellow);
  grsim::RobotCommand& command = *packet.mutable_commands()->add_robot_commands();
  command.set_id(id);
  command.set_kickspeedx(0);
  command.set_kickspeedz(0);
  command.set_veltangent(0);
  command.set_velnormal(0);
  command.set_velangular(0);
  command.set_spinner(false);
  command.set_wheelsspeed(false);
  return command;
}

GrsimPacket read(const grsim::Packet& packet) {
  return read_grsim_packet(packet.SerializeAsString(), robots());
}

TEST(Grsim, VelocityIsTheBodysAndTheSpinnerAllOrNothing) {
  grsim::Packet packet;
  grsim::RobotCommand& command = add_command(packet, 3, true);
  command.set_veltangent(1.5F);
  command.set_velnormal(-0.5F);
  command.set_velangular(2.0F);
  command.set_spinner(true);
  const GrsimPacket out = read(packet);
  ASSERT_EQ(out.commands.size(), 1U);
  EXPECT_TRUE(out.errors.empty());
  EXPECT_EQ(out.commands[0].robot_index, 2U);  // the yellow one
  const RobotCommand& c = out.commands[0].command;
  EXPECT_EQ(c.v_forward_m_s, 1.5);
  EXPECT_EQ(c.v_left_m_s, -0.5);
  EXPECT_EQ(c.omega_body_rad_s, 2.0);
  EXPECT_EQ(c.dribbler_ratio, 1.0);
  EXPECT_EQ(c.kick, std::uint32_t{OMNIHIL_KICK_NONE});
}

// grSim counts wheels from the front left on, anticlockwise; a model may have them in any order.
TEST(Grsim, WheelsAreFrontLeftBackLeftBackRightFrontRight) {
  grsim::Packet packet;
  grsim::RobotCommand& command = add_command(packet, 0);
  command.set_wheelsspeed(true);
  command.set_wheel1(1.0F);
  command.set_wheel2(2.0F);
  command.set_wheel3(3.0F);
  EXPECT_EQ(read(packet).errors.size(), 1U);  // the fourth is missing
  EXPECT_TRUE(read(packet).commands.empty());
  command.set_wheel4(4.0F);
  const GrsimPacket out = read(packet);
  ASSERT_EQ(out.commands.size(), 1U);
  for (std::size_t w = 0; w < kWheels; ++w) {
    const double forward = std::cos(model().wheel_angle_rad[w]), left = std::sin(model().wheel_angle_rad[w]);
    const double omega_rad_s = left > 0 ? (forward > 0 ? 1.0 : 2.0) : (forward > 0 ? 4.0 : 3.0);
    EXPECT_NEAR(out.commands[0].command.omega_wheel_rad_s[w], omega_rad_s, 1e-5) << w;
  }
}

TEST(Grsim, AKickGoesAlongItsTwoSpeeds) {
  grsim::Packet packet;
  grsim::RobotCommand& command = add_command(packet, 0);
  command.set_kickspeedx(4.0F);
  const RobotCommand straight = read(packet).commands.at(0).command;
  EXPECT_EQ(straight.kick, std::uint32_t{OMNIHIL_KICK_STRAIGHT});
  EXPECT_NEAR(straight.v_kick_m_s, 4.0, 1e-6);
  command.set_kickspeedz(3.0F);
  const RobotCommand chip = read(packet).commands.at(0).command;
  EXPECT_EQ(chip.kick, std::uint32_t{OMNIHIL_KICK_CHIP});
  EXPECT_NEAR(chip.v_kick_m_s, 5.0, 1e-6);  // 3, 4, 5
  command.set_kickspeedx(0.0F);
  EXPECT_TRUE(read(packet).commands.empty());  // straight up: no kicker does that
  command.set_kickspeedz(5e-5F);
  EXPECT_EQ(read(packet).commands.at(0).command.kick, std::uint32_t{OMNIHIL_KICK_NONE});
}

TEST(Grsim, RobotsAndBallArePutDown) {
  grsim::Packet packet;
  grsim::RobotReplacement& robot = *packet.mutable_replacement()->add_robots();
  robot.set_x(1.0);
  robot.set_y(-2.0);
  robot.set_dir(90.0);
  robot.set_id(3);
  robot.set_yellowteam(true);
  packet.mutable_replacement()->mutable_ball()->set_vx(2.0);
  GrsimPacket out = read(packet);
  ASSERT_EQ(out.teleports.size(), 1U);
  EXPECT_EQ(out.teleports[0].robot_index, 2U);
  EXPECT_EQ(out.teleports[0].x_m, 1.0);
  EXPECT_EQ(out.teleports[0].y_m, -2.0);
  EXPECT_NEAR(*out.teleports[0].yaw_rad, std::numbers::pi / 2.0, 1e-6);
  ASSERT_TRUE(out.ball);
  EXPECT_FALSE(out.ball->x_m);  // stays
  EXPECT_EQ(out.ball->v_x_m_s, 2.0);
  EXPECT_FALSE(out.ball->v_y_m_s);
  EXPECT_EQ(out.ball->z_m, 0.0);
  robot.set_turnon(false);
  out = read(packet);
  EXPECT_TRUE(out.teleports.empty());
  ASSERT_EQ(out.errors.size(), 1U);
  EXPECT_EQ(out.errors[0].code, "UNSUPPORTED_FIELD");
}

TEST(Grsim, WhatCannotBeDoneIsNamedAndNotDone) {
  grsim::Packet packet;
  add_command(packet, 9);
  add_command(packet, 0).set_veltangent(1500.0F);  // mm/s
  add_command(packet, 0).set_velangular(std::nanf(""));
  add_command(packet, 0).set_kickspeedx(std::nanf(""));
  const GrsimPacket out = read(packet);
  EXPECT_TRUE(out.commands.empty());
  ASSERT_EQ(out.errors.size(), 4U);
  EXPECT_EQ(out.errors[0].code, "UNKNOWN_ROBOT");
  for (std::size_t i = 1; i < 4; ++i) EXPECT_EQ(out.errors[i].code, "OUT_OF_RANGE") << i;
  EXPECT_EQ(read_grsim_packet("\xff\xff", robots()).errors.at(0).code, "UNREADABLE");
  grsim::Packet newer;
  add_command(newer, 0)
      .GetReflection()
      ->MutableUnknownFields(newer.mutable_commands()->mutable_robot_commands(0))
      ->AddVarint(40, 1);
  EXPECT_EQ(read(newer).errors.at(0).code, "UNSUPPORTED_FIELD");
  EXPECT_EQ(read(newer).commands.size(), 1U);  // what is known of it is done
}

TEST(Grsim, NoBytesFromOutsideAreActedOnUnread) {
  std::mt19937_64 random(7);
  grsim::Packet packet;
  add_command(packet, 3).set_veltangent(1.0F);
  packet.mutable_replacement()->mutable_ball()->set_x(1.0);
  const std::string good = packet.SerializeAsString();
  for (int n = 0; n < 20'000; ++n) {
    std::string bytes = good;
    const std::size_t flips = 1 + random() % 4;
    for (std::size_t i = 0; i < flips; ++i)
      bytes[random() % bytes.size()] ^= static_cast<char>(1U << random() % 8);
    if (random() % 4 == 0) bytes.resize(random() % bytes.size());
    const GrsimPacket out = read_grsim_packet(bytes, robots());
    for (const LeagueRobotCommand& c : out.commands) {
      ASSERT_LT(c.robot_index, 3U);
      EXPECT_TRUE(std::isfinite(c.command.v_forward_m_s) && std::abs(c.command.v_forward_m_s) <= 20.0);
    }
    if (out.ball && out.ball->x_m) {
      EXPECT_LE(std::abs(*out.ball->x_m), 100.0);
    }
  }
}

// Only what has changed is told; a kick for ten steps of grSim.
TEST(Grsim, StateIsToldWhenItChanges) {
  std::vector<LeagueRobot> all = robots();
  GrsimStatus status;
  EXPECT_FALSE(status.news(all, Team::kBlue, 0));
  all[1].sample.sensors.ball_seen = 1;
  status.kicked(0, true, 1'000'000);
  const auto blue = status.news(all, Team::kBlue, 1'000'000);
  ASSERT_TRUE(blue);
  grsim::RobotsStatus told;
  ASSERT_TRUE(told.ParseFromString(*blue));
  ASSERT_EQ(told.robots_status_size(), 2);
  EXPECT_EQ(told.robots_status(0).robot_id(), 0);
  EXPECT_TRUE(told.robots_status(0).chip_kick());
  EXPECT_FALSE(told.robots_status(0).infrared());
  EXPECT_EQ(told.robots_status(1).robot_id(), 3);
  EXPECT_TRUE(told.robots_status(1).infrared());
  EXPECT_FALSE(status.news(all, Team::kBlue, 2'000'000));
  EXPECT_FALSE(status.news(all, Team::kYellow, 2'000'000));
  const auto over = status.news(all, Team::kBlue, 161'000'000);
  ASSERT_TRUE(over);
  ASSERT_TRUE(told.ParseFromString(*over));
  ASSERT_EQ(told.robots_status_size(), 1);
  EXPECT_FALSE(told.robots_status(0).chip_kick());
}

}  // namespace
}  // namespace omnihil
