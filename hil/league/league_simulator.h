// The league's simulation control (port 10300): robots are put somewhere; everything else is refused by name.
//
//   LeagueControl read = read_simulator_command(datagram, Team::kBlue, team);
//   for (const LeagueTeleport& t : read.teleports) session.set_pose(int(t.robot_index), *t.x_m, *t.y_m, *t.yaw_rad);
//   std::string answer = simulator_response(read.errors);
//
// Cannot: a ball (there is none yet), speeds of a robot that is put somewhere, robots that come and go, another speed
// of time, another field or robot by message: each such field is answered with an error that names it.
#pragma once
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hil/league/league_robots.h"

namespace omnihil {

struct LeagueTeleport {
  std::size_t robot_index = 0;
  // What is not given stays as it is.
  std::optional<double> x_m, y_m, yaw_rad;
};

struct LeagueControl {
  std::vector<LeagueTeleport> teleports;
  std::vector<LeagueError> errors;
};

LeagueControl read_simulator_command(std::string_view bytes, Team team, std::span<const LeagueRobot> robots);
std::string simulator_response(std::span<const LeagueError> errors);

}  // namespace omnihil
