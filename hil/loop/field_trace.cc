#include "hil/loop/field_trace.h"

#include "sim/robot/ball_handling.h"

namespace omnihil {
namespace {
constexpr std::int64_t kEvery_ns = 10'000'000;
constexpr std::int64_t kMoversEvery_ns = 100'000'000;
}  // namespace

FieldTrace::FieldTrace(const SessionConfig& config) : size_(config.field.size), team_(config.team) {
  for (std::size_t i = 0; i < config.robot_ids.size(); ++i)
    robots_[config.robot_ids[i]] = {config.robot_ids[i], false, handling_of(config.robots[i]).outline, {}};
  const Opponents& others = config.opponents;
  for (std::size_t i = 0; i < others.robot_ids.size(); ++i)
    robots_[kOpponentKey + others.robot_ids[i]] = {
        others.robot_ids[i], true, handling_of(others.robots[i]).outline, {}};
}

void FieldTrace::robot_tick(std::int64_t now_ns, const RobotSample& sample) {
  if (now_ns % kEvery_ns != 0) return;
  const RobotTruth& t = sample.truth;
  robots_[sample.robot_id].points.push_back({static_cast<double>(now_ns) * 1e-9, t.x_m, t.y_m, t.yaw_rad});
}

void FieldTrace::world(std::int64_t now_ns, const World& world) {
  for (const WorldEvent& event : world.events()) events_.push_back(event);
  if (now_ns >= next_movers_ns_ && !world.movers().empty()) {
    next_movers_ns_ = now_ns + kMoversEvery_ns;
    for (const Mover& mover : world.movers()) {
      const PlanarState& s = mover.state;
      movers_.push_back({static_cast<double>(now_ns) * 1e-9, s.x_m, s.y_m, s.yaw_rad});
    }
  }
  const BallState* const ball = world.ball();
  if (ball == nullptr || now_ns < next_ball_ns_) return;
  next_ball_ns_ = now_ns + kEvery_ns;
  const Vector3& p = ball->position;
  ball_.push_back({static_cast<double>(now_ns) * 1e-9, p.x(), p.y(), p.z()});
}

}  // namespace omnihil
