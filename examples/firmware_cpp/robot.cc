#include "examples/firmware_cpp/robot.h"

#include <algorithm>
#include <cmath>

namespace example {
namespace {

constexpr float kTwoPi = 6.28318531f;
// Chosen by hand on the bench: the fastest without overshoot on the default robot.
constexpr float kP_V_s_per_rad = 0.06f;  // at the wheel
constexpr float kI_V_per_rad = 0.6f;
constexpr float kRamp_rad_s2 = 150.0f;  // 4 m/s2 at the rim
constexpr float kSpeedFilter_s = 0.002f;
constexpr float kLowest_V = 9.0f;  // below it the bridges' drivers do not switch

}  // namespace

void Robot::take(Order order, std::uint64_t now_us) {
  order_ = order;
  heard_us_ = now_us;
  silent_ = false;
}

void Robot::order_body(float forward_m_s, float left_m_s, float omega_rad_s, std::uint64_t now_us) {
  take(Order::kBody, now_us);
  for (std::size_t n = 0; n < kWheelCount; ++n) {
    const float a = build_.wheel_angle_rad[n];
    wheels_[n].order_rad_s =
        (-std::sin(a) * forward_m_s + std::cos(a) * left_m_s + build_.wheel_center_radius_m * omega_rad_s) /
        build_.wheel_radius_m;
  }
}

void Robot::order_wheels(const std::array<float, kWheelCount>& omega_rad_s, std::uint64_t now_us) {
  take(Order::kWheels, now_us);
  for (std::size_t n = 0; n < kWheelCount; ++n) wheels_[n].order_rad_s = omega_rad_s[n];
}

void Robot::order_duty(const std::array<float, kWheelCount>& duty, std::uint64_t now_us) {
  take(Order::kDuty, now_us);
  for (std::size_t n = 0; n < kWheelCount; ++n) wheels_[n].duty = std::clamp(duty[n], -1.0f, 1.0f);
}

void Robot::poll(std::uint64_t now_us) {
  now_us_ = now_us;
  scheduler_.run(*this, now_us);
}

// 50 Hz: battery and radio watchdog.
void Robot::slow_task(float) {
  battery_V_ = 1e-3f * static_cast<float>(hardware.battery_mV);
  silent_ = silent_ || now_us_ - heard_us_ > build_.silence_us;
  if (!silent_) return;
  for (Wheel& w : wheels_) w.order_rad_s = 0.0f;
  if (order_ == Order::kDuty) order_ = Order::kWheels;  // brake under control, then let go
  const bool standing =
      std::ranges::all_of(wheels_, [](const Wheel& w) { return std::abs(w.omega_rad_s) < 0.5f; });
  if (standing) order_ = Order::kOff;
}

// 500 Hz: targets move no faster than the tyres hold. All wheels by one factor, so that the direction stays.
void Robot::motion_task(float dt_s) {
  float furthest_rad_s = 0.0f;
  for (const Wheel& w : wheels_) {
    furthest_rad_s = std::max(furthest_rad_s, std::abs(w.order_rad_s - w.target_rad_s));
  }
  const float step_rad_s = kRamp_rad_s2 * dt_s;
  const float part = furthest_rad_s > step_rad_s ? step_rad_s / furthest_rad_s : 1.0f;
  for (Wheel& w : wheels_) w.target_rad_s += part * (w.order_rad_s - w.target_rad_s);
}

// 2 kHz: encoders, speed loops, PWM.
void Robot::wheel_task(float dt_s) {
  const float rad_per_count = kTwoPi / (build_.counts_per_rotor_turn * build_.gear_ratio);
  hardware.bridges_on = order_ != Order::kOff && battery_V_ > kLowest_V;
  for (std::size_t n = 0; n < kWheelCount; ++n) {
    Wheel& w = wheels_[n];
    const auto moved = static_cast<std::int16_t>(hardware.encoder_timer[n] - w.last_count);  // wraps
    w.last_count = hardware.encoder_timer[n];
    const float speed_rad_s = counted_ ? rad_per_count * static_cast<float>(moved) / dt_s : 0.0f;
    w.omega_rad_s += dt_s / (kSpeedFilter_s + dt_s) * (speed_rad_s - w.omega_rad_s);
    if (!hardware.bridges_on) {
      w.integral_V = 0.0f;
      w.target_rad_s = w.omega_rad_s;
      if (order_ != Order::kDuty) w.duty = 0.0f;
    } else if (order_ != Order::kDuty) {
      drive(w, dt_s);
    }
    hardware.pwm_compare[n] = static_cast<std::int16_t>(std::lround(w.duty * kPwmTop));
  }
  counted_ = true;
}

// u = k omega_target + P e + I; at the supply's limit the integral stops growing.
void Robot::drive(Wheel& w, float dt_s) {
  const float error_rad_s = w.target_rad_s - w.omega_rad_s;
  const float forward_V = build_.volt_per_rotor_rad_s * build_.gear_ratio * w.target_rad_s;
  const float integral_V = w.integral_V + kI_V_per_rad * error_rad_s * dt_s;
  const float wanted_V = forward_V + kP_V_s_per_rad * error_rad_s + integral_V;
  const float given_V = std::clamp(wanted_V, -battery_V_, battery_V_);
  constexpr float kIntegralMost_V = 2.0f;  // friction and a flat battery, not a blocked wheel
  if (given_V == wanted_V) w.integral_V = std::clamp(integral_V, -kIntegralMost_V, kIntegralMost_V);
  w.duty = given_V / battery_V_;
}

}  // namespace example
