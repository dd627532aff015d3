// The league's side of a bench: robot control, simulation control and vision on their ports, step by step.
//
//   std::string error;
//   auto host = LeagueHost::open({.vision = {.rate_Hz = 60}}, session.config(), error);
//   session.set_observer(host.get());              // or with others: ObserverList
//   host->before_step(session);                    // what has come in is done
//   session.step(bytes, answer);
//   host->after_step(session);                     // what a camera sees goes out
//
// Bound to this computer unless told. Commands and teleports go through the session, so a recording has them.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "hil/league/grsim.h"
#include "hil/league/league_robots.h"
#include "hil/league/league_simulator.h"
#include "hil/league/real_field.h"
#include "hil/league/udp_port.h"
#include "hil/league/vision.h"
#include "hil/loop/session.h"

namespace omnihil {

struct LeagueOptions {
  std::string address = "127.0.0.1";  // where commands are taken: 0.0.0.0 is everywhere
  int control_port = 10300;
  int robot_port = 0;      // of the first team; 0: 10301 of the blue team, 10302 of the yellow one
  int opponents_port = 0;  // of the other team, where there is one; 0: likewise
  int grsim_port = 0;      // grSim's packets as well; 0: not taken
  int grsim_blue_port = 30011, grsim_yellow_port = 30012;  // of their sender: where a team's state goes
  bool sends_vision = true;
  std::string vision_group = "224.5.23.2";
  int vision_port = 10006;
  std::string vision_interface = "127.0.0.1";
  VisionOptions vision;
  // A real game among ours: its vision comes from this group; empty: none.
  std::string real_group{};
  int real_port = 0;
  std::string real_interface = "127.0.0.1";
};

struct LeagueCounts {
  std::uint64_t commands = 0;                         // of a robot, done
  std::uint64_t teleports = 0;                        // of robots and ball
  std::uint64_t errors = 0;                           // answered
  std::uint64_t grsim_packets = 0, grsim_errors = 0;  // which grSim's clients are not told of
  std::string grsim_error;                            // the latest
  std::uint64_t vision_packets = 0, vision_lost = 0;
  std::uint64_t real_frames = 0, real_unreadable = 0, real_same_id = 0;
};

class LeagueHost : public SessionObserver {
 public:
  // Null with `error` when a port cannot be had.
  static std::unique_ptr<LeagueHost> open(const LeagueOptions& options, const SessionConfig& config,
                                          std::string& error);

  void robot_tick(std::int64_t now_ns, const RobotSample& sample) override;
  void world(std::int64_t now_ns, const World& world) override;
  void before_step(Session& session);
  void after_step(const Session& session);

  // As if they had come by UDP; the answer goes back to the caller.
  std::string robot_control(std::string_view bytes, Team team, Session& session);
  Team team() const { return team_; }
  std::string simulator_command(std::string_view bytes, Session& session);
  void grsim_packet(std::string_view bytes, Session& session);
  std::vector<std::string> frames_now(const Session& session) {
    return vision_.frames_now(session.now_ns(), all_robots(session.now_ns()), session.world().ball());
  }
  // As if it had come from the real game's group.
  void real_packet(std::string_view bytes, Session& session);

  const LeagueCounts& counts() const { return counts_; }
  std::string ports() const;  // "control UDP 127.0.0.1:10300, …"

 private:
  LeagueHost(const LeagueOptions& options, const SessionConfig& config);
  std::vector<LeagueRobot> all_robots(std::int64_t now_ns);  // real ones, too
  void follow_real_game(Session& session);
  void put_ball(const LeagueBall& wanted, Session& session);
  void put_robot(const LeagueTeleport& wanted, Session& session);
  void tell_grsim(const sockaddr_in& client, std::int64_t now_ns);

  LeagueOptions options_;
  Team team_;
  std::vector<RobotModel> models_;
  std::vector<LeagueRobot> robots_;
  UdpPort control_, robot_port_, opponents_port_, group_, real_port_, grsim_port_;
  std::unique_ptr<RealField> real_;
  bool real_news_ = false, real_ball_ = false, real_movers_ = false;
  GrsimStatus grsim_status_;
  Vision vision_;
  LeagueCounts counts_;
  std::string bytes_;
};

}  // namespace omnihil
