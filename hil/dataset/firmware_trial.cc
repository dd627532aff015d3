#include "hil/dataset/firmware_trial.h"

#include <algorithm>
#include <cmath>

namespace omnihil {

RobotCommand FirmwareTrial::command() const {
  RobotCommand c{};
  c.mode = mode_;
  c.v_forward_m_s = level_ * std::sin(0.01 * ticks_);
  c.v_left_m_s = 0.5 * level_;
  c.omega_body_rad_s = level_ * std::cos(0.013 * ticks_);
  if (mode_ == OMNIHIL_MODE_BODY_VELOCITY) return c;
  constexpr double kFast_rad_s = 20.0;  // of a wheel at level 1: any
  c = {};
  c.mode = mode_;
  for (std::size_t i = 0; i < kWheels; ++i)
    c.omega_wheel_rad_s[i] = kFast_rad_s * level_ * std::sin(0.01 * ticks_ + static_cast<double>(i));
  return c;
}

void FirmwareTrial::step() {
  constexpr double kFree_rad_s = 300.0, kLag = 0.02;  // of a rotor at full duty, and per tick: any
  const std::int64_t period_ns = firmware_.control_period_ns(), now_ns = ++ticks_ * period_ns;
  if (ticks_ % 20 == 1) firmware_.command(command(), now_ns);
  RobotSensors s{};
  RobotShafts shafts{};
  s.now_us = static_cast<std::uint64_t>(now_ns / 1000);
  s.bus_voltage_V = config_.bus_voltage_nominal_V;
  const double counts_per_rad = config_.encoder_counts_per_rotor_turn / 6.283185307179586;
  for (std::size_t i = 0; i < kWheels; ++i) {
    turned_rad_[i] += 1e-9 * static_cast<double>(period_ns) * omega_rad_s_[i];
    s.encoder_counts[i] = static_cast<std::int64_t>(std::floor(counts_per_rad * turned_rad_[i]));
    shafts.theta_rotor_rad[i] = turned_rad_[i];
    shafts.omega_rotor_rad_s[i] = omega_rad_s_[i];
  }
  firmware_.shafts(shafts);
  const RobotDrive d = firmware_.tick(s);
  for (std::size_t i = 0; i < kWheels; ++i) {
    const double duty = d.mode[i] == OMNIHIL_DRIVE_DUTY ? d.duty_ratio[i] : 0.0;
    omega_rad_s_[i] += kLag * (kFree_rad_s * duty - omega_rad_s_[i]);
    asked_.push_back(duty);
  }
}

std::vector<double> FirmwareTrial::run() {
  for (int n = 0; n < kTicks && firmware_.failure().empty(); ++n) step();
  return asked_;
}

bool asks_nothing(const std::vector<double>& asked) {
  return std::all_of(asked.begin(), asked.end(), [](double v) { return v == 0.0; });
}

}  // namespace omnihil
