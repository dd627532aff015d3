// The robot's own code: it knows its hardware layer and nothing of a bench.
#pragma once
#include "examples/firmware_cpp/hardware.h"
#include "examples/firmware_cpp/scheduler.h"

namespace example {

// What is soldered: set once at start.
struct Build {
  std::array<float, kWheelCount> wheel_angle_rad{};
  float wheel_radius_m = 0.0f, wheel_center_radius_m = 0.0f;
  float gear_ratio = 1.0f, counts_per_rotor_turn = 1.0f;
  float volt_per_rotor_rad_s = 0.0f;  // torque constant of the motor, V s/rad
  std::uint64_t silence_us = 200'000;
};

enum class Order : std::uint8_t { kOff, kBody, kWheels, kDuty };

class Robot {
 public:
  Robot()
      : scheduler_({{{500, &Robot::wheel_task}, {2000, &Robot::motion_task}, {20'000, &Robot::slow_task}}}) {}

  void start(const Build& build) { build_ = build; }
  void order_body(float forward_m_s, float left_m_s, float omega_rad_s, std::uint64_t now_us);
  void order_wheels(const std::array<float, kWheelCount>& omega_rad_s, std::uint64_t now_us);
  void order_duty(const std::array<float, kWheelCount>& duty, std::uint64_t now_us);
  void order_off(std::uint64_t now_us) { take(Order::kOff, now_us); }
  // The timer interrupt's work: everything whose turn it is.
  void poll(std::uint64_t now_us);

  Hardware hardware;

  struct Wheel {
    std::uint16_t last_count = 0;
    float order_rad_s = 0.0f, target_rad_s = 0.0f, omega_rad_s = 0.0f;  // at the wheel
    float integral_V = 0.0f, duty = 0.0f;
  };
  const Wheel& wheel(int n) const { return wheels_[static_cast<std::size_t>(n)]; }
  float battery_V() const { return battery_V_; }
  bool silent() const { return silent_; }
  std::uint64_t now_us() const { return now_us_; }

 private:
  void wheel_task(float dt_s);
  void motion_task(float dt_s);
  void slow_task(float dt_s);
  void take(Order order, std::uint64_t now_us);
  void drive(Wheel& wheel, float dt_s);

  Build build_;
  Scheduler<Robot, 3> scheduler_;
  std::array<Wheel, kWheelCount> wheels_{};
  Order order_ = Order::kOff;
  std::uint64_t now_us_ = 0, heard_us_ = 0;
  float battery_V_ = 0.0f;
  bool silent_ = true, counted_ = false;
};

}  // namespace example
