#include "hil/acquire/floor_need.h"

#include <algorithm>
#include <cmath>

#include "sim/rolling/rolling_robot.h"

namespace omnihil {

std::array<double, 3> asked_of_body(PlanDrive drive, const std::array<double, kWheels>& value,
                                    const RollingParams<double>& robot) {
  if (drive == PlanDrive::kBodyVelocity) return {value[0], value[1], value[2]};
  const WheelGeometry<double> g = wheel_geometry(robot);
  PerWheel<double> omega{};
  std::copy(value.begin(), value.end(), omega.begin());
  if (drive == PlanDrive::kWheelDuty) {
    const double free_rad_s =
        robot.drive.supply_voltage_V / robot.drive.torque_constant_Nm_per_A / robot.drive.gear_ratio;
    for (double& w : omega) w *= free_rad_s;
  }
  const BodyVelocity<double> b = body_velocity(g, omega);
  return {b.v_forward_m_s, b.v_left_m_s, b.omega_body_rad_s};
}

FloorNeed floor_need(const AcquirePlan& plan, const PlanRun& run, const RollingParams<double>& robot) {
  constexpr double kStep_s = 1e-3;
  FloorNeed need;
  double x = 0.0, y = 0.0, yaw = 0.0;
  const auto steps = static_cast<long>(std::ceil(run.duration_s / kStep_s - 1e-9));
  for (long k = 0; k < steps; ++k) {
    const std::array<double, 3> v =
        asked_of_body(plan.drive, plan_value(run, static_cast<double>(k) * kStep_s), robot);
    // Along an arc: the chord lies half of the turn further, sin(t/2)/(t/2) as long.
    const double half = 0.5 * v[2] * kStep_s;
    const double shorter = std::abs(half) < 1e-9 ? 1.0 : std::sin(half) / half;
    const double c = std::cos(yaw + half) * shorter * kStep_s, s = std::sin(yaw + half) * shorter * kStep_s;
    x += c * v[0] - s * v[1];
    y += s * v[0] + c * v[1];
    yaw += 2.0 * half;
    need.x_from_m = std::min(need.x_from_m, x), need.x_to_m = std::max(need.x_to_m, x);
    need.y_from_m = std::min(need.y_from_m, y), need.y_to_m = std::max(need.y_to_m, y);
    need.farthest_m = std::max(need.farthest_m, std::hypot(x, y));
    need.fastest_m_s = std::max(need.fastest_m_s, std::hypot(v[0], v[1]));
  }
  need.stopping_m = need.fastest_m_s * need.fastest_m_s / (2.0 * kBrake_m_s2);
  need.x_end_m = x, need.y_end_m = y;
  return need;
}

}  // namespace omnihil
