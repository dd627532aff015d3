#include "hil/field_play/pass_and_shoot.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <memory>
#include <numbers>
#include <random>

#include "hil/loop/reference_firmware.h"
#include "hil/recording/replay.h"
#include "protocols/radio_format.h"
#include "sim/field/field_size.h"
#include "sim/robot/ball_handling.h"
#include "sim/robot/geometry.h"

namespace omnihil {
namespace {

constexpr double kLongest_s = 20.0;
constexpr double kArrives_m_s = 1.0;  // dribblers let what is faster bounce off
constexpr double kRolls_m_s2 = 0.26;  // what a host assumes of the carpet (docs/field/ball.md)
constexpr double kFrame_s = 1.0 / 60.0;
constexpr double kCharge_s = 2.2;                     // a host waits so long for the capacitor
constexpr double kAim_rad = 0.08, kBehind_rad = 0.1;  // from where on it goes in; it still turns on the way
constexpr double kRing_m = 0.18, kLost_m = 0.3;       // around the ball: robot's middle to the ball's
constexpr double kOutOfReach_m = 0.15;
constexpr double kInto_m_s = 0.3;
constexpr double kTaken_m = 0.35;
constexpr double kGiveWay_m_s = 0.35;  // of the receiver as the ball comes
constexpr double kHeld_s = 0.2;
constexpr double kShot_m_s = 4.0;

struct Pose {
  double x_m = 0, y_m = 0, yaw_rad = 0;
};
// A frame: what the host gets of it, and when.
struct Frame {
  double captured_s = 0, arrives_s = 0;
  Pose robot[2];
  double ball_x_m = 0, ball_y_m = 0;
};

double turn(double angle) { return std::remainder(angle, 2.0 * std::numbers::pi); }

// Kicked flat, a ball slides to 5/7 of its speed, and rolls on with kRolls_m_s2: v0 to arrive over `way` at kArrives_m_s.
double kick_for(double way_m) {
  return 1.4 * std::sqrt(kArrives_m_s * kArrives_m_s + 2.0 * kRolls_m_s2 * way_m);
}

class Play : public SessionObserver {
 public:
  Play(const RobotModel& model, MotorLoop loop, const PassOptions& options)
      : options_(options), random_(options.seed) {
    RobotModel robot = model;
    robot.motor_loop = loop;
    SessionConfig config;
    config.radio_format = "roboteam-rem-v8";
    config.robots = {robot, robot};
    config.robot_ids = {0, 1};
    config.plant.physics = Physics::kPlanar;
    config.plant.seed = options.seed;
    config.air.by_distance = true;
    config.air.x_m = -3.2;
    config.field.contacts = true;
    config.field.size = &kFieldSeedPaper;
    geometry_ = wheel_geometry(robot);
    front_m_ = handling_of(robot).outline.front_m;
    session_ = std::make_unique<Session>(config, reference_firmware_for(config));
    observers_.add(this);
    if (options.trace != nullptr) {
      *options.trace = new FieldTrace(config);
      observers_.add(*options.trace);
    }
    session_->set_observer(&observers_);
    place();
  }

  PassResult run() {
    std::vector<std::uint8_t> host, answer;
    const RadioFormat& format = *find_radio_format(session_->config().radio_format);
    while (now_s() < kLongest_s && !result_.scored && !over_) {
      see();
      decide();
      host.clear();
      if (now_s() >= next_packet_s_) {
        next_packet_s_ += kFrame_s;
        for (int id = 0; id < 2; ++id) {
          std::vector<std::uint8_t> one;
          if (format.encode_command(command_[id], {.robot_id = id, .team = session_->config().team}, one))
            host.insert(host.end(), one.begin(), one.end());
        }
      }
      answer.clear();
      session_->step(host, answer);
    }
    session_->set_observer(nullptr);
    result_.wheel_rms_rad_s = count_ > 0 ? std::sqrt(sum2_ / static_cast<double>(count_)) : 0.0;
    return result_;
  }

  void robot_tick(std::int64_t, const RobotSample& sample) override {
    const auto n = static_cast<std::size_t>(sample.robot_id);
    if (now_s() < 0.2) return;
    const RobotCommand& c = command_[n];
    const double cos_yaw = std::cos(sample.truth.yaw_rad), sin_yaw = std::sin(sample.truth.yaw_rad);
    const auto wanted =
        wheel_speeds(geometry_, BodyVelocity<double>{cos_yaw * c.v_forward_m_s + sin_yaw * c.v_left_m_s,
                                                     -sin_yaw * c.v_forward_m_s + cos_yaw * c.v_left_m_s,
                                                     c.omega_body_rad_s});
    for (std::size_t i = 0; i < kWheels; ++i) {
      const double off = sample.truth.omega_wheel_rad_s[i] - wanted[i];
      sum2_ += off * off;
      ++count_;
    }
  }
  void world(std::int64_t now_ns, const World& world) override {
    for (const WorldEvent& event : world.events()) {
      if (event.kind == WorldEventKind::kKick && event.robot == 0) result_.kicked = true;
      if (event.kind == WorldEventKind::kKick && event.robot == 1) shot_ = true;
      if (event.kind == WorldEventKind::kGoal && event.robot > 0 && shot_) {
        result_.scored = true;
        result_.goal_s = 1e-9 * static_cast<double>(now_ns);
      }
    }
  }

 private:
  double now_s() const { return 1e-9 * static_cast<double>(session_->now_ns()); }
  double uniform(double from, double to) { return std::uniform_real_distribution<double>(from, to)(random_); }
  double normal(double sigma) { return std::normal_distribution<double>(0.0, 1.0)(random_) * sigma; }

  void place() {
    const Pose passer{uniform(-1.6, -1.0), uniform(-0.8, 0.8), uniform(-0.4, 0.4)};
    const Pose receiver{uniform(0.7, 1.3), uniform(-0.8, 0.8), std::numbers::pi + uniform(-0.4, 0.4)};
    session_->set_pose(0, passer.x_m, passer.y_m, passer.yaw_rad);
    session_->set_pose(1, receiver.x_m, receiver.y_m, receiver.yaw_rad);
    session_->put_ball({passer.x_m + uniform(0.25, 0.5), passer.y_m + uniform(-0.25, 0.25), 0.0215},
                       {0, 0, 0});
    for (RobotCommand& c : command_) {
      c.mode = OMNIHIL_MODE_BODY_VELOCITY;
      c.flags = OMNIHIL_COMMAND_FIELD_FRAME | OMNIHIL_COMMAND_CAMERA_YAW;
    }
  }

  // Frames are taken at 60 Hz, and reach the host when their delay is over, in order.
  void see() {
    while (now_s() >= next_frame_s_) {
      Frame f;
      f.captured_s = next_frame_s_;
      f.arrives_s = next_frame_s_ + uniform(options_.delay_least_s, options_.delay_most_s);
      for (int n = 0; n < 2; ++n) {
        const PlanarState s = session_->plant().planar_state(n);
        f.robot[n] = {s.x_m + normal(options_.position_sigma_m), s.y_m + normal(options_.position_sigma_m),
                      s.yaw_rad + normal(options_.yaw_sigma_rad)};
      }
      const BallState* const ball = session_->world().ball();
      f.ball_x_m = ball->position.x() + normal(options_.position_sigma_m);
      f.ball_y_m = ball->position.y() + normal(options_.position_sigma_m);
      frames_.push_back(f);
      next_frame_s_ += kFrame_s;
    }
    while (!frames_.empty() && frames_.front().arrives_s <= now_s()) {
      const Frame& f = frames_.front();
      if (seen_any_) {
        const double h = f.captured_s - seen_.captured_s;
        // first-order filter with fading memory, as real_field.h
        ball_vx_ += 0.25 * ((f.ball_x_m - seen_.ball_x_m) / h - ball_vx_);
        ball_vy_ += 0.25 * ((f.ball_y_m - seen_.ball_y_m) / h - ball_vy_);
      }
      seen_ = f;
      seen_any_ = true;
      frames_.pop_front();
    }
  }

  void stop(int n) {
    command_[n].v_forward_m_s = command_[n].v_left_m_s = command_[n].omega_body_rad_s = 0.0;
  }
  // Robot n in the field's frame, which its radio format speaks; its firmware turns by what it knows of its yaw.
  void drive(int n, double v_x_m_s, double v_y_m_s) {
    command_[n].v_forward_m_s = v_x_m_s;
    command_[n].v_left_m_s = v_y_m_s;
  }

  void decide() {
    if (!seen_any_) return;
    for (int n = 0; n < 2; ++n) command_[n].camera_yaw_rad = turn(seen_.robot[n].yaw_rad);
    switch (phase_) {
      case Phase::kAim:
        aim_pass();
        break;
      case Phase::kPass:
        take_pass();
        break;
      case Phase::kShoot:
        shoot();
        break;
    }
  }

  void face(int n, double angle_rad, double feed_forward_rad_s = 0.0) {
    const double off = turn(angle_rad - seen_.robot[n].yaw_rad);
    command_[n].omega_body_rad_s = std::clamp(5.0 * off + feed_forward_rad_s, -4.0, 4.0);
  }

  // Around the ball to its far side from the target, looking at it; then straight into it with the kick armed.
  void kick_towards(int n, double angle_rad, double kick_m_s) {
    const Pose& me = seen_.robot[n];
    const double rx = me.x_m - seen_.ball_x_m, ry = me.y_m - seen_.ball_y_m, far_m = std::hypot(rx, ry);
    const double ux = rx / far_m, uy = ry / far_m, at = std::atan2(ry, rx);
    const double around = turn(angle_rad + std::numbers::pi - at);
    command_[n].dribbler_ratio = 0.0;
    // Armed out of the ball's reach already, for the capacitor's sake: the kick waits for both.
    const bool armed = attacks_[n] || far_m > kOutOfReach_m;
    command_[n].kick = armed ? OMNIHIL_KICK_STRAIGHT : OMNIHIL_KICK_NONE;
    command_[n].kick_when = OMNIHIL_KICK_ON_BALL;
    command_[n].v_kick_m_s = armed ? kick_m_s : 0.0;
    const bool behind = std::abs(around) < kBehind_rad && std::abs(turn(angle_rad - me.yaw_rad)) < kAim_rad;
    if (far_m > kLost_m) attacks_[n] = false;
    if (behind && far_m < kRing_m + 0.03) attacks_[n] = true;
    if (attacks_[n]) {
      const double c = std::cos(angle_rad), s = std::sin(angle_rad), side_m = -s * rx + c * ry;
      drive(n, kInto_m_s * c + 3.0 * side_m * s, kInto_m_s * s - 3.0 * side_m * c);
      face(n, angle_rad);
      return;
    }
    // Away from the ball first: a robot that turns at it pushes it along.
    const double along = far_m > kOutOfReach_m ? std::clamp(5.0 * around * kRing_m, -0.6, 0.6) : 0.0;
    const double out = std::clamp(3.0 * (kRing_m - far_m), -0.8, 0.5);
    drive(n, out * ux - along * uy, out * uy + along * ux);
    face(n, turn(at + std::numbers::pi), along / far_m);
  }
  void rest(int n) {
    stop(n);
    command_[n].kick = OMNIHIL_KICK_NONE;
    command_[n].v_kick_m_s = command_[n].dribbler_ratio = 0.0;
  }

  void aim_pass() {
    const Pose &from = seen_.robot[0], &to = seen_.robot[1];
    const double way_m = std::hypot(to.x_m - seen_.ball_x_m, to.y_m - seen_.ball_y_m) - front_m_;
    face(1, std::atan2(from.y_m - to.y_m, from.x_m - to.x_m));
    kick_towards(0, std::atan2(to.y_m - seen_.ball_y_m, to.x_m - seen_.ball_x_m), kick_for(way_m));
    pass_began_s_ = now_s();
    if (result_.kicked) phase_ = Phase::kPass;
  }

  void take_pass() {
    rest(0);
    const Pose& me = seen_.robot[1];
    command_[1].dribbler_ratio = 1.0;
    const double speed = std::hypot(ball_vx_, ball_vy_);
    const double dx = me.x_m - seen_.ball_x_m, dy = me.y_m - seen_.ball_y_m, way_m = std::hypot(dx, dy);
    const double since_s = now_s() - pass_began_s_;
    const bool comes = since_s < 0.3 || (speed > 0.25 && ball_vx_ * dx + ball_vy_ * dy > 0.0);
    if (comes && speed > 0.25) {
      // Onto the ball's line, across it, looking at where it comes from; giving way as it arrives.
      const double ux = ball_vx_ / speed, uy = ball_vy_ / speed;
      const double across_m = -uy * dx + ux * dy;
      const double side = std::clamp(-6.0 * across_m, -1.5, 1.5);
      const double back = way_m < 0.4 ? kGiveWay_m_s : 0.0;
      drive(1, back * ux - side * uy, back * uy + side * ux);
      face(1, std::atan2(-uy, -ux));
    } else {
      stop(1);
    }
    // Taken: the ball is near and slow.
    if (comes || way_m > kTaken_m) taken_since_s_ = now_s();
    if (now_s() - taken_since_s_ > kHeld_s) {
      result_.received = true;
      result_.pass_s = now_s();
      phase_ = Phase::kShoot;
    }
    if (since_s > 5.0) over_ = true;
  }

  void shoot() {
    if (shot_) return rest(1);
    const double goal_x_m = kFieldSeedPaper.half_length_m();
    kick_towards(1, std::atan2(-seen_.ball_y_m, goal_x_m - seen_.ball_x_m), kShot_m_s);
  }

  enum class Phase { kAim, kPass, kShoot };
  PassOptions options_;
  std::mt19937_64 random_;
  WheelGeometry<double> geometry_;
  double front_m_ = 0.0;
  std::unique_ptr<Session> session_;
  ObserverList observers_{{}};
  RobotCommand command_[2]{};
  std::deque<Frame> frames_;
  Frame seen_;
  bool seen_any_ = false, over_ = false, shot_ = false;
  bool attacks_[2]{};
  double ball_vx_ = 0.0, ball_vy_ = 0.0;
  double next_frame_s_ = 0.0, next_packet_s_ = 0.0, taken_since_s_ = 0.0, pass_began_s_ = 0.0;
  Phase phase_ = Phase::kAim;
  PassResult result_;
  double sum2_ = 0.0;
  std::size_t count_ = 0;
};

}  // namespace

PassResult play_pass_and_shoot(const RobotModel& model, MotorLoop loop, const PassOptions& options) {
  return Play(model, loop, options).run();
}

Share wilson_share(int yes, int of) {
  if (of <= 0) return {};
  constexpr double kZ = 1.959964;  // 95 %
  const double n = of, p = yes / n, z2 = kZ * kZ;
  const double middle = (p + z2 / (2.0 * n)) / (1.0 + z2 / n);
  const double half = kZ / (1.0 + z2 / n) * std::sqrt(p * (1.0 - p) / n + z2 / (4.0 * n * n));
  return {p, std::max(0.0, middle - half), std::min(1.0, middle + half)};
}

double mcnemar_p(int only_first, int only_second) {
  const int n = only_first + only_second, least = std::min(only_first, only_second);
  double term = std::pow(0.5, n), sum = 0.0;
  for (int k = 0; k <= least; ++k) {
    sum += term;
    term *= static_cast<double>(n - k) / static_cast<double>(k + 1);
  }
  return std::min(1.0, 2.0 * sum);
}

}  // namespace omnihil
