#include "hil/league/league_simulator.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "hil/league/league_fields.h"
#include "hil/league/messages/ssl_simulation.pb.h"

namespace omnihil {
namespace {

constexpr double kFarthest_m = 100.0;  // a wrong unit: the largest field is 12 m long

std::optional<double> coordinate(bool has, double value, double most, const std::string& what,
                                 std::vector<LeagueError>& errors) {
  if (!has) return std::nullopt;
  if (std::isfinite(value) && std::abs(value) <= most) return value;
  errors.push_back(
      {"OUT_OF_RANGE", fmt::format("{}: found {}, allowed: -{} to {}", what, value, most, most)});
  return std::nullopt;
}

void take_teleport(const league::TeleportRobot& in, Team team, std::span<const LeagueRobot> robots,
                   LeagueControl& out) {
  const bool ours = in.id().team() == (team == Team::kBlue ? league::BLUE : league::YELLOW);
  const auto robot = std::ranges::find(robots, static_cast<int>(in.id().id()), &LeagueRobot::id);
  const std::string place = fmt::format("robot {} {}: ", league::Team_Name(in.id().team()), in.id().id());
  if (!ours || robot == robots.end()) {
    out.errors.push_back({"UNKNOWN_ROBOT", place + "not on the field"});
    return;
  }
  const std::size_t before = out.errors.size();
  refuse_unsupported(in, {"id", "x", "y", "orientation", "present", "v_x", "v_y", "v_angular", "by_force"},
                     place, out.errors);
  if (in.has_present() && !in.present())
    out.errors.push_back({"UNSUPPORTED_FIELD", place + "present = false: robots stay"});
  if (in.by_force()) out.errors.push_back({"UNSUPPORTED_FIELD", place + "by_force is not done"});
  if (in.v_x() != 0.0f || in.v_y() != 0.0f || in.v_angular() != 0.0f)
    out.errors.push_back({"UNSUPPORTED_FIELD", place + "v_x, v_y, v_angular: a robot is put down at rest"});
  LeagueTeleport teleport{static_cast<std::size_t>(robot - robots.begin()), {}, {}, {}};
  teleport.x_m = coordinate(in.has_x(), in.x(), kFarthest_m, place + "x", out.errors);
  teleport.y_m = coordinate(in.has_y(), in.y(), kFarthest_m, place + "y", out.errors);
  teleport.yaw_rad =
      coordinate(in.has_orientation(), in.orientation(), 1e3, place + "orientation", out.errors);
  if (out.errors.size() == before) out.teleports.push_back(teleport);
}

}  // namespace

LeagueControl read_simulator_command(std::string_view bytes, Team team, std::span<const LeagueRobot> robots) {
  LeagueControl out;
  league::SimulatorCommand command;
  if (!read_message(bytes, command, out.errors)) return out;
  refuse_unsupported(command, {"control", "config"}, "", out.errors);
  refuse_unsupported(command.control(), {"teleport_robot", "simulation_speed"}, "", out.errors);
  refuse_unsupported(command.config(), {}, "", out.errors);
  if (command.control().has_simulation_speed() && command.control().simulation_speed() != 1.0f) {
    out.errors.push_back({"UNSUPPORTED_FIELD", "SimulatorControl.simulation_speed: only 1 is done"});
  }
  for (const league::TeleportRobot& in : command.control().teleport_robot())
    take_teleport(in, team, robots, out);
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
