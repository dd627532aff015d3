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
  const LeagueCommands read = read_robot_control(control.SerializeAsString(), robots(), Team::kBlue);
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
  const LeagueCommands read = read_robot_control(control.SerializeAsString(), robots(), Team::kBlue);
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
  const LeagueCommands read = read_robot_control(control.SerializeAsString(), robots(), Team::kBlue);
  ASSERT_EQ(read.commands.size(), 1U);
  EXPECT_EQ(read.commands[0].command.kick, std::uint32_t{OMNIHIL_KICK_CHIP});
  EXPECT_NEAR(read.commands[0].command.v_kick_m_s, 5.0, 1e-6);
  EXPECT_NEAR(read.commands[0].command.dribbler_ratio, 0.5, 1e-6);
  control.mutable_robot_commands(0)->set_kick_angle(120.0f);
  EXPECT_EQ(read_robot_control(control.SerializeAsString(), robots(), Team::kBlue).errors.at(0).code,
            "OUT_OF_RANGE");
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
    for (const LeagueRobotCommand& c : read_robot_control(damaged, robots(), Team::kBlue).commands) {
      EXPECT_LT(c.robot_index, 2U);
      EXPECT_LE(std::abs(c.command.v_forward_m_s), 20.0 * std::sqrt(2.0));
      EXPECT_TRUE(std::isfinite(c.command.v_left_m_s) && std::isfinite(c.command.dribbler_ratio));
    }
    read_simulator_command(damaged, robots());
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
                                             std::vector<std::int64_t>& sent_ns,
                                             const BallState* ball = nullptr, Team team = Team::kBlue) {
  std::vector<league::SSL_DetectionFrame> frames;
  std::vector<LeagueRobot> all = robots();
  for (LeagueRobot& robot : all) robot.team = team;
  for (std::int64_t now_ns = 0; now_ns < static_cast<std::int64_t>(seconds * 1e9); now_ns += 1'000'000) {
    vision.capture(now_ns, all, ball);
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
  Vision vision({.delay_least_s = 0.006, .delay_most_s = 0.024, .seed = 1});
  std::vector<std::int64_t> sent_ns;
  const auto frames = film(vision, 10.0, sent_ns, nullptr, Team::kYellow);
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
  Vision a(noisy), b(noisy);
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
  Vision vision({});
  std::vector<std::int64_t> sent;
  for (const auto& frame : film(vision, 1.0, sent)) {
    EXPECT_EQ(frame.robots_blue(1).x(), 1500.0f);
    EXPECT_EQ(frame.robots_blue(1).y(), -500.0f);
    EXPECT_NEAR(frame.robots_blue(1).orientation(), 0.7, 1e-6);
    EXPECT_EQ(frame.t_sent(), frame.t_capture());
  }
}

BallState ball_at(double x_m, double y_m, double z_m) {
  BallState ball;
  ball.position = {x_m, y_m, z_m};
  return ball;
}

TEST(Vision, ALyingBallIsWhereItIsAndAFlyingOneWhereItsPictureMeetsTheFloor) {
  std::vector<std::int64_t> sent;
  Vision vision({});  // one camera, 4 m above the middle
  const BallState lying = ball_at(1.0, -0.5, 0.0215);
  for (const auto& frame : film(vision, 0.1, sent, &lying)) {
    ASSERT_EQ(frame.balls_size(), 1);
    EXPECT_EQ(frame.balls(0).x(), 1000.0f);
    EXPECT_EQ(frame.balls(0).y(), -500.0f);
  }
  const BallState flying = ball_at(1.0, -0.5, 1.0215);
  Vision again({});
  for (const auto& frame : film(again, 0.1, sent, &flying)) {
    EXPECT_NEAR(frame.balls(0).x(), 1000.0 * 4.0 / 3.0, 0.01);
    EXPECT_NEAR(frame.balls(0).y(), -500.0 * 4.0 / 3.0, 0.01);
  }
}

TEST(Vision, ABallBehindARobotIsHiddenWhenAsked) {
  // Robot 3 stands at (1.5, -0.5); the camera looks from above the middle.
  const double away = (1.5 + 0.11) / 1.5;
  const BallState behind = ball_at(1.5 * away, -0.5 * away, 0.0215);
  const BallState before = ball_at(1.5 - 0.11, -0.5, 0.0215);
  std::vector<std::int64_t> sent;
  for (const bool asked : {false, true}) {
    Vision vision({.occlusion = asked});
    for (const auto& frame : film(vision, 0.1, sent, &behind)) EXPECT_EQ(frame.balls_size(), asked ? 0 : 1);
    Vision other({.occlusion = asked});
    for (const auto& frame : film(other, 0.1, sent, &before)) EXPECT_EQ(frame.balls_size(), 1);
  }
}

TEST(Vision, FalseBallsComeAtTheirRateAndPixelsRound) {
  std::vector<std::int64_t> sent;
  Vision vision({.digit_mm = 7.0, .false_ball_rate_Hz = 6.0, .seed = 3});
  int balls = 0;
  for (const auto& frame : film(vision, 100.0, sent)) {
    balls += frame.balls_size();
    for (const auto& ball : frame.balls()) EXPECT_EQ(std::remainder(ball.x(), 7.0), 0.0);
    EXPECT_EQ(frame.robots_blue(1).x(), 1498.0f);  // 214 pixels
  }
  EXPECT_NEAR(balls, 600.0, 4.0 * std::sqrt(600.0));  // Poisson
}

TEST(LeagueSimulator, PutsTheBallAndGivesSpeeds) {
  league::SimulatorCommand command;
  league::TeleportBall& ball = *command.mutable_control()->mutable_teleport_ball();
  ball.set_x(1.0f);
  ball.set_vx(-2.0f);
  ball.set_roll(true);
  league::TeleportRobot& robot = *command.mutable_control()->add_teleport_robot();
  robot.mutable_id()->set_id(3);
  robot.mutable_id()->set_team(league::BLUE);
  robot.set_v_x(1.5f);
  robot.set_present(false);
  LeagueControl read = read_simulator_command(command.SerializeAsString(), robots());
  EXPECT_TRUE(read.errors.empty());
  ASSERT_TRUE(read.ball.has_value());
  EXPECT_EQ(read.ball->x_m, 1.0);
  EXPECT_FALSE(read.ball->y_m.has_value());
  EXPECT_EQ(read.ball->v_x_m_s, -2.0);
  EXPECT_TRUE(read.ball->rolls);
  ASSERT_EQ(read.teleports.size(), 1u);
  EXPECT_EQ(read.teleports[0].v_x_m_s, 1.5);
  EXPECT_EQ(read.teleports[0].present, false);
  ball.set_by_force(true);
  robot.mutable_id()->set_team(league::YELLOW);
  read = read_simulator_command(command.SerializeAsString(), robots());
  EXPECT_FALSE(read.ball.has_value());
  EXPECT_TRUE(read.teleports.empty());
  EXPECT_EQ(read.errors.size(), 2u);
}

class LeagueClient : public testing::TestWithParam<const char*> {};
TEST_P(LeagueClient, IsServed) {
  if (std::system(
          "command -v protoc > /dev/null && /usr/bin/python3 -c 'import google.protobuf' 2> /dev/null") != 0)
    GTEST_SKIP() << "needs protoc and python3-protobuf";
  fake::TempFolder folder;
  const std::string_view test = GetParam();
  const auto is_of = [&](std::string_view kind) { return test.find(kind) != std::string_view::npos; };
  const std::string command =
      std::string("/usr/bin/python3 -W ignore '" OMNIHIL_SOURCE_DIR "/tests/hil/league/") +
      (is_of("grsim")   ? "grsim"
       : is_of("match") ? "match"
                        : "league") +
      "_client.py' '" OMNIHIL_PROGRAM "' '" OMNIHIL_SOURCE_DIR "' '" + std::string(folder / "work") + "' " +
      GetParam() + " > '" + std::string(folder / "log") + "' 2>&1";
  EXPECT_EQ(std::system(command.c_str()), 0) << fake::read_text(folder / "log");
}
INSTANTIATE_TEST_SUITE_P(PythonProtobuf, LeagueClient,
                         testing::Values("test_robot_drives_and_answers_with_telemetry",
                                         "test_every_refused_field_has_its_error", "test_teleport_and_vision",
                                         "test_steps_are_exact_and_repeat",
                                         "test_recording_of_the_league_replays", "test_two_teams_and_a_ball",
                                         "test_match_of_two_scripted_teams", "test_mixed_match",
                                         "test_old_client_of_grsim"),
                         [](const auto& param) { return std::string(param.param); });

}  // namespace
}  // namespace omnihil
