// The league's simulation control (port 10300): ball and robots are put somewhere, robots come and go; the rest is
// refused by name.
//
//   LeagueControl read = read_simulator_command(datagram, robots);
//   for (const LeagueTeleport& t : read.teleports) session.set_pose(int(t.robot_index), *t.x_m, *t.y_m, *t.yaw_rad);
//   std::string answer = simulator_response(read.errors);
//
// Cannot: another speed of time, another field or robot by message, a robot that was not there at the start, ways by
// force: each such field is answered with an error that names it.
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
  std::optional<double> v_x_m_s, v_y_m_s, omega_rad_s;  // of the field; none: at rest
  std::optional<bool> present;
};

struct LeagueBall {
  std::optional<double> x_m, y_m, z_m;
  std::optional<double> v_x_m_s, v_y_m_s, v_z_m_s;
  bool rolls = false;  // not sliding: its spin fits its speed
};

struct LeagueControl {
  std::vector<LeagueTeleport> teleports;
  std::optional<LeagueBall> ball;
  std::vector<LeagueError> errors;
};

LeagueControl read_simulator_command(std::string_view bytes, std::span<const LeagueRobot> robots);
std::string simulator_response(std::span<const LeagueError> errors);

}  // namespace omnihil
