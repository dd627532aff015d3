#include "hil/league/league_host.h"

#include <fmt/format.h>

#include <algorithm>

#include "hil/league/league_simulator.h"

namespace omnihil {
namespace {

constexpr int kMostPerStep = 64;  // datagrams of one port: a client that floods does not stop the loop

}  // namespace

LeagueHost::LeagueHost(const LeagueOptions& options, const SessionConfig& config)
    : options_(options), team_(config.team), models_(config.robots), vision_(options.vision, config.team) {
  for (std::size_t i = 0; i < models_.size(); ++i) robots_.push_back({config.robot_ids[i], &models_[i], {}});
}

std::unique_ptr<LeagueHost> LeagueHost::open(const LeagueOptions& options, const SessionConfig& config,
                                             std::string& error) {
  std::unique_ptr<LeagueHost> host(new LeagueHost(options, config));
  const int robot_port = options.robot_port > 0       ? options.robot_port
                         : config.team == Team::kBlue ? 10301
                                                      : 10302;
  host->control_ = UdpPort::listen(options.address, options.control_port, error);
  if (host->control_.is_open()) host->robot_port_ = UdpPort::listen(options.address, robot_port, error);
  if (host->robot_port_.is_open() && options.sends_vision) {
    host->group_ =
        UdpPort::multicast(options.vision_group, options.vision_port, options.vision_interface, error);
    if (!host->group_.is_open()) return nullptr;
  }
  return host->robot_port_.is_open() ? std::move(host) : nullptr;
}

std::string LeagueHost::ports() const {
  std::string text = fmt::format("simulation control UDP {}:{}, robot control {}:{}", options_.address,
                                 control_.port(), options_.address, robot_port_.port());
  if (group_.is_open()) {
    text += fmt::format(", vision {}:{} by {} at {:g} Hz", options_.vision_group, options_.vision_port,
                        options_.vision_interface, options_.vision.rate_Hz);
  }
  return text;
}

void LeagueHost::robot_tick(std::int64_t, const RobotSample& sample) {
  const auto robot = std::ranges::find(robots_, sample.robot_id, &LeagueRobot::id);
  if (robot != robots_.end()) robot->sample = sample;
}

std::string LeagueHost::robot_control(std::string_view bytes, Session& session) {
  const LeagueCommands read = read_robot_control(bytes, robots_);
  for (const LeagueRobotCommand& c : read.commands)
    session.command(static_cast<int>(c.robot_index), c.command);
  counts_.commands += read.commands.size();
  counts_.errors += read.errors.size();
  return robot_control_response(robots_, read.errors);
}

std::string LeagueHost::simulator_command(std::string_view bytes, Session& session) {
  const LeagueControl read = read_simulator_command(bytes, team_, robots_);
  for (const LeagueTeleport& t : read.teleports) {
    const RobotTruth now = session.plant().truth(static_cast<int>(t.robot_index));
    session.set_pose(static_cast<int>(t.robot_index), t.x_m.value_or(now.x_m), t.y_m.value_or(now.y_m),
                     t.yaw_rad.value_or(now.yaw_rad));
  }
  counts_.teleports += read.teleports.size();
  counts_.errors += read.errors.size();
  return simulator_response(read.errors);
}

void LeagueHost::before_step(Session& session) {
  sockaddr_in from{};
  for (int i = 0; i < kMostPerStep && control_.receive(bytes_, from); ++i)
    control_.send(simulator_command(bytes_, session), from);
  for (int i = 0; i < kMostPerStep && robot_port_.receive(bytes_, from); ++i)
    robot_port_.send(robot_control(bytes_, session), from);
}

void LeagueHost::after_step(const Session& session) {
  if (!group_.is_open()) return;
  vision_.capture(session.now_ns(), robots_);
  while (const auto packet = vision_.due(session.now_ns())) {
    group_.send(*packet);
    ++counts_.vision_packets;
  }
  counts_.vision_lost = group_.lost();
}

}  // namespace omnihil
