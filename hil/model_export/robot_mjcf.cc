// MJCF: the XML of MuJoCo. Source: MuJoCo documentation 2.2, "XML reference" (general actuators: force = gainprm[0] ctrl +
// biasprm[0] + biasprm[1] length + biasprm[2] velocity).
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "hil/model_export/export_notes.h"
#include "hil/model_export/rigid_bodies.h"
#include "hil/text/markup.h"
#include "sim/contact/gravity.h"

namespace omnihil {
namespace {

constexpr std::array<std::string_view, 20> kMjcfKeeps = {"robot.mass_kg",
                                                         "robot.yaw_inertia_kg_m2",
                                                         "robot.center_of_mass_height_m",
                                                         "robot.center_of_mass_x_m",
                                                         "robot.center_of_mass_y_m",
                                                         "robot.wheel_center_radius_m",
                                                         "robot.wheel_radius_m",
                                                         "robot.wheel_mass_kg",
                                                         "robot.wheel_inertia_kg_m2",
                                                         "robot.wheel_angle_deg",
                                                         "robot.rollers_per_wheel",
                                                         "gear.ratio",
                                                         "supply.voltage_V",
                                                         "motor.resistance_ohm",
                                                         "motor.torque_constant_Nm_per_A",
                                                         "motor.rotor_inertia_kg_m2",
                                                         "motor.viscous_friction_Nm_s_per_rad",
                                                         "motor.current_limit_A",
                                                         "motor.duty_limit_ratio",
                                                         "effects.coulomb_friction.torque_Nm"};
// Of a rigid body's inertias the largest is at most the sum of the others; a little more, so that rounding keeps it so.
constexpr double kLeastAcross_ratio = 0.5 * (1.0 + 1e-6);
constexpr int kRollersWhereUnknown = 16;     // a usual number
constexpr double kRollerRadius_ratio = 0.2;  // of the wheel's: a usual size, the model has none
constexpr double kMostRollerMass_ratio =
    0.2;  // of the wheel's mass in its rollers, where its inertia leaves room for that

// I_across 1 + (I_axle - I_across) e e^T, as MJCF orders it: xx yy zz xy xz yz.
std::string full_inertia(double axle, double across, const Eigen::Vector3d& e) {
  const Eigen::Matrix3d m = across * Eigen::Matrix3d::Identity() + (axle - across) * e * e.transpose();
  return fmt::format("{} {} {} {} {} {}", exact(m(0, 0)), exact(m(1, 1)), exact(m(2, 2)), exact(m(0, 1)),
                     exact(m(0, 2)), exact(m(1, 2)));
}

struct Rollers {
  int count = 0;
  double radius_m = 0.0, half_length_m = 0.0, mass_kg = 0.0;  // of one
  double from_centre_m = 0.0, drag_Nm = 0.0;
  double inertia_axis_kg_m2() const { return 0.4 * mass_kg * radius_m * radius_m; }
  double inertia_across_kg_m2() const {
    return 0.2 * mass_kg * (radius_m * radius_m + half_length_m * half_length_m);
  }
  // About the wheel's axle and across it, all of them: a ring of bodies whose axes go round.
  double ring_axle_kg_m2() const {
    return count * (mass_kg * from_centre_m * from_centre_m + inertia_across_kg_m2());
  }
  double ring_across_kg_m2() const {
    return count * 0.5 *
           (mass_kg * from_centre_m * from_centre_m + inertia_axis_kg_m2() + inertia_across_kg_m2());
  }
};

Rollers rollers_of(const RobotModel& m) {
  Rollers r;
  r.count = m.rollers_per_wheel > 2 ? m.rollers_per_wheel : kRollersWhereUnknown;
  r.radius_m = kRollerRadius_ratio * m.wheel_radius_m;
  // An ellipse's radius of curvature at the end of its short half-axis b is a^2 / b: here that of the wheel.
  r.half_length_m = std::sqrt(r.radius_m * m.wheel_radius_m);
  r.from_centre_m = m.wheel_radius_m - r.radius_m;
  const double room_kg = 0.25 * m.wheel_inertia_kg_m2 / (m.wheel_radius_m * m.wheel_radius_m);
  r.mass_kg = std::min(kMostRollerMass_ratio * m.wheel_mass_kg, room_kg) / r.count;
  // Drag of the lateral curve at the wheel's share of the weight, at the roller's radius.
  r.drag_Nm =
      m.tyre_lateral.extremum_value * m.mass_kg * kGravity_m_s2 / static_cast<double>(m.wheels) * r.radius_m;
  return r;
}

std::string roller(const RobotModel& m, const Rollers& r, const Eigen::Vector3d& axle, std::size_t wheel,
                   int k) {
  const double angle = 2.0 * std::numbers::pi * k / r.count;
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ(), along = up.cross(axle);
  const Eigen::Vector3d out = -std::cos(angle) * up + std::sin(angle) * along, axis = axle.cross(out);
  return fmt::format(
      "      <body name=\"roller_{0}_{1}\" pos=\"{2}\">\n"
      "        <joint type=\"hinge\" axis=\"{3}\" frictionloss=\"{4}\"/>\n"
      "        <inertial pos=\"0 0 0\" mass=\"{5}\" fullinertia=\"{6}\"/>\n"
      "        <geom type=\"ellipsoid\" size=\"{7} {7} {8}\" zaxis=\"{3}\" friction=\"{9} 0 0\" "
      "conaffinity=\"0\"/>\n"
      "      </body>\n",
      wheel + 1, k + 1, vec(r.from_centre_m * out), vec(axis), exact(r.drag_Nm), exact(r.mass_kg),
      full_inertia(r.inertia_axis_kg_m2(), r.inertia_across_kg_m2(), axis), exact(r.radius_m),
      exact(r.half_length_m), exact(m.tyre_longitudinal.extremum_value));
}

std::string mjcf_wheel_xml(const RobotModel& m, const RigidBodies& b, const Rollers& r, std::size_t i) {
  const double gear = m.gear_ratio;
  const double core_axle = b.wheel_inertia_axle_kg_m2 - r.ring_axle_kg_m2();
  const double core_across =
      std::max(b.wheel_inertia_across_kg_m2 - r.ring_across_kg_m2(), kLeastAcross_ratio * core_axle);
  // Rotor and friction as the wheel sees them: N^2 J, N^2 b, N c.
  std::string out = fmt::format(
      "    <body name=\"wheel_{0}\" pos=\"{1}\">\n"
      "      <joint name=\"wheel_{0}\" type=\"hinge\" axis=\"{2}\" armature=\"{3}\" damping=\"{4}\" "
      "frictionloss=\"{5}\"/>\n"
      "      <inertial pos=\"0 0 0\" mass=\"{6}\" fullinertia=\"{7}\"/>\n",
      i + 1, vec(b.wheel_position_m[i]), vec(b.wheel_axis[i]),
      exact(gear * gear * m.motor.rotor_inertia_kg_m2),
      exact(gear * gear * m.motor.viscous_friction_Nm_s_per_rad), exact(gear * m.motor.coulomb_friction_Nm),
      exact(m.wheel_mass_kg - r.count * r.mass_kg), full_inertia(core_axle, core_across, b.wheel_axis[i]));
  for (int k = 0; k < r.count; ++k) out += roller(m, r, b.wheel_axis[i], i, k);
  return out + "    </body>\n";
}

// Torque at the wheel: N (k / R) (U duty - k N omega_wheel), at most N k i_limit.
std::string drive_xml(const RobotModel& m, std::size_t i) {
  const double gear = m.gear_ratio, k = m.motor.torque_constant_Nm_per_A, ohm = m.motor.resistance_ohm;
  const double limit_Nm = gear * k * m.motor.current_limit_A;
  return fmt::format(
      "    <general name=\"duty_{0}\" joint=\"wheel_{0}\" ctrllimited=\"true\" ctrlrange=\"-{1} {1}\" "
      "gaintype=\"fixed\" "
      "gainprm=\"{2}\" biastype=\"affine\" biasprm=\"0 0 {3}\"{4}/>\n",
      i + 1, exact(m.motor.duty_limit_ratio), exact(gear * k * m.bus_voltage_V / ohm),
      exact(-gear * gear * k * k / ohm),
      limit_Nm > 0.0 ? fmt::format(" forcelimited=\"true\" forcerange=\"-{0} {0}\"", exact(limit_Nm)) : "");
}

void mjcf_say_what_is_lost(const ModelFile& file, const Rollers& r, ModelExport& made) {
  const RobotModel& m = *file.robot;
  made.lost = {fmt::format("the tyre's curve over slip: the floor holds up to {:g} of the load along the "
                           "wheel, whatever the slip",
                           m.tyre_longitudinal.extremum_value),
               fmt::format("the rollers' drag over slip: each turns against {:.3g} N m, its drag at {:g} of "
                           "the wheel's load at rest",
                           r.drag_Nm, m.tyre_lateral.extremum_value),
               "the winding's inductance: current follows voltage at once",
               "encoders in counts: sensors give angles and speeds",
               "tolerances: every number stands as if it were exact"};
  if (m.electric)
    made.lost.push_back(
        "three phases, bridge, Hall and current sensors, battery, heat: a DC motor on a constant bus");
  if (m.handling) made.lost.push_back("kicker, dribbler, break beam");
  for (std::string& line : effects_lost(file)) made.lost.push_back(std::move(line));
  for (std::string& line : numbers_lost(file, kMjcfKeeps)) made.lost.push_back(std::move(line));
  made.assumed = {
      "inertia of the base about horizontal axes: a cylinder of twice the height of its centre of mass",
      "inertia of a wheel across its axle: a disc of half its radius' width",
      fmt::format(
          "rollers of {:g} of the wheel's radius and {:.3g} kg each, ellipsoids that meet the wheel's circle",
          kRollerRadius_ratio, r.mass_kg)};
  if (m.rollers_per_wheel <= 2)
    made.assumed.push_back(fmt::format("{} rollers a wheel", kRollersWhereUnknown));
}

}  // namespace

ModelExport robot_mjcf(const ModelFile& file, const std::string& name) {
  const RobotModel& m = *file.robot;
  ModelExport made;
  const RigidBodies b = rigid_bodies(m);
  made.problem = b.problem;
  if (!made.problem.empty()) return made;
  const Rollers r = rollers_of(m);
  mjcf_say_what_is_lost(file, r, made);
  std::string wheels, drives, sensors;
  for (std::size_t i = 0; i < m.wheels; ++i) {
    wheels += mjcf_wheel_xml(m, b, r, i);
    drives += drive_xml(m, i);
    sensors +=
        fmt::format("    <jointpos joint=\"wheel_{0}\"/>\n    <jointvel joint=\"wheel_{0}\"/>\n", i + 1);
  }
  made.text =
      "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n" +
      xml_comment(fmt::format("{}: MJCF by omnihil. Control: duty of each drive, -1 to 1.", name), made) +
      origins_comment(file, kMjcfKeeps);
  made.text += fmt::format(
      "<mujoco model=\"{}\">\n"
      "  <compiler angle=\"radian\" inertiafromgeom=\"false\"/>\n"
      "  <option timestep=\"0.0005\" gravity=\"0 0 -{}\" cone=\"elliptic\" impratio=\"10\"/>\n"
      "  <default><geom solref=\"0.004 1\" condim=\"3\"/></default>\n"
      "  <worldbody>\n"
      "    <geom name=\"floor\" type=\"plane\" size=\"10 10 0.1\" friction=\"{} 0 0\"/>\n"
      "    <body name=\"base\" pos=\"0 0 0\">\n"
      "    <freejoint name=\"base\"/>\n"
      "    <inertial pos=\"{}\" mass=\"{}\" diaginertia=\"{}\"/>\n"
      "{}"
      "    <site name=\"centre\" pos=\"0 0 0\"/>\n"
      "    </body>\n"
      "  </worldbody>\n"
      "  <actuator>\n{}  </actuator>\n"
      "  <sensor>\n{}    <gyro site=\"centre\"/>\n    <accelerometer site=\"centre\"/>\n  </sensor>\n"
      "</mujoco>\n",
      escaped(name), exact(kGravity_m_s2), exact(m.tyre_longitudinal.extremum_value), vec(b.base_com_m),
      exact(b.base_mass_kg), vec(b.base_inertia_kg_m2), wheels, drives, sensors);
  return made;
}

}  // namespace omnihil
