// The league's protocols: the pure parts here, the ports by a client of python3-protobuf (league_client.py).
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <random>

#include "hil/league/league_robots.h"
#include "hil/league/league_simulator.h"
#include "hil/league/league_sync.h"
#include "hil/league/messages/ssl_simulation.pb.h"
#include "hil/league/vision.h"
#include "tests/hil/recording/real_run.h"

namespace omnihil {
namespace {

const RobotModel& model() {
  static const RobotModel robot = session_config(real::setup(real::kHermes)).robots[0];
  return robot;
}

std::vector<LeagueRobot> robots() {
  std::vector<LeagueRobot> all{{0, &model(), {}}, {3, &model(), {}}};
  all[1].sample.vision = {1.5, -0.5, 0.7};
  all[1].sample.truth.yaw_rad = 0.7;
  return all;
}

league::RobotControl command_for(int id) {
  league::RobotControl control;
  control.add_robot_commands()->set_id(static_cast<std::uint32_t>(id));
  return control;
}

TEST(LeagueRobots, FieldVelocityIsTurnedByTheTrueYaw) {
  league::RobotControl control = command_for(3);
  auto& v = *control.mutable_robot_commands(0)->mutable_move_command()->mutable_global_velocity();
  v.set_x(1.0f);
  v.set_y(0.0f);
  v.set_angular(0.5f);
  const LeagueCommands read = read_robot_control(control.SerializeAsString(), robots());
  ASSERT_EQ(read.commands.size(), 1U);
  EXPECT_TRUE(read.errors.empty());
  const RobotCommand& c = read.commands[0].command;
  EXPECT_EQ(read.commands[0].robot_index, 1U);
  EXPECT_EQ(c.mode, std::uint32_t{OMNIHIL_MODE_BODY_VELOCITY});
  EXPECT_NEAR(c.v_forward_m_s, std::cos(0.7), 1e-6);
  EXPECT_NEAR(c.v_left_m_s, -std::sin(0.7), 1e-6);
  EXPECT_NEAR(c.omega_body_rad_s, 0.5, 1e-6);
}

// The wheels of a pure turn: all rims at R_b times the turn, whatever the order of the model's wheels.
TEST(LeagueRobots, WheelsGoByTheirQuarter) {
  league::RobotControl control = command_for(0);
  auto& wheels = *control.mutable_robot_commands(0)->mutable_move_command()->mutable_wheel_velocity();
  wheels.set_front_right(0.1f);
  wheels.set_back_right(0.2f);
  wheels.set_back_left(0.3f);
  wheels.set_front_left(0.4f);
  const LeagueCommands read = read_robot_control(control.SerializeAsString(), robots());
  ASSERT_EQ(read.commands.size(), 1U) << (read.errors.empty() ? "" : read.errors[0].message);
  for (std::size_t w = 0; w < kWheels; ++w) {
    const double forward = std::cos(model().wheel_angle_rad[w]), left = std::sin(model().wheel_angle_rad[w]);
    const double rim = forward > 0 ? (left > 0 ? 0.4 : 0.1) : (left > 0 ? 0.3 : 0.2);
    EXPECT_NEAR(read.commands[0].command.omega_wheel_rad_s[w] * model().wheel_radius_m, rim, 1e-6) << w;
  }
}

TEST(LeagueRobots, KickAndDribblerReachTheFirmware) {
  league::RobotControl control = command_for(0);
  control.mutable_robot_commands(0)->set_kick_speed(5.0f);
  control.mutable_robot_commands(0)->set_kick_angle(45.0f);
  control.mutable_robot_commands(0)->set_dribbler_speed(5000.0f);
  const LeagueCommands read = read_robot_control(control.SerializeAsString(), robots());
  ASSERT_EQ(read.commands.size(), 1U);
  EXPECT_EQ(read.commands[0].command.kick, std::uint32_t{OMNIHIL_KICK_CHIP});
  EXPECT_NEAR(read.commands[0].command.v_kick_m_s, 5.0, 1e-6);
  EXPECT_NEAR(read.commands[0].command.dribbler_ratio, 0.5, 1e-6);
  control.mutable_robot_commands(0)->set_kick_angle(120.0f);
  EXPECT_EQ(read_robot_control(control.SerializeAsString(), robots()).errors.at(0).code, "OUT_OF_RANGE");
}

TEST(LeagueRobots, NoBytesFromOutsideAreActedOnUnread) {
  std::mt19937_64 random(3);
  league::RobotControl good = command_for(0);
  good.mutable_robot_commands(0)->mutable_move_command()->mutable_local_velocity()->set_forward(1.0f);
  good.mutable_robot_commands(0)->mutable_move_command()->mutable_local_velocity()->set_left(0.0f);
  good.mutable_robot_commands(0)->mutable_move_command()->mutable_local_velocity()->set_angular(0.0f);
  const std::string bytes = good.SerializeAsString();
  for (int n = 0; n < 20'000; ++n) {
    std::string damaged = bytes;
    const std::size_t at = random() % damaged.size();
    damaged[at] = static_cast<char>(damaged[at] ^ (1u << random() % 8));
    if (n % 3 == 0) damaged.resize(random() % damaged.size());
    for (const LeagueRobotCommand& c : read_robot_control(damaged, robots()).commands) {
      EXPECT_LT(c.robot_index, 2U);
      EXPECT_LE(std::abs(c.command.v_forward_m_s), 20.0 * std::sqrt(2.0));
      EXPECT_TRUE(std::isfinite(c.command.v_left_m_s) && std::isfinite(c.command.dribbler_ratio));
    }
    read_simulator_command(damaged, Team::kBlue, robots());
  }
}

TEST(LeagueSync, LengthsGoThereAndBackAndDamageIsSeen) {
  for (const std::size_t size : {0UL, 1UL, 127UL, 128UL, 20'000UL}) {
    const std::string message(size, 'x');
    std::string waiting = behind_length(message) + "rest", out;
    bool bad = false;
    for (std::size_t cut = 0; cut < behind_length(message).size(); ++cut) {
      std::string part = behind_length(message).substr(0, cut);
      EXPECT_FALSE(take_behind_length(part, out, bad));
      EXPECT_FALSE(bad);
    }
    ASSERT_TRUE(take_behind_length(waiting, out, bad));
    EXPECT_EQ(out, message);
    EXPECT_EQ(waiting, "rest");
  }
  std::string endless = "\xff\xff\xff\xff\xff", out;
  bool bad = false;
  EXPECT_FALSE(take_behind_length(endless, out, bad));
  EXPECT_TRUE(bad);
}

std::vector<league::SSL_DetectionFrame> film(Vision& vision, double seconds,
                                             std::vector<std::int64_t>& sent_ns) {
  std::vector<league::SSL_DetectionFrame> frames;
  const std::vector<LeagueRobot> all = robots();
  for (std::int64_t now_ns = 0; now_ns < static_cast<std::int64_t>(seconds * 1e9); now_ns += 1'000'000) {
    vision.capture(now_ns, all);
    while (const auto packet = vision.due(now_ns)) {
      league::SSL_WrapperPacket read;
      EXPECT_TRUE(read.ParseFromString(*packet));
      if (!read.has_detection()) continue;
      frames.push_back(read.detection());
      sent_ns.push_back(now_ns);
    }
  }
  return frames;
}

TEST(Vision, SixtyFramesASecondWithinTheDelayAsked) {
  Vision vision({.delay_least_s = 0.006, .delay_most_s = 0.024, .seed = 1}, Team::kYellow);
  std::vector<std::int64_t> sent_ns;
  const auto frames = film(vision, 10.0, sent_ns);
  EXPECT_NEAR(static_cast<double>(frames.size()), 600.0, 3.0);
  double least = 1.0, most = 0.0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const double delay_s = frames[i].t_sent() - frames[i].t_capture();
    least = std::min(least, delay_s);
    most = std::max(most, delay_s);
    // sent at the first step after its time
    EXPECT_NEAR(static_cast<double>(sent_ns[i]) / 1e9, frames[i].t_sent(), 1.001e-3);
    EXPECT_EQ(frames[i].robots_yellow_size(), 2);
    EXPECT_EQ(frames[i].robots_blue_size(), 0);
  }
  EXPECT_GE(least, 0.006 - 1e-9);
  EXPECT_LE(most, 0.024 + 1e-9);
  EXPECT_GT(most - least, 0.016);  // of 0.018, 600 draws
}

TEST(Vision, NoiseHasItsDeviationAndSeedsRepeat) {
  const VisionOptions noisy{.position_sigma_m = 0.003, .seed = 5};
  std::vector<std::int64_t> sent;
  Vision a(noisy, Team::kBlue), b(noisy, Team::kBlue);
  const auto first = film(a, 20.0, sent), second = film(b, 20.0, sent);
  double sum = 0.0, squares = 0.0;
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(first[i].SerializeAsString(), second[i].SerializeAsString());
    const double error_mm = first[i].robots_blue(1).x() - 1500.0;
    sum += error_mm;
    squares += error_mm * error_mm;
  }
  const double n = static_cast<double>(first.size());
  EXPECT_NEAR(sum / n, 0.0, 4.0 * 3.0 / std::sqrt(n));  // four standard errors
  EXPECT_NEAR(std::sqrt(squares / n), 3.0, 4.0 * 3.0 / std::sqrt(2.0 * n));
}

TEST(Vision, ExactWithoutOptions) {
  Vision vision({}, Team::kBlue);
  std::vector<std::int64_t> sent;
  for (const auto& frame : film(vision, 1.0, sent)) {
    EXPECT_EQ(frame.robots_blue(1).x(), 1500.0f);
    EXPECT_EQ(frame.robots_blue(1).y(), -500.0f);
    EXPECT_NEAR(frame.robots_blue(1).orientation(), 0.7, 1e-6);
    EXPECT_EQ(frame.t_sent(), frame.t_capture());
  }
}

class LeagueClient : public testing::TestWithParam<const char*> {};
TEST_P(LeagueClient, IsServed) {
  if (std::system(
          "command -v protoc > /dev/null && /usr/bin/python3 -c 'import google.protobuf' 2> /dev/null") != 0)
    GTEST_SKIP() << "needs protoc and python3-protobuf";
  fake::TempFolder folder;
  const std::string command =
      std::string("/usr/bin/python3 -W ignore '" OMNIHIL_SOURCE_DIR
                  "/tests/hil/league/league_client.py' '" OMNIHIL_PROGRAM "' '" OMNIHIL_SOURCE_DIR "' '") +
      std::string(folder / "work") + "' " + GetParam() + " > '" + std::string(folder / "log") + "' 2>&1";
  EXPECT_EQ(std::system(command.c_str()), 0) << fake::read_text(folder / "log");
}
INSTANTIATE_TEST_SUITE_P(PythonProtobuf, LeagueClient,
                         testing::Values("test_robot_drives_and_answers_with_telemetry",
                                         "test_every_refused_field_has_its_error", "test_teleport_and_vision",
                                         "test_steps_are_exact_and_repeat",
                                         "test_recording_of_the_league_replays"),
                         [](const auto& param) { return std::string(param.param); });

}  // namespace
}  // namespace omnihil
