#include "firmware_iface/motor_bus/motor_axis.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace omnihil {
namespace {
constexpr double kTwoPi = 2.0 * std::numbers::pi;
constexpr double kTracking_rad_s = 1000.0;    // ODrive's default encoder bandwidth
constexpr double kRimSpeedStep_m_s = 0.02;    // what one count may look like
constexpr double kTrimTime_s = 5e-3;          // ten winding time constants and more
constexpr double kTrimShare = 0.2;            // of the bus voltage
constexpr double kMinBus_V = 1.0;             // below it no duty means anything
constexpr double kMassGuess_kg = 2.5;         // guess, robots of the league: 2.0 to 3.0 kg
constexpr double kRotorInertia_kg_m2 = 1e-5;  // guess, 30 to 70 W flat motors: 0.5e-5 to 1.8e-5
constexpr double kWheelInertia_kg_m2 = 1e-5;  // guess, 50 to 60 mm omni wheel: 0.5e-5 to 3e-5
constexpr double kLoaded_rad_s = 40.0;        // speed loop on the floor
constexpr double kFreeTimesDelay = 0.4;       // speed loop of a free wheel times its delay
}  // namespace

MotorAxis::MotorAxis(const RobotConfig& robot, BusShaft shaft, double period_s)
    : period_s_(period_s),
      ratio_(shaft == BusShaft::kWheel ? robot.gear_ratio : 1.0),
      rad_per_count_(kTwoPi / robot.encoder_counts_per_rotor_turn),
      torque_constant_(robot.motor_torque_constant_Nm_per_A),
      resistance_ohm_(robot.motor_resistance_ohm) {
  const double gear = robot.gear_ratio, radius_m = robot.wheel_radius_m;
  // One count moves the estimate by b^2 dt per count; held to the rim speed step.
  const double step_wanted_rad_s = kRimSpeedStep_m_s * gear / radius_m;
  tracking_rad_s_ =
      std::min(kTracking_rad_s, std::sqrt(step_wanted_rad_s / (period_s * std::abs(rad_per_count_))));
  // Half of what the stalled motor would take: well above what tyres transmit.
  current_limit_A_ = 0.5 * robot.bus_voltage_nominal_V / resistance_ohm_;
  const double free_kg_m2 = kRotorInertia_kg_m2 + kWheelInertia_kg_m2 / (gear * gear);
  // m v^2 = J sum(omega_i^2) and sum(omega_i^2) = 2 (gear v / r)^2 on average over directions
  const double loaded_kg_m2 = free_kg_m2 + kMassGuess_kg * radius_m * radius_m / (2.0 * gear * gear);
  const double delay_s = 1.5 * period_s + 2.0 / tracking_rad_s_;
  p_ = std::min(kLoaded_rad_s * loaded_kg_m2, kFreeTimesDelay / delay_s * free_kg_m2);
  i_ = p_ * (p_ / loaded_kg_m2) / 4.0;
}

double MotorAxis::turns() const { return theta_shaft_rad() / kTwoPi; }
double MotorAxis::turns_s() const { return omega_shaft_rad_s() / kTwoPi; }

void MotorAxis::sense(std::int64_t counts, double current_A, double bus_voltage_V) {
  const double theta_count_rad = static_cast<double>(counts) * rad_per_count_;
  if (!sensed_) theta_rad_ = theta_count_rad;
  sensed_ = true;
  counts_ = counts;
  const double b = tracking_rad_s_;
  theta_rad_ += omega_rad_s_ * period_s_;
  const double error_rad = theta_count_rad - theta_rad_;
  theta_rad_ += std::min(1.0, 2.0 * b * period_s_) * error_rad;
  omega_rad_s_ += b * b * period_s_ * error_rad;
  current_A_ = current_A;
  bus_V_ = bus_voltage_V;
}

void MotorAxis::rest() {
  integral_Nm_ = 0;
  trim_V_ = 0;
  current_demand_A_ = 0;
  duty_ = 0;
  saturated_ = 0;
}

void MotorAxis::coast() {
  rest();
  mode_ = OMNIHIL_DRIVE_COAST;
}

void MotorAxis::brake() {
  rest();
  mode_ = OMNIHIL_DRIVE_DUTY;
}

void MotorAxis::set_duty(double duty_ratio) {
  rest();
  mode_ = OMNIHIL_DRIVE_DUTY;
  duty_ = std::clamp(duty_ratio, -1.0, 1.0);
}

void MotorAxis::set_voltage(double voltage_V) {
  rest();
  apply_voltage(voltage_V);
}

void MotorAxis::apply_voltage(double voltage_V) {
  if (bus_V_ < kMinBus_V) return coast();
  const double wanted = voltage_V / bus_V_;
  duty_ = std::clamp(wanted, -1.0, 1.0);
  saturated_ = wanted > 1.0 ? 1 : wanted < -1.0 ? -1 : 0;
  mode_ = OMNIHIL_DRIVE_DUTY;
}

void MotorAxis::set_current(double current_A) {
  current_demand_A_ = std::clamp(current_A, -current_limit_A_, current_limit_A_);
  const double error_A = current_demand_A_ - current_A_;
  if (saturated_ * error_A <= 0.0) {
    const double limit_V = kTrimShare * bus_V_;
    trim_V_ = std::clamp(trim_V_ + resistance_ohm_ * error_A * period_s_ / kTrimTime_s, -limit_V, limit_V);
  }
  // V = R i* + k omega + trim
  apply_voltage(resistance_ohm_ * current_demand_A_ + torque_constant_ * omega_rad_s_ + trim_V_);
}

void MotorAxis::set_torque(double torque_shaft_Nm) {
  integral_Nm_ = 0;
  set_current(torque_shaft_Nm / ratio_ / torque_constant_);
}

void MotorAxis::set_speed(double omega_shaft_rad_s, double torque_feedforward_Nm) {
  const double error_rad_s = omega_shaft_rad_s * ratio_ - omega_rad_s_;
  const double limit_Nm = current_limit_A_ * torque_constant_;
  const double proportional_Nm = torque_feedforward_Nm / ratio_ + p_ * error_rad_s;
  const bool cut = saturated_ * error_rad_s > 0.0 ||
                   (std::abs(proportional_Nm + integral_Nm_) >= limit_Nm && integral_Nm_ * error_rad_s > 0.0);
  if (!cut) {
    integral_Nm_ = std::clamp(integral_Nm_ + i_ * error_rad_s * period_s_, -limit_Nm, limit_Nm);
  }
  set_current((proportional_Nm + integral_Nm_) / torque_constant_);
}

void MotorAxis::set_speed_gains(double p_Nm_s_per_rad, double i_Nm_per_rad) {
  p_ = p_Nm_s_per_rad / (ratio_ * ratio_);
  i_ = i_Nm_per_rad / (ratio_ * ratio_);
}

void MotorAxis::drive(std::uint32_t& mode, double& duty_ratio) const {
  mode = mode_;
  duty_ratio = duty_;
}

}  // namespace omnihil
