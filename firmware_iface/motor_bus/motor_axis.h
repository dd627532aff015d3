// One motor as a motor controller on a bus sees it: encoder to speed, demand to bridge duty.
//
//   MotorAxis axis(robot_config, BusShaft::kRotor, 500e-6);
//   axis.sense(counts, current_A, bus_V);           // once per control period
//   axis.set_speed(30.0, 0.0);                      // or set_torque(), set_voltage(), set_duty(), coast()
//   axis.drive(mode, duty_ratio);                   // what the bridge gets
//
// Laws. Speed: second-order tracking loop on the count (as ODrive and moteus estimate it, a "PLL"),
//   theta' = omega + 2 b (theta_count - theta),  omega' = b^2 (theta_count - theta),
// b = 1000 rad/s, less where one count would look like more than 0.02 m/s at the rim. Torque: tau = k i, and
//   V = R i* + k omega + trim,   trim' = R (i* - i) / 5 ms,   |trim| <= 20 % of the bus.
// Speed loop: tau = ff + p e + integral of i e. p gives 40 rad/s to a robot on the floor, less where a wheel
// in the air would not stand it; i = p bandwidth / 4 (critically damped: s^2 + w s + w^2/4).
// All values of the interface are at the bus's shaft, rotor or wheel; motor constants are the rotor's.
// Valid for R, k of small DC drives and of brushless ones that commutate by themselves (duty bridges).
// Cannot: current loop bandwidth (it is a static inverse and a slow trim, one duty per 0.5 ms), field
// weakening, cogging compensation, temperature (no such sensor reaches a board here).
#pragma once
#include <cstdint>

#include "firmware_iface/robot_io.h"

namespace omnihil {

enum class BusShaft : std::uint8_t { kRotor, kWheel };

class MotorAxis {
 public:
  MotorAxis() = default;
  MotorAxis(const RobotConfig& robot, BusShaft shaft, double period_s);

  void sense(std::int64_t counts, double current_A, double bus_voltage_V);
  double theta_shaft_rad() const { return theta_rad_ / ratio_; }
  double omega_shaft_rad_s() const { return omega_rad_s_ / ratio_; }
  double turns() const;
  double turns_s() const;
  double current_A() const { return current_A_; }
  double torque_shaft_Nm() const { return current_A_ * torque_constant_ * ratio_; }
  double bus_voltage_V() const { return bus_V_; }
  std::int64_t counts() const { return counts_; }

  void coast();  // bridge open
  void brake();  // phases shorted
  void set_duty(double duty_ratio);
  void set_voltage(double voltage_V);
  void set_current(double current_A);
  void set_torque(double torque_shaft_Nm);
  void set_speed(double omega_shaft_rad_s, double torque_feedforward_Nm);
  // Of set_speed(), at the shaft.
  void set_speed_gains(double p_Nm_s_per_rad, double i_Nm_per_rad);
  void set_current_limit(double limit_A) { current_limit_A_ = limit_A; }

  void drive(std::uint32_t& mode, double& duty_ratio) const;
  double current_demand_A() const { return current_demand_A_; }
  double torque_demand_Nm() const { return current_demand_A_ * torque_constant_ * ratio_; }
  double torque_limit_Nm() const { return current_limit_A_ * torque_constant_ * ratio_; }
  double speed_gain_p() const { return p_ * ratio_ * ratio_; }
  double speed_gain_i() const { return i_ * ratio_ * ratio_; }
  // Of the shaft; the motor's torque constant is both, one over the gear ratio or times it.
  double back_emf_V_s_per_rad() const { return torque_constant_ * ratio_; }
  double torque_shaft_Nm_per_A() const { return torque_constant_ * ratio_; }
  double duty_ratio() const { return duty_; }
  bool driving() const { return mode_ == OMNIHIL_DRIVE_DUTY; }

 private:
  void rest();
  void apply_voltage(double voltage_V);

  double period_s_ = 0, ratio_ = 1;  // rotor turns per turn of the bus's shaft
  double rad_per_count_ = 0, torque_constant_ = 0, resistance_ohm_ = 0, tracking_rad_s_ = 0;
  double current_limit_A_ = 0;
  double p_ = 0, i_ = 0;  // at the rotor
  // sensed, at the rotor
  bool sensed_ = false;
  std::int64_t counts_ = 0;
  double theta_rad_ = 0, omega_rad_s_ = 0, current_A_ = 0, bus_V_ = 0;
  // loops
  double integral_Nm_ = 0, trim_V_ = 0, current_demand_A_ = 0, duty_ = 0;
  int saturated_ = 0;  // sign of the duty that was cut
  std::uint32_t mode_ = OMNIHIL_DRIVE_COAST;
};

}  // namespace omnihil
