#include "identify/predict/firmware_loop.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/robot/speed_loop.h"

namespace omnihil {

RobotCommand radio_command(std::span<const double> value, CommandFrame frame) {
  RobotCommand c{};
  if (frame == CommandFrame::kBodyVelocity) {
    c.mode = OMNIHIL_MODE_BODY_VELOCITY;
    c.v_forward_m_s = value[0], c.v_left_m_s = value[1], c.omega_body_rad_s = value[2];
  } else {
    c.mode = OMNIHIL_MODE_WHEEL_SPEED;
    std::copy_n(value.begin(), kWheels, std::begin(c.omega_wheel_rad_s));
  }
  return c;
}

FirmwareLoop::FirmwareLoop(const FirmwareSource& source, double latency_s, double start_s,
                           double report_filter_s)
    : firmware_(source.fresh()),
      counts_per_rad_(source.counts_per_rotor_turn() / (2.0 * std::numbers::pi)),
      latency_s_(latency_s),
      start_s_(start_s),
      report_filter_s_(report_filter_s),
      next_s_(start_s),
      period_s_(1e-9 * static_cast<double>(firmware_->control_period_ns())),
      last_s_(start_s) {}

// Its clock begins at its first tick, at one period: 0 would be no time to some.
std::int64_t FirmwareLoop::clock_ns(double now_s) const {
  return firmware_->control_period_ns() + std::llround(1e9 * (now_s - start_s_));
}

void FirmwareLoop::hear(double now_s, std::span<const double> value, CommandFrame frame) {
  packets_.push_back({now_s + latency_s_, radio_command(value, frame)});
}

void FirmwareLoop::tick(double now_s, const RobotInstant& sees) {
  while (!packets_.empty() && packets_.front().due_s <= now_s + kSame_s) {
    firmware_->command(packets_.front().command, clock_ns(now_s));
    packets_.pop_front();
  }
  RobotSensors s{};
  s.now_us = static_cast<std::uint64_t>(clock_ns(now_s) / 1000);
  const double span_s = now_s - last_s_;
  const double share = ticks_ > 0 ? low_pass_share(report_filter_s_, period_s_) : 1.0;
  RobotShafts shafts{};
  for (std::size_t i = 0; i < kWheels; ++i) {
    s.encoder_counts[i] = static_cast<std::int64_t>(std::floor(sees.theta_rotor_rad[i] * counts_per_rad_));
    shafts.theta_rotor_rad[i] = sees.theta_rotor_rad[i];
    shafts.omega_rotor_rad_s[i] = sees.omega_rotor_rad_s[i];
    filtered_rad_s_[i] += (sees.omega_rotor_rad_s[i] - filtered_rad_s_[i]) * share;
    s.motor_current_A[i] = ticks_ > 0 && span_s > 0.0 ? (sees.charge_C[i] - last_charge_C_[i]) / span_s : 0.0;
    last_charge_C_[i] = sees.charge_C[i];
  }
  s.bus_voltage_V = sees.bus_voltage_V;
  s.gyro_z_rad_s = sees.gyro_rad_s;
  s.accel_x_m_s2 = sees.accel_x_m_s2;
  s.accel_y_m_s2 = sees.accel_y_m_s2;
  firmware_->shafts(shafts);
  const RobotDrive drive = firmware_->tick(s);
  for (std::size_t i = 0; i < kWheels; ++i) {
    enabled_[i] = drive.mode[i] == OMNIHIL_DRIVE_DUTY;
    duty_[i] = enabled_[i] ? drive.duty_ratio[i] : 0.0;
  }
  last_s_ = now_s;
  next_s_ = start_s_ + static_cast<double>(++ticks_) * period_s_;
}

bool FirmwareLoop::tells(double gear_ratio, std::array<double, kWheels>& omega_rotor_rad_s) const {
  if (ticks_ == 0) return false;
  const RobotFeedback told = firmware_->feedback();
  omega_rotor_rad_s = filtered_rad_s_;
  if (told.now_us == 0) return report_filter_s_ > 0.0;
  for (std::size_t i = 0; i < kWheels; ++i) omega_rotor_rad_s[i] = told.omega_wheel_rad_s[i] * gear_ratio;
  return true;
}

}  // namespace omnihil
