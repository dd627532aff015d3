// The league's robot control, in both directions: RobotControl to the commands of our robots, their state to
// RobotControlResponse.
//
//   LeagueCommands read = read_robot_control(datagram, robots, team);
//   for (const LeagueRobotCommand& c : read.commands) session.command(c.robot_index, c.command);
//   std::string answer = robot_control_response(robots, team, read.errors);
//
// A robot's command goes past the radio to its firmware, as a match simulator would take it. What cannot be done is
// answered with an error of its own; a field that is not in the table of what is done is one of those. Velocities in
// the field frame are turned by the true yaw at that instant, as every simulator of the league does. Wheel speeds are
// those of the rim, positive counter-clockwise about the robot.
// Cannot: dribblers have no rated speed in a model; kDribblerFull_rpm is full duty here.
#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "firmware_iface/robot_io.h"
#include "hil/loop/session.h"

namespace omnihil {

inline constexpr double kDribblerFull_rpm =
    10'000.0;  // a choice; grSim and ER-Force take a speed and use none

struct LeagueError {
  std::string code;  // "UNKNOWN_ROBOT", "UNSUPPORTED_FIELD", "OUT_OF_RANGE", "UNREADABLE"
  std::string message;
};

// One robot as the league sees it.
struct LeagueRobot {
  int id = 0;
  const RobotModel* model = nullptr;  // not owned
  RobotSample sample{};               // the last control tick
  Team team = Team::kBlue;
  bool present = true;
};

std::span<const LeagueRobot>::iterator find_robot(std::span<const LeagueRobot> robots, Team team, int id);

struct LeagueRobotCommand {
  std::size_t robot_index = 0;
  RobotCommand command{};
};

struct LeagueCommands {
  std::vector<LeagueRobotCommand> commands;
  std::vector<LeagueError> errors;
};

// `robots` of both teams; those of `team` are commanded and tell of themselves.
LeagueCommands read_robot_control(std::string_view bytes, std::span<const LeagueRobot> robots, Team team);

// Feedback of the team's robots, with Telemetry of ours as `custom`.
std::string robot_control_response(std::span<const LeagueRobot> robots, Team team,
                                   std::span<const LeagueError> errors);

}  // namespace omnihil
