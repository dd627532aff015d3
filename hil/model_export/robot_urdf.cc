// URDF: the XML of ROS for robots. Source: wiki.ros.org/urdf/XML (link, joint, transmission).
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numbers>

#include "hil/model_export/export_notes.h"
#include "hil/model_export/rigid_bodies.h"
#include "hil/text/markup.h"

namespace omnihil {
namespace {

constexpr std::array<std::string_view, 14> kUrdfKeeps = {"robot.mass_kg",
                                                         "robot.yaw_inertia_kg_m2",
                                                         "robot.center_of_mass_height_m",
                                                         "robot.center_of_mass_x_m",
                                                         "robot.center_of_mass_y_m",
                                                         "robot.wheel_center_radius_m",
                                                         "robot.wheel_radius_m",
                                                         "robot.wheel_mass_kg",
                                                         "robot.wheel_inertia_kg_m2",
                                                         "robot.wheel_angle_deg",
                                                         "gear.ratio",
                                                         "motor.viscous_friction_Nm_s_per_rad",
                                                         "motor.rotor_inertia_kg_m2",
                                                         "effects.coulomb_friction.torque_Nm"};

std::string inertia_xml(const Eigen::Matrix3d& m) {
  return fmt::format("<inertia ixx=\"{}\" iyy=\"{}\" izz=\"{}\" ixy=\"{}\" ixz=\"{}\" iyz=\"{}\"/>",
                     exact(m(0, 0)), exact(m(1, 1)), exact(m(2, 2)), exact(m(0, 1)), exact(m(0, 2)),
                     exact(m(1, 2)));
}

std::string link_xml(const std::string& name, double mass_kg, const Eigen::Vector3d& com,
                     const Eigen::Matrix3d& inertia, const std::string& shape) {
  return fmt::format(
      "  <link name=\"{}\">\n    <inertial><origin xyz=\"{}\"/><mass value=\"{}\"/>{}</inertial>\n"
      "    <visual>{}</visual>\n    <collision>{}</collision>\n  </link>\n",
      name, vec(com), exact(mass_kg), inertia_xml(inertia), shape, shape);
}

std::string urdf_wheel_xml(const RobotModel& m, const RigidBodies& b, std::size_t i) {
  const double gear = m.gear_ratio, k = m.motor.torque_constant_Nm_per_A;
  const Eigen::Vector3d& e = b.wheel_axis[i];
  // The rotor turns with the wheel's joint, N times as fast: N^2 J on top, about the axle alone.
  const double axle = b.wheel_inertia_axle_kg_m2 + gear * gear * m.motor.rotor_inertia_kg_m2;
  const double across =
      std::max(b.wheel_inertia_across_kg_m2, 0.5 * axle);  // a rigid body's: at least half of the axle's
  const Eigen::Matrix3d inertia = across * Eigen::Matrix3d::Identity() + (axle - across) * e * e.transpose();
  // A cylinder stands along its z: turned down to x, then to the wheel's angle.
  const std::string shape =
      fmt::format("<origin rpy=\"0 {} {}\"/><geometry><cylinder radius=\"{}\" length=\"{}\"/></geometry>",
                  exact(std::numbers::pi / 2), exact(m.wheel_angle_rad[i]), exact(m.wheel_radius_m),
                  exact(kWheelWidth_ratio * m.wheel_radius_m));
  const double volts = m.bus_voltage_V * m.motor.duty_limit_ratio;
  double amperes = volts / m.motor.resistance_ohm;
  if (m.motor.current_limit_A > 0.0) amperes = std::min(amperes, m.motor.current_limit_A);
  std::string out =
      link_xml(fmt::format("wheel_{}", i + 1), m.wheel_mass_kg, Eigen::Vector3d::Zero(), inertia, shape);
  out += fmt::format(
      "  <joint name=\"wheel_{0}_joint\" type=\"continuous\">\n    <parent link=\"base_link\"/><child "
      "link=\"wheel_{0}\"/>\n"
      "    <origin xyz=\"{1}\"/><axis xyz=\"{2}\"/>\n    <dynamics damping=\"{3}\" friction=\"{4}\"/>\n"
      "    <limit effort=\"{5}\" velocity=\"{6}\"/>\n  </joint>\n",
      i + 1, vec(b.wheel_position_m[i]), vec(e), exact(gear * gear * m.motor.viscous_friction_Nm_s_per_rad),
      exact(gear * m.motor.coulomb_friction_Nm), exact(gear * k * amperes), exact(volts / k / gear));
  return out +
         fmt::format(
             "  <transmission name=\"wheel_{0}_drive\">\n    "
             "<type>transmission_interface/SimpleTransmission</type>\n"
             "    <joint name=\"wheel_{0}_joint\"><hardwareInterface>hardware_interface/EffortJointInterface"
             "</hardwareInterface></joint>\n"
             "    <actuator "
             "name=\"wheel_{0}_motor\"><mechanicalReduction>{1}</mechanicalReduction></actuator>\n"
             "  </transmission>\n",
             i + 1, exact(gear));
}

void urdf_say_what_is_lost(const ModelFile& file, ModelExport& made) {
  const RobotModel& m = *file.robot;
  made.lost = {
      "the motor: a joint has an effort and a speed limit (stall torque, no-load speed), no winding, no "
      "supply",
      "the rollers: a wheel is a plain cylinder, whose contact slides sideways only if the simulator is told "
      "so",
      "tyre curves, encoders in counts, tolerances",
      "the rotor's gyroscopic moment: N^2 J stands in the wheel's inertia, which also makes the yaw inertia "
      "a little larger"};
  if (m.electric) made.lost.push_back("three phases, bridge, Hall and current sensors, battery, heat");
  if (m.handling) made.lost.push_back("kicker, dribbler, break beam");
  for (std::string& line : effects_lost(file)) made.lost.push_back(std::move(line));
  for (std::string& line : numbers_lost(file, kUrdfKeeps)) made.lost.push_back(std::move(line));
  made.assumed = {
      "inertia of the base about horizontal axes: a cylinder of twice the height of its centre of mass",
      "inertia of a wheel across its axle: a disc of half its radius' width, at least half of what turns "
      "about it",
      fmt::format(
          "width of a wheel's shape: {:g} of its radius; the base's shape: a cylinder of the wheels' circle",
          kWheelWidth_ratio)};
}

}  // namespace

ModelExport robot_urdf(const ModelFile& file, const std::string& name) {
  const RobotModel& m = *file.robot;
  ModelExport made;
  const RigidBodies b = rigid_bodies(m);
  made.problem = b.problem;
  if (!made.problem.empty()) return made;
  urdf_say_what_is_lost(file, made);
  made.text =
      "<?xml version=\"1.0\"?>\n" +
      xml_comment(
          name + ": URDF by omnihil. base_link: on the floor below the geometric centre, x forward, y left.",
          made) +
      origins_comment(file, kUrdfKeeps);
  made.text += fmt::format("<robot name=\"{}\">\n", escaped(name));
  const double height = std::max(2.0 * m.center_of_mass_height_m, 2.0 * m.wheel_radius_m);
  made.text += link_xml(
      "base_link", b.base_mass_kg, b.base_com_m, b.base_inertia_kg_m2.asDiagonal(),
      fmt::format("<origin xyz=\"0 0 {}\"/><geometry><cylinder radius=\"{}\" length=\"{}\"/></geometry>",
                  exact(0.5 * height + 0.2 * m.wheel_radius_m), exact(m.wheel_center_radius_m),
                  exact(height)));
  for (std::size_t i = 0; i < m.wheels; ++i) made.text += urdf_wheel_xml(m, b, i);
  made.text += "</robot>\n";
  return made;
}

}  // namespace omnihil
