// What makes duties of radio commands: the part of a robot's firmware between the antenna and the bridges, as numbers.
//
//   RadioController<double> controller(params, geometry, gear_ratio);
//   controller.hear(now_s, {0.5, 0.0, 1.0}, CommandFrame::kBody);                 // m/s, m/s, rad/s, held from now on
//   std::array<double, kWheels> duty = controller.update(now_s, omega_rotor_rad_s, bus_voltage_V, duty_limit_ratio);
//
// Once per period_s:
//   c   = what was commanded, latency_s ago, mean over the period
//   b   = c as the robot may follow it: |dv| <= acceleration_limit dt, |dw| <= yaw_acceleration_limit dt (0: at once)
//   r_i = gear (-sin(a_i) b_x + cos(a_i) b_y + R_b b_w) / R     R, R_b: the firmware's constants, not the robot's
//   duty_i = speed loop of r_i (speed_loop.h) over the bus
// Without a command for timeout_s (0: never) the references are zero. Commands of wheel speeds skip the second and the
// third line. Source: the league's firmwares, as read in docs/radio-driven.md.
// Cannot: hold a heading by the gyro, control the path, schedule gains, know of a current limit.
#pragma once
#include <array>
#include <cmath>

#include "sim/law/command_history.h"
#include "sim/robot/geometry.h"
#include "sim/robot/speed_loop.h"

namespace omnihil {

template <typename T>
struct RadioControllerParams {
  SpeedLoopParams<T> loop;  // rate_limit_rad_s2 of wheel speed commands alone
  T latency_s = T(0);       // from a command's stamp to the loop that follows it
  T acceleration_limit_m_s2 = T(0), yaw_acceleration_limit_rad_s2 = T(0);
  double period_s = 1e-3, timeout_s = 0.0;
  double wheel_radius_m = 0.0, wheel_center_radius_m = 0.0;  // that the firmware believes
};

enum class CommandFrame : std::uint8_t {
  kBody,
  kWheels
};  // of the robot's body; wheels' speeds, rad/s at the wheel

template <typename T>
class RadioController {
 public:
  RadioController(const RadioControllerParams<T>& params, const std::array<double, kWheels>& wheel_angle_rad,
                  double gear_ratio)
      : p_(params), gear_(gear_ratio) {
    for (std::size_t i = 0; i < kWheels; ++i) {
      geometry_.cos_angle[i] = std::cos(wheel_angle_rad[i]);
      geometry_.sin_angle[i] = std::sin(wheel_angle_rad[i]);
    }
    geometry_.wheel_center_radius_m = params.wheel_center_radius_m;
    geometry_.wheel_radius_m = params.wheel_radius_m;
  }

  // Body: v_forward, v_left, omega. Wheels: four speeds.
  void hear(double now_s, const std::array<double, kWheels>& command, CommandFrame frame) {
    frame_ = frame;
    heard_s_ = now_s;
    heard_ = true;
    for (std::size_t a = 0; a < kWheels; ++a) history_[a].push(now_s, command[a]);
  }

  // The robot moves already when the record begins: integrals as they are when everything is settled.
  void begin(const std::array<T, kWheels>& omega_rotor_rad_s, const T& settled_V_s_per_rad) {
    for (std::size_t i = 0; i < kWheels; ++i) {
      state_[i].filtered_rad_s = state_[i].reference_rad_s = omega_rotor_rad_s[i];
      state_[i].integral_V = (settled_V_s_per_rad - p_.loop.feedforward_V_s_per_rad) * omega_rotor_rad_s[i];
    }
  }

  // One period; omega: means over the period before.
  std::array<T, kWheels> update(double now_s, const std::array<T, kWheels>& omega_rotor_rad_s,
                                const T& bus_voltage_V, double limit_ratio) {
    const std::array<T, kWheels> reference = references(now_s);
    std::array<T, kWheels> duty{};
    for (std::size_t i = 0; i < kWheels; ++i) {
      const T u = speed_loop_voltage(params_of_loop(), state_[i],
                                     {.reference_rad_s = reference[i],
                                      .omega_rad_s = omega_rotor_rad_s[i],
                                      .bus_voltage_V = bus_voltage_V,
                                      .dt_s = p_.period_s,
                                      .limit_ratio = limit_ratio});
      duty[i] = value_of(bus_voltage_V) > 0.0 ? T(u / bus_voltage_V) : T(0);
    }
    return duty;
  }

  // As the loop sees it, and telemetry reports it.
  const T& measured_rad_s(std::size_t wheel) const { return state_[wheel].filtered_rad_s; }
  double period_s() const { return p_.period_s; }

 private:
  SpeedLoopParams<T> params_of_loop() const {
    SpeedLoopParams<T> loop = p_.loop;
    if (frame_ == CommandFrame::kBody) loop.rate_limit_rad_s2 = T(0);  // the body's limits are there
    return loop;
  }

  std::array<T, kWheels> references(double now_s) {
    std::array<T, kWheels> asked{}, out{};
    const bool silent = !heard_ || (p_.timeout_s > 0.0 && now_s - heard_s_ > p_.timeout_s);
    for (std::size_t a = 0; a < kWheels && !silent; ++a)
      asked[a] = mean_over(history_[a], T(now_s - p_.latency_s), p_.period_s);
    if (frame_ == CommandFrame::kWheels) {
      for (std::size_t i = 0; i < kWheels; ++i) out[i] = asked[i] * gear_;
      return out;
    }
    follow(asked);
    for (std::size_t i = 0; i < kWheels; ++i) {
      const T rim_m_s = -geometry_.sin_angle[i] * body_[0] + geometry_.cos_angle[i] * body_[1] +
                        geometry_.wheel_center_radius_m * body_[2];
      out[i] = rim_m_s * (gear_ / geometry_.wheel_radius_m);
    }
    return out;
  }

  void follow(const std::array<T, kWheels>& asked) {
    using std::sqrt;
    T x = asked[0] - body_[0], y = asked[1] - body_[1], w = asked[2] - body_[2];
    const T gap2 = x * x + y * y;
    const T step = p_.acceleration_limit_m_s2 * p_.period_s,
            turn = p_.yaw_acceleration_limit_rad_s2 * p_.period_s;
    if (value_of(step) > 0.0 && value_of(gap2) > value_of(step) * value_of(step)) {
      const T share = step / sqrt(gap2);
      x *= share;
      y *= share;
    }
    if (value_of(turn) > 0.0 && std::abs(value_of(w)) > value_of(turn)) w = sign_of(w) * turn;
    body_[0] += x;
    body_[1] += y;
    body_[2] += w;
  }

  RadioControllerParams<T> p_;
  WheelGeometry<double> geometry_;
  double gear_ = 1.0;
  CommandFrame frame_ = CommandFrame::kBody;
  double heard_s_ = 0.0;
  bool heard_ = false;
  std::array<CommandHistory, kWheels> history_;
  std::array<T, 3> body_{};
  std::array<SpeedLoopState<T>, kWheels> state_;
};

}  // namespace omnihil
