#include "hil/league/real_field.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "hil/league/messages/ssl_vision.pb.h"
#include "sim/contact/ball.h"

namespace omnihil {
namespace {

constexpr double kTurn_rad = 2.0 * std::numbers::pi;
constexpr double kLeastBetween_s = 1e-3;  // two cameras' frames of one instant: no speed from them
constexpr double kOldest_s = 0.2;         // a frame that says it is older: its clocks are not one

double distance_m(const PlanarState& s, double x_m, double y_m) {
  return std::hypot(s.x_m - x_m, s.y_m - y_m);
}

}  // namespace

RealField::RealField(std::span<const LeagueRobot> ours, const RobotOutline& outline) : outline_(outline) {
  for (const LeagueRobot& robot : ours) ours_.emplace_back(robot.team, robot.id);
}

void RealField::Track::see(const std::array<double, 3>& measured, std::int64_t captured_ns) {
  const double since_s = 1e-9 * static_cast<double>(captured_ns - seen_ns);
  const PlanarState expected = at_time(captured_ns);
  if (!known || since_s < 0.0 || distance_m(expected, measured[0], measured[1]) > kJump_m) {
    if (known && since_s < 0.0) return;  // an older frame than the last
    *this = {};
    at = measured;
    seen_ns = captured_ns;
    known = true;
    return;
  }
  constexpr double kG = 1.0 - kMemory * kMemory, kH = (1.0 - kMemory) * (1.0 - kMemory);
  const std::array<double, 3> before{expected.x_m, expected.y_m, expected.yaw_rad};
  for (std::size_t i = 0; i < 3; ++i) {
    double error = measured[i] - before[i];
    if (i == 2) error = std::remainder(error, kTurn_rad);
    at[i] = before[i] + kG * error;
    if (since_s >= kLeastBetween_s) rate[i] += kH / since_s * error;
  }
  seen_ns = captured_ns;
}

PlanarState RealField::Track::at_time(std::int64_t now_ns) const {
  const double since_s = 1e-9 * static_cast<double>(now_ns - seen_ns);
  return {at[0] + since_s * rate[0],
          at[1] + since_s * rate[1],
          at[2] + since_s * rate[2],
          rate[0],
          rate[1],
          rate[2]};
}

bool RealField::Track::lost(std::int64_t now_ns) const {
  return !known || 1e-9 * static_cast<double>(now_ns - seen_ns) > kLost_s;
}

bool RealField::packet(std::string_view bytes, std::int64_t now_ns) {
  league::SSL_WrapperPacket packet;
  if (!packet.ParseFromArray(bytes.data(), static_cast<int>(bytes.size()))) return false;
  if (!packet.has_detection()) return true;
  ++frames_;
  const league::SSL_DetectionFrame& frame = packet.detection();
  const double age_s = frame.t_sent() - frame.t_capture();
  const bool told = age_s >= 0.0 && age_s <= kOldest_s;
  const std::int64_t captured_ns = now_ns - static_cast<std::int64_t>(told ? age_s * 1e9 : 0.0);
  const auto see = [&](Team team, const auto& detections) {
    for (const league::SSL_DetectionRobot& robot : detections) {
      if (!robot.has_robot_id()) continue;
      const Key key(team, static_cast<int>(robot.robot_id()));
      if (std::ranges::find(ours_, key) != ours_.end()) {
        ++same_id_;
        continue;
      }
      if (!std::isfinite(robot.x() + robot.y() + robot.orientation())) continue;
      robots_[key].see({1e-3 * robot.x(), 1e-3 * robot.y(), robot.orientation()}, captured_ns);
    }
  };
  see(Team::kBlue, frame.robots_blue());
  see(Team::kYellow, frame.robots_yellow());
  const league::SSL_DetectionBall* best = nullptr;
  const PlanarState expected = ball_.at_time(captured_ns);
  const bool lost = ball_.lost(captured_ns);
  for (const league::SSL_DetectionBall& ball : frame.balls()) {
    if (!std::isfinite(ball.x() + ball.y())) continue;
    const auto far_m = [&](const league::SSL_DetectionBall& b) {
      return distance_m(expected, 1e-3 * b.x(), 1e-3 * b.y());
    };
    if (best == nullptr || (lost ? ball.confidence() > best->confidence() : far_m(ball) < far_m(*best)))
      best = &ball;
  }
  if (best != nullptr) {
    if (lost) ball_ = {};
    ball_.see({1e-3 * best->x(), 1e-3 * best->y(), 0.0}, captured_ns);
  }
  return true;
}

void RealField::forget(std::int64_t now_ns) {
  std::erase_if(robots_, [&](const auto& entry) { return entry.second.lost(now_ns); });
}

std::vector<Mover> RealField::movers(std::int64_t now_ns) {
  forget(now_ns);
  std::vector<Mover> movers;
  for (const auto& [key, track] : robots_) movers.push_back({track.at_time(now_ns), outline_});
  return movers;
}

std::vector<LeagueRobot> RealField::robots(std::int64_t now_ns) {
  forget(now_ns);
  std::vector<LeagueRobot> robots;
  for (const auto& [key, track] : robots_) {
    LeagueRobot& robot = robots.emplace_back();
    const PlanarState s = track.at_time(now_ns);
    robot.team = key.first;
    robot.id = key.second;
    robot.sample.vision = {s.x_m, s.y_m, s.yaw_rad};
  }
  return robots;
}

std::optional<BallState> RealField::ball(std::int64_t now_ns) {
  if (ball_.lost(now_ns)) return std::nullopt;
  const PlanarState s = ball_.at_time(now_ns);
  const BallParams params;
  BallState ball = resting_ball(params, s.x_m, s.y_m);
  ball.velocity = {s.v_x_m_s, s.v_y_m_s, 0.0};
  ball.spin = {-s.v_y_m_s / params.radius_m, s.v_x_m_s / params.radius_m, 0.0};  // it rolls
  return ball;
}

}  // namespace omnihil
