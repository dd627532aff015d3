#include "hil/league/league_robots.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "hil/league/league_fields.h"
#include "hil/league/messages/ssl_simulation.pb.h"

namespace omnihil {
namespace {

constexpr double kFastest_m_s = 20.0;  // beyond what any robot of the league does: a wrong unit
constexpr double kFastestTurn_rad_s = 100.0;
constexpr double kFastestKick_m_s = 50.0;

bool check(double value, double most, const std::string& what, const char* unit,
           std::vector<LeagueError>& errors) {
  if (std::isfinite(value) && std::abs(value) <= most) return true;
  errors.push_back(
      {"OUT_OF_RANGE", fmt::format("{}: found {} {}, allowed: -{} to {}", what, value, unit, most, most)});
  return false;
}

// Wheels of the model by where they sit: front right, back right, back left, front left. Nothing when the four are not
// one in each quarter.
std::optional<std::array<std::size_t, kWheels>> wheels_by_quarter(const RobotModel& model) {
  std::array<std::size_t, kWheels> order{};
  std::array<bool, kWheels> found{};
  for (std::size_t w = 0; w < kWheels; ++w) {
    const double turn = 2.0 * std::numbers::pi;
    const double angle =
        std::fmod(std::fmod(model.wheel_angle_rad[w], turn) + turn, turn);  // from forward, to the left
    // quarters from the front left on, counter-clockwise: FL, BL, BR, FR
    const auto quarter = std::min<std::size_t>(3, static_cast<std::size_t>(angle / (turn / 4.0)));
    constexpr std::array<std::size_t, kWheels> kPlace{3, 2, 1, 0};
    order[kPlace[quarter]] = w;
    found[kPlace[quarter]] = true;
  }
  if (std::ranges::find(found, false) != found.end()) return std::nullopt;
  return order;
}

bool take_wheels(const league::MoveWheelVelocity& wheels, const LeagueRobot& robot, const std::string& place,
                 RobotCommand& command, std::vector<LeagueError>& errors) {
  const auto order = wheels_by_quarter(*robot.model);
  if (!order) {
    errors.push_back(
        {"UNSUPPORTED_FIELD", place + "wheel_velocity: the model's wheels are not one in each quarter"});
    return false;
  }
  const double rim_m_s[kWheels] = {wheels.front_right(), wheels.back_right(), wheels.back_left(),
                                   wheels.front_left()};
  command.mode = OMNIHIL_MODE_WHEEL_SPEED;
  for (std::size_t k = 0; k < kWheels; ++k) {
    if (!check(rim_m_s[k], kFastest_m_s, place + "wheel_velocity", "m/s", errors)) return false;
    command.omega_wheel_rad_s[(*order)[k]] = rim_m_s[k] / robot.model->wheel_radius_m;
  }
  return true;
}

bool take_velocity(double x, double y, double turn, double yaw_rad, const std::string& place,
                   RobotCommand& command, std::vector<LeagueError>& errors) {
  if (!check(x, kFastest_m_s, place + "velocity", "m/s", errors) ||
      !check(y, kFastest_m_s, place + "velocity", "m/s", errors) ||
      !check(turn, kFastestTurn_rad_s, place + "angular", "rad/s", errors))
    return false;
  // v_body = R(-yaw) v
  command.mode = OMNIHIL_MODE_BODY_VELOCITY;
  command.v_forward_m_s = std::cos(yaw_rad) * x + std::sin(yaw_rad) * y;
  command.v_left_m_s = -std::sin(yaw_rad) * x + std::cos(yaw_rad) * y;
  command.omega_body_rad_s = turn;
  return true;
}

bool take_move(const league::RobotMoveCommand& move, const LeagueRobot& robot, const std::string& place,
               RobotCommand& command, std::vector<LeagueError>& errors) {
  switch (move.command_case()) {
    case league::RobotMoveCommand::kWheelVelocity:
      return take_wheels(move.wheel_velocity(), robot, place, command, errors);
    case league::RobotMoveCommand::kLocalVelocity: {
      const auto& v = move.local_velocity();
      return take_velocity(v.forward(), v.left(), v.angular(), 0.0, place, command, errors);
    }
    case league::RobotMoveCommand::kGlobalVelocity: {
      const auto& v = move.global_velocity();
      return take_velocity(v.x(), v.y(), v.angular(), robot.sample.truth.yaw_rad, place, command, errors);
    }
    case league::RobotMoveCommand::COMMAND_NOT_SET:
      break;
  }
  errors.push_back({"UNSUPPORTED_FIELD", place + "move_command: neither wheels nor a velocity"});
  return false;
}

bool take_kick(const league::RobotCommand& in, const std::string& place, RobotCommand& command,
               std::vector<LeagueError>& errors) {
  if (!in.has_kick_speed() || in.kick_speed() == 0.0f) return true;
  if (!(in.kick_speed() > 0.0f) ||
      !check(in.kick_speed(), kFastestKick_m_s, place + "kick_speed", "m/s", errors)) {
    if (!(in.kick_speed() > 0.0f))
      errors.push_back({"OUT_OF_RANGE", place + "kick_speed: allowed: 0 or more"});
    return false;
  }
  if (!(in.kick_angle() >= 0.0f && in.kick_angle() < 90.0f)) {
    errors.push_back({"OUT_OF_RANGE", fmt::format("{}kick_angle: found {} deg, allowed: 0 to below 90", place,
                                                  in.kick_angle())});
    return false;
  }
  command.kick = in.kick_angle() > 0.0f ? OMNIHIL_KICK_CHIP : OMNIHIL_KICK_STRAIGHT;
  command.kick_when = OMNIHIL_KICK_ON_BALL;
  command.v_kick_m_s = in.kick_speed();
  command.flags |= OMNIHIL_COMMAND_CHARGE;
  return true;
}

}  // namespace

std::span<const LeagueRobot>::iterator find_robot(std::span<const LeagueRobot> robots, Team team, int id) {
  return std::ranges::find_if(robots, [&](const LeagueRobot& r) { return r.team == team && r.id == id; });
}

LeagueCommands read_robot_control(std::string_view bytes, std::span<const LeagueRobot> robots, Team team) {
  LeagueCommands out;
  league::RobotControl control;
  if (!read_message(bytes, control, out.errors)) return out;
  refuse_unsupported(control, {"robot_commands"}, "", out.errors);
  for (const league::RobotCommand& in : control.robot_commands()) {
    const auto robot = find_robot(robots, team, static_cast<int>(in.id()));
    if (robot == robots.end() || !robot->present) {
      out.errors.push_back({"UNKNOWN_ROBOT", fmt::format("robot {}: not on the field", in.id())});
      continue;
    }
    const std::string place = fmt::format("robot {}: ", in.id());
    refuse_unsupported(in, {"id", "move_command", "kick_speed", "kick_angle", "dribbler_speed"}, place,
                       out.errors);
    LeagueRobotCommand taken{static_cast<std::size_t>(robot - robots.begin()), {}};
    // Without a move the robot stands: the simulators of the league hold no last command either.
    taken.command.mode = OMNIHIL_MODE_BODY_VELOCITY;
    const std::size_t before = out.errors.size();
    if (in.has_move_command()) take_move(in.move_command(), *robot, place, taken.command, out.errors);
    take_kick(in, place, taken.command, out.errors);
    if (!std::isfinite(in.dribbler_speed()) || in.dribbler_speed() < 0.0f) {
      out.errors.push_back({"OUT_OF_RANGE", fmt::format("{}dribbler_speed: found {} rpm, allowed: 0 or more",
                                                        place, in.dribbler_speed())});
    }
    if (out.errors.size() > before) continue;  // a command is done whole or not at all
    taken.command.dribbler_ratio = std::min(1.0, in.dribbler_speed() / kDribblerFull_rpm);
    out.commands.push_back(taken);
  }
  return out;
}

std::string robot_control_response(std::span<const LeagueRobot> robots, Team team,
                                   std::span<const LeagueError> errors) {
  league::RobotControlResponse response;
  for (const LeagueError& error : errors) {
    league::SimulatorError& out = *response.add_errors();
    out.set_code(error.code);
    out.set_message(error.message);
  }
  for (const LeagueRobot& robot : robots) {
    if (robot.team != team || !robot.present) continue;
    league::RobotFeedback& feedback = *response.add_feedback();
    feedback.set_id(static_cast<std::uint32_t>(robot.id));
    feedback.set_dribbler_ball_contact(robot.sample.sensors.ball_seen != 0);
    league::Telemetry telemetry;
    telemetry.set_battery_v(robot.sample.sensors.bus_voltage_V);
    for (std::size_t w = 0; w < kWheels; ++w) {
      telemetry.add_motor_current_a(robot.sample.sensors.motor_current_A[w]);
      telemetry.add_omega_wheel_rad_s(robot.sample.feedback.omega_wheel_rad_s[w]);
      telemetry.add_encoder_counts(robot.sample.sensors.encoder_counts[w]);
    }
    telemetry.set_capacitor_v(robot.sample.sensors.capacitor_V);
    telemetry.set_gyro_z_rad_s(robot.sample.sensors.gyro_z_rad_s);
    telemetry.set_ball_seen(robot.sample.sensors.ball_seen != 0);
    feedback.mutable_custom()->PackFrom(telemetry);
  }
  return response.SerializeAsString();
}

}  // namespace omnihil
