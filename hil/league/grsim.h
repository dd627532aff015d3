// grSim's packets, for AI hosts that speak to no other simulator: commands of both teams and robots and ball put down, in
// one datagram; and what grSim tells a team of its robots.
//
//   const GrsimPacket read = read_grsim_packet(datagram, robots);
//   for (const LeagueRobotCommand& c : read.commands) session.command(int(c.robot_index), c.command);
//   if (const auto news = status.news(robots, Team::kBlue, now_ns)) port.send(*news, sender);
//
// A command becomes the league's own (league_robots.h) and is held to the same limits. grSim answers nothing to a packet
// that it does not understand; here it is counted, by cause. Sources: grSim fe2bd29, src/sslworld.cpp, src/robot.cpp.
// Cannot: turnon false (a robot that stands there switched off); wheels that keep the speed of the packet before, since
// grSim drives on by the last command and our firmware stops.
#pragma once
#include <map>
#include <optional>

#include "hil/league/league_simulator.h"

namespace omnihil {

struct GrsimPacket {
  std::vector<LeagueRobotCommand> commands;
  std::vector<LeagueTeleport> teleports;
  std::optional<LeagueBall> ball;
  std::vector<LeagueError> errors;
};

GrsimPacket read_grsim_packet(std::string_view bytes, std::span<const LeagueRobot> robots);

// Of each team the robots whose break beam or kick has changed since they were last told of.
class GrsimStatus {
 public:
  void kicked(std::size_t robot_index, bool chip, std::int64_t now_ns);
  // A message; none when nothing is new.
  std::optional<std::string> news(std::span<const LeagueRobot> robots, Team team, std::int64_t now_ns);

 private:
  struct State {
    bool infrared = false, flat = false, chip = false;
    bool operator==(const State&) const = default;
  };
  struct Kick {
    bool chip = false;
    std::int64_t until_ns = 0;
  };
  std::map<std::size_t, State> told_;
  std::map<std::size_t, Kick> kicks_;
};

}  // namespace omnihil
