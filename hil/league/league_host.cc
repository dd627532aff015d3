#include "hil/league/league_host.h"

#include <fmt/format.h>

#include <algorithm>

#include "hil/league/league_simulator.h"

namespace omnihil {
namespace {

Team other_team(Team team) { return team == Team::kBlue ? Team::kYellow : Team::kBlue; }

constexpr int kMostPerStep = 64;  // datagrams of one port: a client that floods does not stop the loop

}  // namespace

LeagueHost::LeagueHost(const LeagueOptions& options, const SessionConfig& config)
    : options_(options), team_(config.team), models_(config.robots), vision_(options.vision) {
  const std::size_t ours = models_.size();
  models_.insert(models_.end(), config.opponents.robots.begin(), config.opponents.robots.end());
  for (std::size_t i = 0; i < models_.size(); ++i) {
    const bool other = i >= ours;
    robots_.push_back({other ? config.opponents.robot_ids[i - ours] : config.robot_ids[i],
                       &models_[i],
                       {},
                       other ? other_team(team_) : team_,
                       true});
  }
  if (!options.real_group.empty()) real_ = std::make_unique<RealField>(robots_);
}

std::unique_ptr<LeagueHost> LeagueHost::open(const LeagueOptions& options, const SessionConfig& config,
                                             std::string& error) {
  std::unique_ptr<LeagueHost> host(new LeagueHost(options, config));
  const auto port_of = [](int asked, Team team) {
    if (asked > 0) return asked;
    return team == Team::kBlue ? 10301 : 10302;
  };
  const int robot_port = port_of(options.robot_port, config.team);
  host->control_ = UdpPort::listen(options.address, options.control_port, error);
  if (host->control_.is_open()) host->robot_port_ = UdpPort::listen(options.address, robot_port, error);
  if (host->robot_port_.is_open() && !config.opponents.robots.empty()) {
    host->opponents_port_ =
        UdpPort::listen(options.address, port_of(options.opponents_port, other_team(config.team)), error);
    if (!host->opponents_port_.is_open()) return nullptr;
  }
  if (host->robot_port_.is_open() && options.grsim_port > 0) {
    host->grsim_port_ = UdpPort::listen(options.address, options.grsim_port, error);
    if (!host->grsim_port_.is_open()) return nullptr;
  }
  if (host->robot_port_.is_open() && options.sends_vision) {
    host->group_ =
        UdpPort::multicast(options.vision_group, options.vision_port, options.vision_interface, error);
    if (!host->group_.is_open()) return nullptr;
  }
  if (host->robot_port_.is_open() && host->real_) {
    host->real_port_ = UdpPort::join(options.real_group, options.real_port, options.real_interface, error);
    if (!host->real_port_.is_open()) return nullptr;
  }
  return host->robot_port_.is_open() ? std::move(host) : nullptr;
}

std::string LeagueHost::ports() const {
  std::string text = fmt::format("simulation control UDP {}:{}, robot control {}:{}", options_.address,
                                 control_.port(), options_.address, robot_port_.port());
  if (opponents_port_.is_open()) text += fmt::format(" and {} of the opponents", opponents_port_.port());
  if (grsim_port_.is_open())
    text += fmt::format(", grSim's packets {}:{}", options_.address, grsim_port_.port());
  if (group_.is_open()) {
    text += fmt::format(", vision {}:{} by {} at {:g} Hz", options_.vision_group, options_.vision_port,
                        options_.vision_interface, options_.vision.rate_Hz);
  }
  if (real_port_.is_open())
    text += fmt::format(", a real game's vision from {}:{}", options_.real_group, options_.real_port);
  return text;
}

void LeagueHost::real_packet(std::string_view bytes, Session& session) {
  if (!real_) return;
  if (real_->packet(bytes, session.now_ns()))
    real_news_ = true;
  else
    ++counts_.real_unreadable;
  counts_.real_frames = real_->frames();
  counts_.real_same_id = real_->same_id();
}

// The real ones are where vision says, whatever ours do to them.
void LeagueHost::follow_real_game(Session& session) {
  const std::int64_t now_ns = session.now_ns();
  if (std::vector<Mover> movers = real_->movers(now_ns);
      (real_news_ && !movers.empty()) || movers.empty() == real_movers_) {
    real_movers_ = !movers.empty();
    session.set_movers(movers);
  }
  if (const auto ball = real_->ball(now_ns)) {
    if (real_news_) session.put_ball(ball->position, ball->velocity, ball->spin);
    real_ball_ = true;
  } else if (real_ball_) {
    session.take_ball_away();
    real_ball_ = false;
  }
  real_news_ = false;
}

std::vector<LeagueRobot> LeagueHost::all_robots(std::int64_t now_ns) {
  std::vector<LeagueRobot> all = robots_;
  if (real_)
    for (LeagueRobot& robot : real_->robots(now_ns)) all.push_back(std::move(robot));
  return all;
}

void LeagueHost::robot_tick(std::int64_t, const RobotSample& sample) {
  const bool other = sample.robot_id >= kOpponentKey;
  const int id = other ? sample.robot_id - kOpponentKey : sample.robot_id;
  const auto robot = std::ranges::find_if(
      robots_, [&](const LeagueRobot& r) { return r.id == id && (r.team == team_) != other; });
  if (robot != robots_.end()) robot->sample = sample;
}

std::string LeagueHost::robot_control(std::string_view bytes, Team team, Session& session) {
  const LeagueCommands read = read_robot_control(bytes, robots_, team);
  for (const LeagueRobotCommand& c : read.commands)
    session.command(static_cast<int>(c.robot_index), c.command);
  counts_.commands += read.commands.size();
  counts_.errors += read.errors.size();
  return robot_control_response(robots_, team, read.errors);
}

std::string LeagueHost::simulator_command(std::string_view bytes, Session& session) {
  const LeagueControl read = read_simulator_command(bytes, robots_);
  for (const LeagueTeleport& t : read.teleports) put_robot(t, session);
  if (read.ball) put_ball(*read.ball, session);
  counts_.teleports += read.teleports.size() + (read.ball ? 1 : 0);
  counts_.errors += read.errors.size();
  return simulator_response(read.errors);
}

void LeagueHost::put_robot(const LeagueTeleport& wanted, Session& session) {
  const int index = static_cast<int>(wanted.robot_index);
  if (wanted.present) {
    robots_[wanted.robot_index].present = *wanted.present;
    session.set_present(index, *wanted.present);
  }
  const PlanarState now = session.plant().planar_state(index);
  if (wanted.x_m || wanted.y_m || wanted.yaw_rad)
    session.set_pose(index, wanted.x_m.value_or(now.x_m), wanted.y_m.value_or(now.y_m),
                     wanted.yaw_rad.value_or(now.yaw_rad));
  if (wanted.v_x_m_s || wanted.v_y_m_s || wanted.omega_rad_s)
    session.set_velocity(index, wanted.v_x_m_s.value_or(0.0), wanted.v_y_m_s.value_or(0.0),
                         wanted.omega_rad_s.value_or(0.0));
}

void LeagueHost::grsim_packet(std::string_view bytes, Session& session) {
  const GrsimPacket read = read_grsim_packet(bytes, robots_);
  for (const LeagueRobotCommand& c : read.commands)
    session.command(static_cast<int>(c.robot_index), c.command);
  for (const LeagueTeleport& t : read.teleports) put_robot(t, session);
  if (read.ball) put_ball(*read.ball, session);
  counts_.commands += read.commands.size();
  counts_.teleports += read.teleports.size() + (read.ball ? 1 : 0);
  ++counts_.grsim_packets;
  counts_.grsim_errors += read.errors.size();
  if (!read.errors.empty()) counts_.grsim_error = read.errors.back().code + " " + read.errors.back().message;
}

void LeagueHost::tell_grsim(const sockaddr_in& client, std::int64_t now_ns) {
  for (const Team team : {Team::kBlue, Team::kYellow}) {
    const auto news = grsim_status_.news(robots_, team, now_ns);
    if (!news) continue;
    sockaddr_in to = client;
    to.sin_port = htons(static_cast<std::uint16_t>(team == Team::kBlue ? options_.grsim_blue_port
                                                                       : options_.grsim_yellow_port));
    grsim_port_.send(*news, to);
  }
}

void LeagueHost::world(std::int64_t now_ns, const World& world) {
  for (const WorldEvent& event : world.events()) {
    if (event.kind == WorldEventKind::kKick && event.robot >= 0)
      grsim_status_.kicked(static_cast<std::size_t>(event.robot), world.handling(event.robot).chips, now_ns);
  }
}

// What is not given stays as it is; a ball that was not there comes to the middle of the field.
void LeagueHost::put_ball(const LeagueBall& wanted, Session& session) {
  const BallState* const now = session.world().ball();
  const double radius_m = session.world().options().ball.radius_m;
  const Vector3 position = now ? now->position : Vector3(0, 0, radius_m);
  const Vector3 velocity = now ? now->velocity : Vector3(0, 0, 0);
  const Vector3 next(wanted.x_m.value_or(position.x()), wanted.y_m.value_or(position.y()),
                     std::max(radius_m, wanted.z_m.value_or(position.z())));
  const Vector3 speed(wanted.v_x_m_s.value_or(velocity.x()), wanted.v_y_m_s.value_or(velocity.y()),
                      wanted.v_z_m_s.value_or(velocity.z()));
  // w = z x v / r
  const Vector3 rolling = Vector3(-speed.y(), speed.x(), 0.0) / radius_m;
  session.put_ball(next, speed, wanted.rolls ? rolling : Vector3(0, 0, 0));
}

void LeagueHost::before_step(Session& session) {
  sockaddr_in from{};
  for (int i = 0; i < kMostPerStep && control_.receive(bytes_, from); ++i)
    control_.send(simulator_command(bytes_, session), from);
  for (int i = 0; i < kMostPerStep && robot_port_.receive(bytes_, from); ++i)
    robot_port_.send(robot_control(bytes_, team_, session), from);
  for (int i = 0; opponents_port_.is_open() && i < kMostPerStep && opponents_port_.receive(bytes_, from); ++i)
    opponents_port_.send(robot_control(bytes_, other_team(team_), session), from);
  for (int i = 0; grsim_port_.is_open() && i < kMostPerStep && grsim_port_.receive(bytes_, from); ++i) {
    grsim_packet(bytes_, session);
    tell_grsim(from, session.now_ns());
  }
  for (int i = 0; real_port_.is_open() && i < kMostPerStep && real_port_.receive(bytes_, from); ++i)
    real_packet(bytes_, session);
  if (real_) follow_real_game(session);
}

void LeagueHost::after_step(const Session& session) {
  if (!group_.is_open()) return;
  if (real_)
    vision_.capture(session.now_ns(), all_robots(session.now_ns()), session.world().ball());
  else
    vision_.capture(session.now_ns(), robots_, session.world().ball());
  while (const auto packet = vision_.due(session.now_ns())) {
    group_.send(*packet);
    ++counts_.vision_packets;
  }
  counts_.vision_lost = group_.lost();
}

}  // namespace omnihil
