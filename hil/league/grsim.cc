#include "hil/league/grsim.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "hil/league/league_fields.h"
#include "hil/league/messages/grsim.pb.h"
#include "hil/league/messages/ssl_simulation.pb.h"

namespace omnihil {
namespace {

constexpr double kLeastKick_m_s = 1e-4;             // below it grSim does not kick
constexpr std::int64_t kKickTold_ns = 160'000'000;  // ten steps of grSim's 16 ms

Team team_of(bool yellow) { return yellow ? Team::kYellow : Team::kBlue; }
const char* word_of(bool yellow) { return yellow ? "YELLOW" : "BLUE"; }

template <class T>
void append(std::vector<T>& to, std::vector<T>&& from) {
  to.insert(to.end(), std::make_move_iterator(from.begin()), std::make_move_iterator(from.end()));
}

// Wheel speeds of the robot's own radius, at grSim's places: 60, 135, 225 and 300 degrees from forward to the left.
bool take_wheels(const grsim::RobotCommand& in, double radius_m, league::RobotMoveCommand& move) {
  if (!in.has_wheel1() || !in.has_wheel2() || !in.has_wheel3() || !in.has_wheel4()) return false;
  auto& wheels = *move.mutable_wheel_velocity();
  const auto rim_m_s = [&](float omega_rad_s) { return static_cast<float>(omega_rad_s * radius_m); };
  wheels.set_front_left(rim_m_s(in.wheel1()));
  wheels.set_back_left(rim_m_s(in.wheel2()));
  wheels.set_back_right(rim_m_s(in.wheel3()));
  wheels.set_front_right(rim_m_s(in.wheel4()));
  return true;
}

void take_command(const grsim::RobotCommand& in, bool yellow, std::span<const LeagueRobot> robots,
                  GrsimPacket& out) {
  const std::string place = fmt::format("robot {} {}: ", word_of(yellow), in.id());
  refuse_unsupported(in,
                     {"id", "kickspeedx", "kickspeedz", "veltangent", "velnormal", "velangular", "spinner",
                      "wheelsspeed", "wheel1", "wheel2", "wheel3", "wheel4"},
                     place, out.errors);
  const auto robot = find_robot(robots, team_of(yellow), static_cast<int>(in.id()));
  if (robot == robots.end() || !robot->present) {
    out.errors.push_back({"UNKNOWN_ROBOT", place + "not on the field"});
    return;
  }
  league::RobotControl control;
  league::RobotCommand& to = *control.add_robot_commands();
  to.set_id(in.id());
  if (in.wheelsspeed()) {
    if (!take_wheels(in, robot->model->wheel_radius_m, *to.mutable_move_command())) {
      out.errors.push_back({"OUT_OF_RANGE", place + "wheelsspeed: needs wheel1 to wheel4"});
      return;
    }
  } else {
    auto& v = *to.mutable_move_command()->mutable_local_velocity();
    v.set_forward(in.veltangent());
    v.set_left(in.velnormal());
    v.set_angular(in.velangular());
  }
  if (in.kickspeedx() > kLeastKick_m_s || in.kickspeedz() > kLeastKick_m_s ||
      !std::isfinite(in.kickspeedx() + in.kickspeedz())) {
    to.set_kick_speed(std::hypot(in.kickspeedx(), in.kickspeedz()));
    to.set_kick_angle(std::atan2(in.kickspeedz(), in.kickspeedx()) * 180.0F / std::numbers::pi_v<float>);
  }
  if (in.spinner()) to.set_dribbler_speed(static_cast<float>(kDribblerFull_rpm));
  LeagueCommands read = read_robot_control(control.SerializeAsString(), robots, team_of(yellow));
  append(out.commands, std::move(read.commands));
  append(out.errors, std::move(read.errors));
}

league::TeleportRobot teleport_of(const grsim::RobotReplacement& in) {
  league::TeleportRobot to;
  to.mutable_id()->set_id(in.id());
  to.mutable_id()->set_team(in.yellowteam() ? league::YELLOW : league::BLUE);
  to.set_x(static_cast<float>(in.x()));
  to.set_y(static_cast<float>(in.y()));
  to.set_orientation(static_cast<float>(in.dir() * std::numbers::pi / 180.0));
  return to;
}

void take_replacement(const grsim::Replacement& in, std::span<const LeagueRobot> robots, GrsimPacket& out) {
  refuse_unsupported(in, {"ball", "robots"}, "", out.errors);
  league::SimulatorCommand command;
  for (const grsim::RobotReplacement& robot : in.robots()) {
    const std::string place = fmt::format("robot {} {}: ", word_of(robot.yellowteam()), robot.id());
    refuse_unsupported(robot, {"x", "y", "dir", "id", "yellowteam", "turnon"}, place, out.errors);
    if (robot.has_turnon() && !robot.turnon()) {
      out.errors.push_back({"UNSUPPORTED_FIELD", place + "turnon false is not done"});
      continue;
    }
    *command.mutable_control()->add_teleport_robot() = teleport_of(robot);
  }
  if (in.has_ball()) {
    refuse_unsupported(in.ball(), {"x", "y", "vx", "vy"}, "ball: ", out.errors);
    league::TeleportBall& ball = *command.mutable_control()->mutable_teleport_ball();
    if (in.ball().has_x()) ball.set_x(static_cast<float>(in.ball().x()));
    if (in.ball().has_y()) ball.set_y(static_cast<float>(in.ball().y()));
    if (in.ball().has_vx()) ball.set_vx(static_cast<float>(in.ball().vx()));
    if (in.ball().has_vy()) ball.set_vy(static_cast<float>(in.ball().vy()));
    ball.set_z(0.0F);  // on the floor
    ball.set_vz(0.0F);
  }
  LeagueControl read = read_simulator_command(command.SerializeAsString(), robots);
  append(out.teleports, std::move(read.teleports));
  append(out.errors, std::move(read.errors));
  out.ball = read.ball;
}

}  // namespace

GrsimPacket read_grsim_packet(std::string_view bytes, std::span<const LeagueRobot> robots) {
  GrsimPacket out;
  grsim::Packet packet;
  if (!read_message(bytes, packet, out.errors)) return out;
  refuse_unsupported(packet, {"commands", "replacement"}, "", out.errors);
  if (packet.has_commands()) {
    refuse_unsupported(packet.commands(), {"timestamp", "isteamyellow", "robot_commands"}, "", out.errors);
    for (const grsim::RobotCommand& command : packet.commands().robot_commands())
      take_command(command, packet.commands().isteamyellow(), robots, out);
  }
  if (packet.has_replacement()) take_replacement(packet.replacement(), robots, out);
  return out;
}

void GrsimStatus::kicked(std::size_t robot_index, bool chip, std::int64_t now_ns) {
  kicks_[robot_index] = {chip, now_ns + kKickTold_ns};
}

std::optional<std::string> GrsimStatus::news(std::span<const LeagueRobot> robots, Team team,
                                             std::int64_t now_ns) {
  grsim::RobotsStatus message;
  for (std::size_t i = 0; i < robots.size(); ++i) {
    if (robots[i].team != team || !robots[i].present) continue;
    const auto kick = kicks_.find(i);
    const bool kicking = kick != kicks_.end() && now_ns < kick->second.until_ns;
    const State now{.infrared = robots[i].sample.sensors.ball_seen != 0,
                    .flat = kicking && !kick->second.chip,
                    .chip = kicking && kick->second.chip};
    State& told = told_[i];
    if (now == told) continue;
    told = now;
    grsim::RobotStatus& status = *message.add_robots_status();
    status.set_robot_id(robots[i].id);
    status.set_infrared(now.infrared);
    status.set_flat_kick(now.flat);
    status.set_chip_kick(now.chip);
  }
  if (message.robots_status_size() == 0) return std::nullopt;
  return message.SerializeAsString();
}

}  // namespace omnihil
