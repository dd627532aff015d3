// A real game seen by SSL-Vision: where its robots and its ball are now, for virtual ones to meet them.
//
//   RealField real(ours);                          // ids that are virtual: a real robot of the same id is left out
//   real.packet(bytes, now_ns);                    // SSL_WrapperPacket as it came
//   session.set_movers(real.movers(now_ns));
//   if (auto ball = real.ball(now_ns)) session.put_ball(ball->position, ball->velocity, ball->spin);
//
// Each object is tracked by a fading-memory filter of first order (Brookner 1998, "Tracking and Kalman Filtering Made
// Easy", 1.2.6): with z what a camera says and T the time since the last frame, x += g (z - x), v += (h / T)(z - x),
// g = 1 - b^2, h = (1 - b)^2, b = kMemory. A camera's age is t_sent - t_capture; the rest of the way is not known. A
// jump of more than kJump_m begins anew; what is not seen for kLost_s is gone. Of several balls the one nearest to where
// it should be is taken, the most confident one at first.
// Cannot: what virtual robots do to the real ball or to real robots; a ball in the air, whose height vision does not say;
// frames whose sender has another clock for t_sent than for t_capture.
#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "hil/league/league_robots.h"
#include "sim/field/world.h"

namespace omnihil {

class RealField {
 public:
  static constexpr double kMemory = 0.5;  // b: three quarters of each new frame
  static constexpr double kJump_m = 0.3;  // more than a robot's width between two frames is another robot
  static constexpr double kLost_s = 0.5;

  // `ours`: not owned; only team and id are looked at, now.
  explicit RealField(std::span<const LeagueRobot> ours, const RobotOutline& outline = {});

  // False: no SSL_WrapperPacket.
  bool packet(std::string_view bytes, std::int64_t now_ns);

  std::vector<Mover> movers(std::int64_t now_ns);
  // None: none is seen.
  std::optional<BallState> ball(std::int64_t now_ns);
  // As vision tells them: for the frames that go out.
  std::vector<LeagueRobot> robots(std::int64_t now_ns);
  // Packets with a detection since the start, and detections of a robot whose id is one of ours.
  std::uint64_t frames() const { return frames_; }
  std::uint64_t same_id() const { return same_id_; }

 private:
  struct Track {
    std::array<double, 3> at{};  // x, y in m, yaw in rad; of a ball two
    std::array<double, 3> rate{};
    std::int64_t seen_ns = 0;
    bool known = false;
    void see(const std::array<double, 3>& measured, std::int64_t captured_ns);
    PlanarState at_time(std::int64_t now_ns) const;
    bool lost(std::int64_t now_ns) const;
  };
  using Key = std::pair<Team, int>;
  void forget(std::int64_t now_ns);

  std::vector<Key> ours_;
  RobotOutline outline_;
  std::map<Key, Track> robots_;
  Track ball_;
  std::uint64_t frames_ = 0, same_id_ = 0;
};

}  // namespace omnihil
