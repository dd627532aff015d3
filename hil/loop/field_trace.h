// Where everything on the field was: for pictures.
//
//   FieldTrace trace(session.config());
//   session.set_observer(&trace);
//   …                                        // run it
//   std::string svg = field_picture(trace, {.title = "kick and goal"});      // hil/field_view/field_picture.h
//
// Places every 10 ms; kicks, touches and goals as they happen.
#pragma once
#include <map>
#include <vector>

#include "hil/loop/session.h"

namespace omnihil {

struct FieldPoint {
  double time_s = 0, x_m = 0, y_m = 0, yaw_rad = 0;  // of the ball, yaw_rad is its height in m
};

struct RobotPath {
  int id = 0;
  bool opponent = false;
  RobotOutline outline;
  std::vector<FieldPoint> points;
};

class FieldTrace : public SessionObserver {
 public:
  explicit FieldTrace(const SessionConfig& config);
  void robot_tick(std::int64_t now_ns, const RobotSample& sample) override;
  void world(std::int64_t now_ns, const World& world) override;

  const FieldSize* size() const { return size_; }
  Team team() const { return team_; }
  const std::map<int, RobotPath>& robots() const { return robots_; }  // by key
  const std::vector<FieldPoint>& ball() const { return ball_; }
  const std::vector<WorldEvent>& events() const { return events_; }
  // Real robots of a mixed match, all of them, every 100 ms.
  const std::vector<FieldPoint>& movers() const { return movers_; }

 private:
  const FieldSize* size_;
  Team team_;
  std::map<int, RobotPath> robots_;
  std::vector<FieldPoint> ball_;
  std::vector<WorldEvent> events_;
  std::vector<FieldPoint> movers_;
  std::int64_t next_ball_ns_ = 0, next_movers_ns_ = 0;
};

}  // namespace omnihil
