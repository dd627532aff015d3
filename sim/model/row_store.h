// Where a row's values go in a robot's model: the last column of the table in model_rows.cc.
//
//   store::robot<&RobotModel::mass_kg>(model, v);
//
// `v`: the row's numbers, one but for wheels' angles. Enums take the place of a word among the row's.
#pragma once
#include <memory>
#include <numbers>
#include <span>
#include <type_traits>
#include <utility>

#include "sim/robot/ball_handling.h"
#include "sim/robot/electric_model.h"
#include "sim/robot/robot_model.h"

namespace omnihil::store {

template <auto Member>
void robot(RobotModel& m, std::span<const double> v) {
  using Field = std::remove_reference_t<decltype(m.*Member)>;
  m.*Member = static_cast<Field>(v.front());
}
template <auto Member>
void motor(RobotModel& m, std::span<const double> v) {
  using Field = std::remove_reference_t<decltype(m.motor.*Member)>;
  m.motor.*Member = static_cast<Field>(v.front());
}
template <auto Member>
void encoder(RobotModel& m, std::span<const double> v) {
  m.encoder.*Member = static_cast<int>(v.front());
}
template <auto Tyre, auto Member>
void tyre(RobotModel& m, std::span<const double> v) {
  (m.*Tyre).*Member = v.front();
}
template <auto Member>
void electric(RobotModel& m, std::span<const double> v) {
  set_electrics(m, [&](ElectricModel& e) {
    using Field = std::remove_reference_t<decltype(e.*Member)>;
    e.*Member = static_cast<Field>(v.front());
  });
}
template <auto Part, auto Member>
void part(RobotModel& m, std::span<const double> v) {
  set_electrics(m, [&](ElectricModel& e) {
    using Field = std::remove_reference_t<decltype((e.*Part).*Member)>;
    (e.*Part).*Member = static_cast<Field>(v.front());
  });
}
template <auto Part, auto Member>
void handling(RobotModel& m, std::span<const double> v) {
  auto next = std::make_shared<BallHandling>(handling_of(m));
  (*next.*Part).*Member = v.front();
  m.handling = std::move(next);
}
template <auto Member>
void handling(RobotModel& m, std::span<const double> v) {
  auto next = std::make_shared<BallHandling>(handling_of(m));
  *next.*Member = v.front();
  m.handling = std::move(next);
}
template <std::size_t Power>
void kick_coefficient(RobotModel& m, std::span<const double> v) {
  auto next = std::make_shared<BallHandling>(handling_of(m));
  next->kick.c[Power] = v.front();
  m.handling = std::move(next);
}
template <auto Part, auto Member>
void degrees(RobotModel& m, std::span<const double> v) {
  set_electrics(m, [&](ElectricModel& e) { (e.*Part).*Member = v.front() * std::numbers::pi / 180.0; });
}
template <std::size_t Sensor>
void hall_offset(RobotModel& m, std::span<const double> v) {
  set_electrics(
      m, [&](ElectricModel& e) { e.hall.sensor_offset_rad[Sensor] = v.front() * std::numbers::pi / 180.0; });
}
inline void pwm_frequency(RobotModel& m, std::span<const double> v) {
  set_electrics(m, [&](ElectricModel& e) { e.inverter.pwm_frequency_Hz = v.front(); });
}
inline void battery_capacity(RobotModel& m, std::span<const double> v) {
  set_electrics(m, [&](ElectricModel& e) { e.battery.capacity_C = 3600.0 * v.front(); });
}
inline void battery_refuses(RobotModel& m, std::span<const double> v) {
  set_electrics(m, [&](ElectricModel& e) { e.battery.takes_charge = v.front() == 0.0; });
}
inline void motor_loop(RobotModel& m, std::span<const double> v) {
  m.motor_loop = static_cast<MotorLoop>(static_cast<int>(v.front()));
}
inline void wheel_angles(RobotModel& m, std::span<const double> v) {
  m.wheels = v.size();
  for (std::size_t i = 0; i < v.size(); ++i) {
    m.wheel_angle_rad[i] = v[i] * std::numbers::pi / 180.0;
  }
}

}  // namespace omnihil::store
