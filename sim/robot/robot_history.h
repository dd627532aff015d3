// What a robot's sensors could have seen in the recent past, for measurements that are older than their stamp.
//
//   RobotHistory history(1.0, step_s);
//   history.push(point);                           // once per mechanical step; the oldest is forgotten
//   RobotInstant p = history.at(now_s - age_s);    // straight lines between steps
//
// Before the first point the robot stood as it stood there. No allocation after construction.
#pragma once
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include "firmware_iface/robot_io.h"
#include "sim/robot/per_wheel.h"

namespace omnihil {

struct RobotInstant {
  double time_s = 0.0;
  double x_m = 0.0, y_m = 0.0, yaw_rad = 0.0;
  double gyro_rad_s = 0.0, accel_x_m_s2 = 0.0, accel_y_m_s2 = 0.0;
  double bus_voltage_V = 0.0;
  PerWheel<double> theta_rotor_rad{}, omega_rotor_rad_s{}, charge_C{};
};

inline RobotInstant between(const RobotInstant& a, const RobotInstant& b, double time_s) {
  const double s = b.time_s > a.time_s ? (time_s - a.time_s) / (b.time_s - a.time_s) : 0.0;
  const auto line = [s](double from, double to) { return from + (to - from) * s; };
  RobotInstant p;
  p.time_s = time_s;
  p.x_m = line(a.x_m, b.x_m);
  p.y_m = line(a.y_m, b.y_m);
  p.yaw_rad = a.yaw_rad + std::remainder(b.yaw_rad - a.yaw_rad, 2.0 * std::numbers::pi) * s;
  p.gyro_rad_s = line(a.gyro_rad_s, b.gyro_rad_s);
  p.accel_x_m_s2 = line(a.accel_x_m_s2, b.accel_x_m_s2);
  p.accel_y_m_s2 = line(a.accel_y_m_s2, b.accel_y_m_s2);
  p.bus_voltage_V = line(a.bus_voltage_V, b.bus_voltage_V);
  for (std::size_t i = 0; i < kMaxWheels; ++i) {
    p.theta_rotor_rad[i] = line(a.theta_rotor_rad[i], b.theta_rotor_rad[i]);
    p.omega_rotor_rad_s[i] = line(a.omega_rotor_rad_s[i], b.omega_rotor_rad_s[i]);
    p.charge_C[i] = line(a.charge_C[i], b.charge_C[i]);
  }
  return p;
}

class RobotHistory {
 public:
  RobotHistory() = default;
  RobotHistory(double span_s, double step_s) : points_(static_cast<std::size_t>(span_s / step_s) + 2) {}

  void clear() { count_ = 0; }
  void push(const RobotInstant& p) {
    points_[count_ % points_.size()] = p;
    ++count_;
  }
  RobotInstant at(double time_s) const {
    const std::size_t oldest = count_ > points_.size() ? count_ - points_.size() : 0;
    std::size_t n = count_ - 1;
    while (n > oldest && point(n).time_s > time_s) --n;
    if (n + 1 == count_ || point(n).time_s >= time_s) return point(n);
    return between(point(n), point(n + 1), time_s);
  }

  // For saving: the points as they lie, and how many were ever pushed.
  std::vector<RobotInstant>& points() { return points_; }
  const std::vector<RobotInstant>& points() const { return points_; }
  std::uint64_t& count() { return count_; }
  const std::uint64_t& count() const { return count_; }

 private:
  const RobotInstant& point(std::size_t n) const { return points_[n % points_.size()]; }

  std::vector<RobotInstant> points_;
  std::uint64_t count_ = 0;
};

}  // namespace omnihil
