#include "hil/league/vision.h"

#include <algorithm>
#include <cmath>

#include "hil/league/messages/ssl_vision.pb.h"

namespace omnihil {
namespace {

constexpr double kCameraHeight_mm = 4000.0;  // usual in the league's halls
constexpr double kCameraHeight_m = kCameraHeight_mm / 1000.0;
constexpr float kLine_mm = 10.0f;
constexpr double kBallRadius_m = 0.0215, kRobotRadius_m = 0.09, kRobotHeight_m = 0.15;

// Whether the line from the ball to the camera (above middle) goes through the robot: where the line is below the robot's
// top, it is near the ball.
bool stands_before(const VisionPose& robot, const Vector3& ball, double middle_x_m, double middle_y_m) {
  if (ball.z() >= kRobotHeight_m) return false;
  const double share = (kRobotHeight_m - ball.z()) / (kCameraHeight_m - ball.z());
  const double dx = share * (middle_x_m - ball.x()), dy = share * (middle_y_m - ball.y());
  const double x = robot.x_m - ball.x(), y = robot.y_m - ball.y(), length2 = dx * dx + dy * dy;
  const double t = length2 > 0.0 ? std::clamp((x * dx + y * dy) / length2, 0.0, 1.0) : 0.0;
  return std::hypot(x - t * dx, y - t * dy) < kRobotRadius_m;
}

void line(league::SSL_GeometryFieldSize& field, const char* name, league::SSL_FieldShapeType type, double x1,
          double y1, double x2, double y2) {
  league::SSL_FieldLineSegment& out = *field.add_field_lines();
  out.set_name(name);
  out.set_type(type);
  out.mutable_p1()->set_x(static_cast<float>(x1));
  out.mutable_p1()->set_y(static_cast<float>(y1));
  out.mutable_p2()->set_x(static_cast<float>(x2));
  out.mutable_p2()->set_y(static_cast<float>(y2));
  out.set_thickness(kLine_mm);
}

void penalty_area(league::SSL_GeometryFieldSize& field, const FieldSize& size, double side) {
  const double x = side * size.length_mm / 2.0, in = x - side * size.penalty_depth_mm,
               y = size.penalty_width_mm / 2.0;
  const bool left = side < 0.0;
  using namespace league;
  line(field, left ? "LeftPenaltyStretch" : "RightPenaltyStretch",
       left ? LeftPenaltyStretch : RightPenaltyStretch, in, -y, in, y);
  line(field, left ? "LeftFieldLeftPenaltyStretch" : "RightFieldLeftPenaltyStretch",
       left ? LeftFieldLeftPenaltyStretch : RightFieldLeftPenaltyStretch, x, left ? -y : y, in,
       left ? -y : y);
  line(field, left ? "LeftFieldRightPenaltyStretch" : "RightFieldRightPenaltyStretch",
       left ? LeftFieldRightPenaltyStretch : RightFieldRightPenaltyStretch, x, left ? y : -y, in,
       left ? y : -y);
}

void lines(league::SSL_GeometryFieldSize& field, const FieldSize& size) {
  const double x = size.length_mm / 2.0, y = size.width_mm / 2.0;
  line(field, "TopTouchLine", league::TopTouchLine, -x, y, x, y);
  line(field, "BottomTouchLine", league::BottomTouchLine, -x, -y, x, -y);
  line(field, "LeftGoalLine", league::LeftGoalLine, -x, -y, -x, y);
  line(field, "RightGoalLine", league::RightGoalLine, x, -y, x, y);
  line(field, "HalfwayLine", league::HalfwayLine, 0, -y, 0, y);
  line(field, "CenterLine", league::CenterLine, -x, 0, x, 0);
  penalty_area(field, size, -1.0);
  penalty_area(field, size, 1.0);
  league::SSL_FieldCircularArc& circle = *field.add_field_arcs();
  circle.set_name("CenterCircle");
  circle.set_type(league::CenterCircle);
  circle.mutable_center()->set_x(0.0f);
  circle.mutable_center()->set_y(0.0f);
  circle.set_radius(500.0f);
  circle.set_a1(0.0f);
  circle.set_a2(6.2831853f);
  circle.set_thickness(kLine_mm);
}

}  // namespace

Vision::Vision(const VisionOptions& options) : options_(options), random_(options.seed) {
  std::normal_distribution<double> normal;
  const int columns = options.cameras == 1 ? 1 : 2, rows = options.cameras == 4 ? 2 : 1;
  const double border_m = options.field.boundary_mm / 1000.0 + 1.0;  // beyond it nobody looks
  const double length_m = options.field.length_mm / 1000.0, width_m = options.field.width_mm / 1000.0;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const auto edge = [&](int k, int count, double size_m) {
        if (k == 0) return -size_m / 2.0 - border_m;
        if (k == count) return size_m / 2.0 + border_m;
        return -size_m / 2.0 + size_m * k / count;
      };
      const double over = options.overlap_m;
      Camera camera{edge(column, columns, length_m) - over,
                    edge(column + 1, columns, length_m) + over,
                    edge(row, rows, width_m) - over,
                    edge(row + 1, rows, width_m) + over,
                    0.0,
                    0.0,
                    0.0};
      camera.clock_s = cameras_.empty() ? 0.0 : options.clock_sigma_s * normal(random_);
      camera.askew_x_m = options.askew_sigma_m * normal(random_);
      camera.askew_y_m = options.askew_sigma_m * normal(random_);
      cameras_.push_back(camera);
    }
  }
}

double Vision::seconds(std::int64_t now_ns) const {
  return static_cast<double>(options_.epoch_ms) / 1e3 + static_cast<double>(now_ns) / 1e9;
}

std::string Vision::frame_of(std::size_t index, std::int64_t now_ns, double delay_s,
                             std::span<const LeagueRobot> robots, const BallState* ball) {
  std::normal_distribution<double> normal;
  Camera& camera = cameras_[index];
  league::SSL_DetectionFrame frame;
  frame.set_frame_number(camera.frame++);
  frame.set_t_capture(seconds(now_ns) + camera.clock_s);
  frame.set_t_sent(seconds(now_ns) + delay_s + camera.clock_s);
  frame.set_camera_id(static_cast<std::uint32_t>(index));
  const auto sees = [&](double x_m, double y_m) {
    return x_m >= camera.x_from_m && x_m <= camera.x_to_m && y_m >= camera.y_from_m && y_m <= camera.y_to_m;
  };
  for (const LeagueRobot& robot : robots) {
    const VisionPose& pose = robot.sample.vision;
    if (!robot.present || !sees(pose.x_m, pose.y_m)) continue;
    const double x_mm =
        digit(1e3 * (pose.x_m + camera.askew_x_m + options_.position_sigma_m * normal(random_)));
    const double y_mm =
        digit(1e3 * (pose.y_m + camera.askew_y_m + options_.position_sigma_m * normal(random_)));
    league::SSL_DetectionRobot& out =
        robot.team == Team::kBlue ? *frame.add_robots_blue() : *frame.add_robots_yellow();
    out.set_confidence(1.0f);
    out.set_robot_id(static_cast<std::uint32_t>(robot.id));
    out.set_x(static_cast<float>(x_mm));
    out.set_y(static_cast<float>(y_mm));
    out.set_orientation(static_cast<float>(std::remainder(
        pose.yaw_rad + options_.yaw_sigma_rad * normal(random_), 2.0 * 3.14159265358979323846)));
    out.set_pixel_x(static_cast<float>(x_mm));
    out.set_pixel_y(static_cast<float>(y_mm));
    out.set_height(150.0f);
  }
  const auto add_ball = [&](double x_mm, double y_mm) {
    league::SSL_DetectionBall& out = *frame.add_balls();
    out.set_confidence(1.0f);
    out.set_x(static_cast<float>(x_mm));
    out.set_y(static_cast<float>(y_mm));
    out.set_pixel_x(static_cast<float>(x_mm));
    out.set_pixel_y(static_cast<float>(y_mm));
  };
  if (ball != nullptr) {
    const double middle_x_m = 0.5 * (camera.x_from_m + camera.x_to_m),
                 middle_y_m = 0.5 * (camera.y_from_m + camera.y_to_m);
    const Vector3& p = ball->position;
    // The line from the camera through the ball meets the height at which balls lie.
    const double height_m = std::min(p.z() - kBallRadius_m, 0.9 * kCameraHeight_m);
    const double stretch = kCameraHeight_m / (kCameraHeight_m - std::max(0.0, height_m));
    const double x_m = middle_x_m + stretch * (p.x() - middle_x_m),
                 y_m = middle_y_m + stretch * (p.y() - middle_y_m);
    const bool hidden =
        options_.occlusion && std::ranges::any_of(robots, [&](const LeagueRobot& robot) {
          return robot.present && stands_before(robot.sample.vision, p, middle_x_m, middle_y_m);
        });
    if (!hidden && sees(x_m, y_m))
      add_ball(digit(1e3 * (x_m + camera.askew_x_m + options_.position_sigma_m * normal(random_))),
               digit(1e3 * (y_m + camera.askew_y_m + options_.position_sigma_m * normal(random_))));
  }
  if (options_.false_ball_rate_Hz > 0.0) {
    std::uniform_real_distribution<double> share(0.0, 1.0);
    if (share(random_) < options_.false_ball_rate_Hz / options_.rate_Hz) {
      const double x_m = camera.x_from_m + share(random_) * (camera.x_to_m - camera.x_from_m);
      const double y_m = camera.y_from_m + share(random_) * (camera.y_to_m - camera.y_from_m);
      add_ball(digit(1e3 * x_m), digit(1e3 * y_m));
    }
  }
  return frame.SerializeAsString();
}

double Vision::digit(double value_mm) const {
  return options_.digit_mm > 0.0 ? options_.digit_mm * std::round(value_mm / options_.digit_mm) : value_mm;
}

std::string Vision::geometry() const {
  league::SSL_WrapperPacket packet;
  league::SSL_GeometryData& data = *packet.mutable_geometry();
  league::SSL_GeometryFieldSize& field = *data.mutable_field();
  const FieldSize& size = options_.field;
  field.set_field_length(size.length_mm);
  field.set_field_width(size.width_mm);
  field.set_goal_width(size.goal_width_mm);
  field.set_goal_depth(size.goal_depth_mm);
  field.set_boundary_width(size.boundary_mm);
  field.set_penalty_area_depth(size.penalty_depth_mm);
  field.set_penalty_area_width(size.penalty_width_mm);
  lines(field, size);
  for (std::size_t i = 0; i < cameras_.size(); ++i) {
    const Camera& camera = cameras_[i];
    const double x_mm = 500.0 * (camera.x_from_m + camera.x_to_m),
                 y_mm = 500.0 * (camera.y_from_m + camera.y_to_m);
    league::SSL_GeometryCameraCalibration& calib = *data.add_calib();
    calib.set_camera_id(static_cast<std::uint32_t>(i));
    calib.set_focal_length(500.0f);
    calib.set_principal_point_x(390.0f);
    calib.set_principal_point_y(290.0f);
    calib.set_distortion(0.0f);
    // looking straight down: a half turn about x
    calib.set_q0(1.0f);
    calib.set_q1(0.0f);
    calib.set_q2(0.0f);
    calib.set_q3(0.0f);
    calib.set_tx(static_cast<float>(-x_mm));
    calib.set_ty(static_cast<float>(y_mm));
    calib.set_tz(static_cast<float>(kCameraHeight_mm));
    calib.set_derived_camera_world_tx(static_cast<float>(x_mm));
    calib.set_derived_camera_world_ty(static_cast<float>(y_mm));
    calib.set_derived_camera_world_tz(static_cast<float>(kCameraHeight_mm));
  }
  return packet.SerializeAsString();
}

void Vision::capture(std::int64_t now_ns, std::span<const LeagueRobot> robots, const BallState* ball) {
  if (now_ns >= next_geometry_ns_) {
    pending_.push_back({now_ns, geometry()});
    next_geometry_ns_ = now_ns + static_cast<std::int64_t>(options_.geometry_every_s * 1e9);
  }
  // Frame n is due at n / rate: no rounding adds up.
  while (static_cast<double>(next_frame_) / options_.rate_Hz * 1e9 <= static_cast<double>(now_ns)) {
    std::uniform_real_distribution<double> delay(options_.delay_least_s,
                                                 std::max(options_.delay_least_s, options_.delay_most_s));
    for (std::size_t i = 0; i < cameras_.size(); ++i) {
      const double delay_s =
          options_.delay_most_s > options_.delay_least_s ? delay(random_) : options_.delay_least_s;
      league::SSL_WrapperPacket packet;
      packet.mutable_detection()->ParseFromString(frame_of(i, now_ns, delay_s, robots, ball));
      const Pending pending{now_ns + static_cast<std::int64_t>(delay_s * 1e9), packet.SerializeAsString()};
      const auto after = std::ranges::upper_bound(pending_, pending.at_ns, {}, &Pending::at_ns);
      pending_.insert(after, pending);
    }
    ++next_frame_;
  }
}

std::optional<std::string> Vision::due(std::int64_t now_ns) {
  if (pending_.empty() || pending_.front().at_ns > now_ns) return std::nullopt;
  std::string bytes = std::move(pending_.front().bytes);
  pending_.pop_front();
  return bytes;
}

std::vector<std::string> Vision::frames_now(std::int64_t now_ns, std::span<const LeagueRobot> robots,
                                            const BallState* ball) {
  std::vector<std::string> frames;
  for (std::size_t i = 0; i < cameras_.size(); ++i) frames.push_back(frame_of(i, now_ns, 0.0, robots, ball));
  return frames;
}

}  // namespace omnihil
