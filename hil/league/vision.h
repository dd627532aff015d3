// SSL-Vision over our robots: what each camera of the league would say, when, and how wrong.
//
//   Vision vision({.field = kFieldDivisionB, .cameras = 4, .seed = 7});
//   vision.capture(now_ns, robots, session.world().ball());                       // every step; frames are taken at their rate
//   while (auto packet = vision.due(now_ns)) socket.send(*packet);      // SSL_WrapperPacket, ready to go
//
// Noise is Gaussian on position and orientation (seed paper: none, 2 mm and 0.01 rad are usual); the delay from capture
// to sending is uniform between two bounds (seed paper: 6 to 24 ms); cameras' clocks may differ and a camera may sit
// askew, an offset of all it sees. All of it is zero unless asked for, and drawn from one seed.
// A flying ball is told where its picture meets the floor, as SSL-Vision, which knows no height, does. Occlusion: the line
// from camera to ball goes through a robot (a cylinder). False balls: Poisson in time, uniform over what a camera sees.
// Cannot: render images, so that pixels are the position in mm; robots that are taken for others.
#pragma once
#include <cstdint>
#include <deque>
#include <optional>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "hil/league/league_robots.h"
#include "sim/contact/ball.h"
#include "sim/field/field_size.h"

namespace omnihil {

struct VisionOptions {
  FieldSize field = kFieldDivisionB;
  double rate_Hz = 60.0;
  int cameras = 1;         // 1, 2 or 4, side by side over the field
  double overlap_m = 0.2;  // of neighbouring cameras, each beyond its border
  double delay_least_s = 0.0, delay_most_s = 0.0;
  double position_sigma_m = 0.0, yaw_sigma_rad = 0.0;
  double clock_sigma_s = 0.0;       // of each camera's clock against the first's
  double askew_sigma_m = 0.0;       // of each camera's offset
  double digit_mm = 0.0;            // positions are rounded to it: a pixel on the floor; 0: not
  bool occlusion = false;           // a ball behind a robot, as the camera sees it, is not seen
  double false_ball_rate_Hz = 0.0;  // balls that are none, of each camera
  double geometry_every_s = 1.0;
  std::uint64_t seed = 0;
  std::uint64_t epoch_ms = 0;  // Unix time at virtual time 0
};

class Vision {
 public:
  explicit Vision(const VisionOptions& options);

  // Takes the frames that are due by `now_ns`, from robots and ball (null: none) as they are now.
  void capture(std::int64_t now_ns, std::span<const LeagueRobot> robots, const BallState* ball);
  // The next packet whose time has come, in the order of sending.
  std::optional<std::string> due(std::int64_t now_ns);
  // Frames of all cameras at once, at no delay: SSL_DetectionFrame messages for the synchronous protocol.
  std::vector<std::string> frames_now(std::int64_t now_ns, std::span<const LeagueRobot> robots,
                                      const BallState* ball);

 private:
  struct Camera {
    double x_from_m, x_to_m, y_from_m, y_to_m;  // what it sees
    double clock_s, askew_x_m, askew_y_m;
    std::uint32_t frame = 0;
  };
  struct Pending {
    std::int64_t at_ns;
    std::string bytes;
  };
  std::string frame_of(std::size_t camera, std::int64_t now_ns, double delay_s,
                       std::span<const LeagueRobot> robots, const BallState* ball);
  double digit(double value_mm) const;
  std::string geometry() const;
  double seconds(std::int64_t now_ns) const;

  VisionOptions options_;
  std::mt19937_64 random_;
  std::vector<Camera> cameras_;
  std::deque<Pending> pending_;  // by time
  std::int64_t next_frame_ = 0;  // number
  std::int64_t next_geometry_ns_ = 0;
};

}  // namespace omnihil
