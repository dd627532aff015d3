#include "hil/model_export/rigid_bodies.h"

#include <fmt/format.h>

#include <cmath>

namespace omnihil {

RigidBodies rigid_bodies(const RobotModel& m) {
  RigidBodies b;
  const double n = static_cast<double>(m.wheels), wheel_kg = m.wheel_mass_kg;
  b.wheel_inertia_axle_kg_m2 = m.wheel_inertia_kg_m2;
  const double width_m = kWheelWidth_ratio * m.wheel_radius_m;
  b.wheel_inertia_across_kg_m2 = 0.5 * m.wheel_inertia_kg_m2 + wheel_kg * width_m * width_m / 12.0;
  Eigen::Vector3d moment =
      m.mass_kg * Eigen::Vector3d(m.center_of_mass_x_m, m.center_of_mass_y_m, m.center_of_mass_height_m);
  for (std::size_t i = 0; i < m.wheels; ++i) {
    const double c = std::cos(m.wheel_angle_rad[i]), s = std::sin(m.wheel_angle_rad[i]);
    b.wheel_position_m[i] = {m.wheel_center_radius_m * c, m.wheel_center_radius_m * s, m.wheel_radius_m};
    // A wheel that turns by omega about the unit vector e rolls with v = r omega e x z; inward e gives the tangent (-s, c).
    b.wheel_axis[i] = {-c, -s, 0.0};
    moment -= wheel_kg * b.wheel_position_m[i];
  }
  b.base_mass_kg = m.mass_kg - n * wheel_kg;
  if (!(b.base_mass_kg > 0.0)) {
    b.problem = fmt::format(
        "robot.wheel_mass_kg = {:g}: {} wheels weigh {:g} kg; allowed: less than robot.mass_kg = {:g}",
        wheel_kg, m.wheels == 4 ? "four" : std::to_string(m.wheels), n * wheel_kg, m.mass_kg);
    return b;
  }
  if (!(m.wheel_inertia_kg_m2 > 0.0)) {
    b.problem = "robot.wheel_inertia_kg_m2 = 0: a body that turns has inertia; allowed: more than 0";
    return b;
  }
  b.base_com_m = moment / b.base_mass_kg;
  const double wheels_zz =
      n * (wheel_kg * m.wheel_center_radius_m * m.wheel_center_radius_m + b.wheel_inertia_across_kg_m2);
  const double zz = m.yaw_inertia_kg_m2 - wheels_zz - b.base_mass_kg * b.base_com_m.head<2>().squaredNorm();
  if (!(zz > 0.0)) {
    b.problem =
        fmt::format("robot.yaw_inertia_kg_m2 = {:g}: the wheels alone have {:g}; allowed: more than that",
                    m.yaw_inertia_kg_m2, wheels_zz);
    return b;
  }
  const double height = 2.0 * b.base_com_m.z();
  const double across = 0.5 * zz + b.base_mass_kg * height * height / 12.0;
  b.base_inertia_kg_m2 = {across, across, zz};
  return b;
}

}  // namespace omnihil
