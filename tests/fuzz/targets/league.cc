// What hosts of the league send: robot control, simulation control, lengths of the synchronous protocol, grSim's packets.
// Byte 0 picks.
#include <cmath>
#include <fstream>
#include <iterator>
#include <vector>

#include "hil/league/grsim.h"
#include "hil/league/league_robots.h"
#include "hil/league/league_simulator.h"
#include "hil/league/league_sync.h"
#include "hil/loop/model_store.h"
#include "tests/fuzz/fuzz_target.h"

namespace omnihil {
namespace {

std::span<const LeagueRobot> robots() {
  static const StoredModel kStored = load_robot_model("ulaval_delta", {OMNIHIL_SOURCE_DIR "/models"});
  static const std::vector<LeagueRobot> kRobots = [] {
    demand(kStored.model.has_value(), "the robot is there");
    const RobotModel* model = &*kStored.model->robot;
    return std::vector<LeagueRobot>{{0, model, {}}, {3, model, {}}, {3, model, {}, Team::kYellow}};
  }();
  return kRobots;
}

bool finite(const std::optional<double>& value) { return !value || std::isfinite(*value); }

void control_robots(std::string_view bytes) {
  const LeagueCommands read = read_robot_control(bytes, robots(), Team::kBlue);
  for (const LeagueRobotCommand& c : read.commands) {
    demand(c.robot_index < 2, "a robot of the team");
    const RobotCommand& r = c.command;
    demand(std::isfinite(r.v_forward_m_s) && std::isfinite(r.v_left_m_s) &&
               std::isfinite(r.omega_body_rad_s) && std::isfinite(r.v_kick_m_s) &&
               std::isfinite(r.dribbler_ratio),
           "a finite command");
    for (const double omega : r.omega_wheel_rad_s) demand(std::isfinite(omega), "finite wheel speeds");
  }
  demand(!robot_control_response(robots(), Team::kBlue, read.errors).empty(), "an answer");
}

void control_simulator(std::string_view bytes) {
  const LeagueControl read = read_simulator_command(bytes, robots());
  for (const LeagueTeleport& t : read.teleports) {
    demand(t.robot_index < robots().size(), "a robot that is there");
    demand(finite(t.x_m) && finite(t.y_m) && finite(t.yaw_rad) && finite(t.v_x_m_s) && finite(t.v_y_m_s) &&
               finite(t.omega_rad_s),
           "a place that is one");
  }
  if (read.ball) {
    const LeagueBall& b = *read.ball;
    demand(finite(b.x_m) && finite(b.y_m) && finite(b.z_m) && finite(b.v_x_m_s) && finite(b.v_y_m_s) &&
               finite(b.v_z_m_s),
           "a ball that is somewhere");
  }
  simulator_response(read.errors);
}

void take_grsim(std::string_view bytes) {
  const GrsimPacket read = read_grsim_packet(bytes, robots());
  for (const LeagueRobotCommand& c : read.commands) {
    demand(c.robot_index < robots().size(), "a robot that is there");
    demand(std::isfinite(c.command.v_forward_m_s) && std::isfinite(c.command.v_left_m_s) &&
               std::isfinite(c.command.omega_body_rad_s) && std::isfinite(c.command.v_kick_m_s),
           "a finite command");
    for (const double omega : c.command.omega_wheel_rad_s)
      demand(std::isfinite(omega), "finite wheel speeds");
  }
  for (const LeagueTeleport& t : read.teleports) {
    demand(t.robot_index < robots().size(), "a robot that is there");
    demand(finite(t.x_m) && finite(t.y_m) && finite(t.yaw_rad), "a place that is one");
  }
  if (read.ball) demand(finite(read.ball->x_m) && finite(read.ball->v_x_m_s), "a ball that is somewhere");
}

void take_messages(std::string_view bytes) {
  std::string waiting, message;
  bool bad = false;
  std::size_t taken = 0;
  for (const char byte : bytes) {
    waiting += byte;
    while (!bad && take_behind_length(waiting, message, bad)) taken += message.size();
    if (bad) return;
  }
  demand(taken <= bytes.size(), "no more than was sent");
}

}  // namespace
}  // namespace omnihil

OMNIHIL_FUZZ_TARGET(bytes) {
  using namespace omnihil;
  switch (take_byte(bytes) % 4) {
    case 0:
      return control_robots(text_of(bytes));
    case 1:
      return control_simulator(text_of(bytes));
    case 3:
      return take_grsim(text_of(bytes));
    default:
      return take_messages(text_of(bytes));
  }
}
