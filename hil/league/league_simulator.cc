#include "hil/league/league_simulator.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "hil/league/league_fields.h"
#include "hil/league/messages/ssl_simulation.pb.h"

namespace omnihil {
namespace {

constexpr double kFastest_m_s = 50.0;  // beyond any kick: a wrong unit
constexpr double kFarthest_m = 100.0;  // a wrong unit: the largest field is 12 m long

std::optional<double> coordinate(bool has, double value, double most, const std::string& what,
                                 std::vector<LeagueError>& errors) {
  if (!has) return std::nullopt;
  if (std::isfinite(value) && std::abs(value) <= most) return value;
  errors.push_back(
      {"OUT_OF_RANGE", fmt::format("{}: found {}, allowed: -{} to {}", what, value, most, most)});
  return std::nullopt;
}

void take_teleport(const league::TeleportRobot& in, std::span<const LeagueRobot> robots, LeagueControl& out) {
  const Team team = in.id().team() == league::YELLOW ? Team::kYellow : Team::kBlue;
  const auto robot = find_robot(robots, team, static_cast<int>(in.id().id()));
  const std::string place = fmt::format("robot {} {}: ", league::Team_Name(in.id().team()), in.id().id());
  if (robot == robots.end()) {
    out.errors.push_back({"UNKNOWN_ROBOT", place + "not on the field"});
    return;
  }
  const std::size_t before = out.errors.size();
  refuse_unsupported(in, {"id", "x", "y", "orientation", "present", "v_x", "v_y", "v_angular", "by_force"},
                     place, out.errors);
  if (in.by_force()) out.errors.push_back({"UNSUPPORTED_FIELD", place + "by_force is not done"});
  LeagueTeleport teleport;
  teleport.robot_index = static_cast<std::size_t>(robot - robots.begin());
  teleport.x_m = coordinate(in.has_x(), in.x(), kFarthest_m, place + "x", out.errors);
  teleport.y_m = coordinate(in.has_y(), in.y(), kFarthest_m, place + "y", out.errors);
  teleport.yaw_rad =
      coordinate(in.has_orientation(), in.orientation(), 1e3, place + "orientation", out.errors);
  teleport.v_x_m_s = coordinate(in.has_v_x(), in.v_x(), kFastest_m_s, place + "v_x", out.errors);
  teleport.v_y_m_s = coordinate(in.has_v_y(), in.v_y(), kFastest_m_s, place + "v_y", out.errors);
  teleport.omega_rad_s = coordinate(in.has_v_angular(), in.v_angular(), 1e3, place + "v_angular", out.errors);
  if (in.has_present()) teleport.present = in.present();
  if (out.errors.size() == before) out.teleports.push_back(teleport);
}

void take_ball(const league::TeleportBall& in, LeagueControl& out) {
  const std::size_t before = out.errors.size();
  refuse_unsupported(in, {"x", "y", "z", "vx", "vy", "vz", "roll", "teleport_safely", "by_force"},
                     "ball: ", out.errors);
  if (in.by_force()) out.errors.push_back({"UNSUPPORTED_FIELD", "ball: by_force is not done"});
  if (in.teleport_safely()) out.errors.push_back({"UNSUPPORTED_FIELD", "ball: teleport_safely is not done"});
  LeagueBall ball;
  ball.x_m = coordinate(in.has_x(), in.x(), kFarthest_m, "ball: x", out.errors);
  ball.y_m = coordinate(in.has_y(), in.y(), kFarthest_m, "ball: y", out.errors);
  ball.z_m = coordinate(in.has_z(), in.z(), kFarthest_m, "ball: z", out.errors);
  ball.v_x_m_s = coordinate(in.has_vx(), in.vx(), kFastest_m_s, "ball: vx", out.errors);
  ball.v_y_m_s = coordinate(in.has_vy(), in.vy(), kFastest_m_s, "ball: vy", out.errors);
  ball.v_z_m_s = coordinate(in.has_vz(), in.vz(), kFastest_m_s, "ball: vz", out.errors);
  ball.rolls = in.roll();
  if (out.errors.size() == before) out.ball = ball;
}

}  // namespace

LeagueControl read_simulator_command(std::string_view bytes, std::span<const LeagueRobot> robots) {
  LeagueControl out;
  league::SimulatorCommand command;
  if (!read_message(bytes, command, out.errors)) return out;
  refuse_unsupported(command, {"control", "config"}, "", out.errors);
  refuse_unsupported(command.control(), {"teleport_ball", "teleport_robot", "simulation_speed"}, "",
                     out.errors);
  refuse_unsupported(command.config(), {}, "", out.errors);
  if (command.control().has_simulation_speed() && command.control().simulation_speed() != 1.0f) {
    out.errors.push_back({"UNSUPPORTED_FIELD", "SimulatorControl.simulation_speed: only 1 is done"});
  }
  for (const league::TeleportRobot& in : command.control().teleport_robot()) take_teleport(in, robots, out);
  if (command.control().has_teleport_ball()) take_ball(command.control().teleport_ball(), out);
  return out;
}

std::string simulator_response(std::span<const LeagueError> errors) {
  league::SimulatorResponse response;
  for (const LeagueError& error : errors) {
    league::SimulatorError& out = *response.add_errors();
    out.set_code(error.code);
    out.set_message(error.message);
  }
  return response.SerializeAsString();
}

}  // namespace omnihil
