// What makes duties of radio commands: the part of a robot's firmware between the antenna and the bridges, as numbers.
//
//   RadioController<double> controller(params, wheel_angle_rad, gear_ratio);      // an angle per wheel
//   controller.hear(now_s, {0.5, 0.0, 1.0}, CommandFrame::kBodyVelocity);                 // m/s, m/s, rad/s, held from now on
//   PerWheel<double> duty = controller.update(now_s, omega_rotor_rad_s, bus_voltage_V, duty_limit_ratio);
//
// Once per period_s:
//   b   = what was commanded, as the robot may follow it: |dv| <= acceleration_limit dt, |dw| <= yaw_acceleration_limit
//         dt, of wheel speeds |dr| <= rate_limit dt (0: at once); and all three together by what the hardest-worked wheel
//         may push: |G+ (dv_x, dv_y, R_b^2 dw / 2)|_i <= planned_grip g / n dt, a disc on n equal loads (0: no limit)
//   c   = b, latency_s ago, mean over the period
//   r_i = gear (-sin(a_i) c_x + cos(a_i) c_y + R_b c_w) / R     R, R_b: the firmware's constants, not the robot's
//   duty_i = speed loop of r_i (speed_loop.h) over the bus
// The limits know no state of the robot, so that the delay may stand behind them: there it has a derivative. Without a
// command for timeout_s (0: never) zero is commanded. Source: what the league's
// open firmwares have in common (docs/radio-driven.md).
// Cannot: hold a heading by the gyro, control the path, schedule gains, know of a current limit.
#pragma once
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <span>

#include "sim/law/command_history.h"
#include "sim/robot/geometry.h"
#include "sim/robot/speed_loop.h"

namespace omnihil {

template <typename T>
struct RadioControllerParams {
  SpeedLoopParams<T> loop;
  T latency_s = T(0);  // from a command's stamp to the loop that follows it
  double acceleration_limit_m_s2 = 0.0, yaw_acceleration_limit_rad_s2 = 0.0, rate_limit_rad_s2 = 0.0;
  double planned_grip = 0.0;  // friction coefficient that accelerations are planned with; 0: none
  double period_s = 1e-3, timeout_s = 0.0;
  double report_filter_s = 0.0;  // of the speeds that telemetry tells; 0: as the loop sees them
  double wheel_radius_m = 0.0, wheel_center_radius_m = 0.0;  // that the firmware believes
};

enum class CommandFrame : std::uint8_t {
  kBodyVelocity,  // m/s, m/s, rad/s
  kWheelSpeeds    // rad/s at the wheel
};

template <typename T>
class RadioController {
 public:
  RadioController(const RadioControllerParams<T>& params, std::span<const double> wheel_angle_rad,
                  double gear_ratio)
      : p_(params), gear_(gear_ratio) {
    geometry_.wheels = wheel_angle_rad.size();
    for (std::size_t i = 0; i < geometry_.wheels; ++i) {
      geometry_.cos_angle[i] = std::cos(wheel_angle_rad[i]);
      geometry_.sin_angle[i] = std::sin(wheel_angle_rad[i]);
    }
    geometry_.wheel_center_radius_m = params.wheel_center_radius_m;
    geometry_.wheel_radius_m = params.wheel_radius_m;
    with_wheel_rows(geometry_.wheels, [&](auto rows) {
      const auto rim = rim_matrix_of<rows()>(geometry_);  // G
      const Eigen::Matrix3d normal = rim.transpose() * rim;
      push_ = rim * (axles_are_parallel(geometry_)
                         ? inverse_without<double>(normal, 0, geometry_.cos_angle[0], geometry_.sin_angle[0])
                         : Eigen::Matrix3d(normal.inverse()));
    });
    report_share_ = low_pass_share(params.report_filter_s, params.period_s);
  }

  // Body: v_forward, v_left, omega. Wheels: a speed each.
  void hear(double now_s, const PerWheel<double>& command, CommandFrame frame) {
    frame_ = frame;
    heard_s_ = now_s;
    heard_ = true;
    command_ = command;
  }

  // The robot moves already when the record begins: it follows what it does, and integrals are as when all is settled.
  void begin(const BodyVelocity<double>& body, const PerWheel<T>& omega_rotor_rad_s,
             const T& settled_V_s_per_rad, CommandFrame frame) {
    frame_ = frame;
    followed_ = {body.v_forward_m_s, body.v_left_m_s, body.omega_body_rad_s, 0.0};
    if (frame == CommandFrame::kWheelSpeeds) {
      for (std::size_t i = 0; i < geometry_.wheels; ++i)
        followed_[i] = value_of(omega_rotor_rad_s[i]) / gear_;
    }
    command_ = followed_;
    for (std::size_t i = 0; i < geometry_.wheels; ++i) {
      state_[i].filtered_rad_s = state_[i].reference_rad_s = reported_[i] = omega_rotor_rad_s[i];
      state_[i].integral_V = (settled_V_s_per_rad - p_.loop.feedforward_V_s_per_rad) * omega_rotor_rad_s[i];
    }
  }

  // One period; omega: means over the period before.
  PerWheel<T> update(double now_s, const PerWheel<T>& omega_rotor_rad_s, const T& bus_voltage_V,
                     double limit_ratio) {
    const PerWheel<T> reference = references(now_s);
    PerWheel<T> duty{};
    for (std::size_t i = 0; i < geometry_.wheels; ++i) {
      const T u = speed_loop_voltage(p_.loop, state_[i],
                                     {.reference_rad_s = reference[i],
                                      .omega_rad_s = omega_rotor_rad_s[i],
                                      .bus_voltage_V = bus_voltage_V,
                                      .dt_s = p_.period_s,
                                      .limit_ratio = limit_ratio});
      reported_[i] += (omega_rotor_rad_s[i] - reported_[i]) * report_share_;
      duty[i] = value_of(bus_voltage_V) > 0.0 ? T(u / bus_voltage_V) : T(0);
    }
    return duty;
  }

  // As telemetry tells it.
  const T& reported_rad_s(std::size_t wheel) const {
    return p_.report_filter_s > 0.0 ? reported_[wheel] : state_[wheel].filtered_rad_s;
  }
  double period_s() const { return p_.period_s; }

 private:
  std::size_t axes() const { return frame_ == CommandFrame::kBodyVelocity ? 3 : geometry_.wheels; }

  PerWheel<T> references(double now_s) {
    // The first command is as late as any other: until it is due the robot goes on as it began.
    for (std::size_t a = 0; a < axes() && history_[a].count == 0; ++a)
      history_[a].push(now_s - p_.period_s, followed_[a]);
    follow(!heard_ || (p_.timeout_s > 0.0 && now_s - heard_s_ > p_.timeout_s));
    PerWheel<T> asked{}, out{};
    for (std::size_t a = 0; a < axes(); ++a) {
      history_[a].push(now_s, followed_[a]);
      asked[a] = mean_over(history_[a], T(now_s - p_.latency_s), p_.period_s);
    }
    for (std::size_t i = 0; i < geometry_.wheels; ++i) {
      if (frame_ == CommandFrame::kWheelSpeeds) {
        out[i] = asked[i] * gear_;
        continue;
      }
      const T rim_m_s = -geometry_.sin_angle[i] * asked[0] + geometry_.cos_angle[i] * asked[1] +
                        geometry_.wheel_center_radius_m * asked[2];
      out[i] = rim_m_s * (gear_ / geometry_.wheel_radius_m);
    }
    return out;
  }

  void follow(bool silent) {
    PerWheel<double> gap{};
    for (std::size_t a = 0; a < axes(); ++a) gap[a] = (silent ? 0.0 : command_[a]) - followed_[a];
    const auto within = [&](double& change, double limit_per_s) {
      const double most = limit_per_s * p_.period_s;
      if (most > 0.0) change = std::clamp(change, -most, most);
    };
    if (frame_ == CommandFrame::kWheelSpeeds) {
      for (double& change : gap) within(change, p_.rate_limit_rad_s2 / gear_);
    } else {
      const double most = p_.acceleration_limit_m_s2 * p_.period_s, size = std::hypot(gap[0], gap[1]);
      if (most > 0.0 && size > most) gap[0] *= most / size, gap[1] *= most / size;
      within(gap[2], p_.yaw_acceleration_limit_rad_s2);
      if (p_.planned_grip > 0.0) plan(gap);
    }
    for (std::size_t a = 0; a < axes(); ++a) followed_[a] += gap[a];
  }

  void plan(PerWheel<double>& gap) const {
    constexpr double kWeight_N_per_kg = 9.81;
    const double yaw = 0.5 * p_.wheel_center_radius_m * p_.wheel_center_radius_m * gap[2];
    const double hardest = (push_ * Eigen::Vector3d(gap[0], gap[1], yaw)).cwiseAbs().maxCoeff();
    const double most =
        p_.planned_grip * (kWeight_N_per_kg / static_cast<double>(geometry_.wheels)) * p_.period_s;
    if (hardest <= most) return;
    for (std::size_t a = 0; a < 3; ++a) gap[a] *= most / hardest;
  }

  RadioControllerParams<T> p_;
  WheelGeometry<double> geometry_;
  WheelRows<double, Eigen::Dynamic> push_;  // of each wheel for an acceleration of the body: G (G' G)^-1
  double gear_ = 1.0;
  CommandFrame frame_ = CommandFrame::kBodyVelocity;
  double heard_s_ = 0.0;
  bool heard_ = false;
  PerWheel<CommandHistory> history_;
  PerWheel<double> command_{}, followed_{};
  PerWheel<SpeedLoopState<T>> state_;
  PerWheel<T> reported_{};
  double report_share_ = 1.0;
};

}  // namespace omnihil
