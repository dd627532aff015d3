// The only file that sees Simbody's headers; compiled with -UNDEBUG (see sim/CMakeLists.txt).
#ifdef NDEBUG
#error \
    "Simbody as packaged changes its class layout with NDEBUG and would crash: compile this file with -UNDEBUG"
#endif
#include "sim/robot/chassis.h"

#include <Simbody.h>

#include <algorithm>
#include <cmath>

#include "sim/robot/planar_law.h"

namespace omnihil {
namespace {

using SimTK::MobilizedBody;
using SimTK::Rotation;
using SimTK::SpatialVec;
using SimTK::Vec3;

// One robot's share of the multibody system.
struct Robot {
  ContactLaw<double> law;
  MobilizedBody chassis;
  PerWheel<MobilizedBody> wheel;
  int first_wheel_u = 0, first_body = 0;  // its wheels' speeds, its chassis and wheels follow one another
  double gear_ratio = 1.0;
  double wheel_viscous_Nm_s_per_rad = 0.0;
  double weight_chassis_N = 0.0, weight_wheel_N = 0.0;
  Vec3 p_BoCm_B;  // centre of mass of the chassis without wheels
  double floor_N_per_m = 0.0, floor_N_s_per_m = 0.0;
  // at the current state
  WheelContacts<double> contacts;
  PerWheel<Vec3> f_wheel_W;
  const FloorEffects* effects = nullptr;
  FloorForces more;
  Vec3 f_body_W;  // of effects, level
  PerWheel<bool> lifted{};

  double radius_m(std::size_t i) const {
    return effects != nullptr ? more.wheel_radius_m[i] : law.geometry.wheel_radius_m;
  }
};

struct Masses {
  double chassis_kg = 0.0;
  Vec3 p_BoCm_B;
  SimTK::Inertia i_Bo_B;
  SimTK::Inertia i_wheel;
};

// Splits the whole robot's numbers into chassis and wheels so that the sums are exact.
Masses split_masses(const RobotModel& m, const WheelGeometry<double>& g, Chassis::Joint joint) {
  const double axial = spin_inertia_kg_m2(m), diametral = 0.5 * axial;
  Masses s;
  s.i_wheel = SimTK::Inertia(diametral, diametral, axial);
  const auto wheels = static_cast<double>(m.wheels);
  s.chassis_kg = m.mass_kg - wheels * m.wheel_mass_kg;
  double moment_x = m.mass_kg * m.center_of_mass_x_m, moment_y = m.mass_kg * m.center_of_mass_y_m;
  double yaw = m.yaw_inertia_kg_m2;
  for (std::size_t i = 0; i < m.wheels; ++i) {
    moment_x -= m.wheel_mass_kg * m.wheel_center_radius_m * g.cos_angle[i];
    moment_y -= m.wheel_mass_kg * m.wheel_center_radius_m * g.sin_angle[i];
    yaw -= diametral + m.wheel_mass_kg * m.wheel_center_radius_m * m.wheel_center_radius_m;
  }
  // the body's origin lies in the plane of the axles
  const double height =
      (m.mass_kg * m.center_of_mass_height_m - wheels * m.wheel_mass_kg * m.wheel_radius_m) / s.chassis_kg;
  if (joint == Chassis::Joint::kPlanar) {
    s.p_BoCm_B = Vec3(moment_x / s.chassis_kg, moment_y / s.chassis_kg, 0);
    s.i_Bo_B = SimTK::Inertia(yaw, yaw, yaw);  // only the yaw entry acts
    return s;
  }
  s.p_BoCm_B = Vec3(moment_x / s.chassis_kg, moment_y / s.chassis_kg, height - m.wheel_radius_m);
  const double yaw_cm = yaw - s.chassis_kg * (s.p_BoCm_B[0] * s.p_BoCm_B[0] + s.p_BoCm_B[1] * s.p_BoCm_B[1]);
  const double roll_cm = 0.5 * yaw_cm + s.chassis_kg * height * height / 3.0;  // cylinder of height 2 h
  s.i_Bo_B = SimTK::Inertia(roll_cm, roll_cm, yaw_cm).shiftFromMassCenter(s.p_BoCm_B, s.chassis_kg);
  return s;
}

}  // namespace

struct Chassis::Impl {
  Impl(const std::vector<RobotModel>& models, Joint joint_, const std::vector<const FloorEffects*>& effects)
      : matter(system),
        joint(joint_),
        layout(joint_ == Joint::kPlanar ? planar_layout(most_wheels(models))
                                        : free_layout(most_wheels(models))) {
    system.setUseUniformBackground(true);
    robots.reserve(models.size());
    for (const RobotModel& m : models) add(m);
    for (std::size_t n = 0; n < effects.size(); ++n) robots[n].effects = effects[n];
    system.realizeTopology();
    state = system.getDefaultState();
    system.realizeModel(state);
    for (Robot& r : robots) {
      r.first_wheel_u = r.wheel[0].getFirstUIndex(state);
      r.first_body = r.chassis.getMobilizedBodyIndex();
    }
    mobility_forces.resize(state.getNU()) = 0.0;  // the chassis' own freedoms have none
    udot.resize(state.getNU());
    body_forces.resize(matter.getNumBodies()) = SpatialVec(Vec3(0), Vec3(0));  // nor has the ground
    body_accelerations.resize(matter.getNumBodies());
  }

  void add(const RobotModel& m) {
    Robot r;
    r.law = contact_law(m);
    r.gear_ratio = m.gear_ratio;
    r.wheel_viscous_Nm_s_per_rad = m.gear_ratio * m.gear_ratio * m.motor.viscous_friction_Nm_s_per_rad;
    const Masses s = split_masses(m, r.law.geometry, joint);
    r.p_BoCm_B = s.p_BoCm_B;
    r.weight_chassis_N = s.chassis_kg * kGravity_m_s2;
    r.weight_wheel_N = m.wheel_mass_kg * kGravity_m_s2;
    r.floor_N_per_m = m.mass_kg * kGravity_m_s2 / static_cast<double>(m.wheels) / kFloorSink_m;
    r.floor_N_s_per_m =
        kFloorDamping * 2.0 * std::sqrt(r.floor_N_per_m * m.mass_kg / static_cast<double>(m.wheels));
    const SimTK::Body::Rigid body(SimTK::MassProperties(s.chassis_kg, s.p_BoCm_B, s.i_Bo_B));
    const SimTK::Body::Rigid wheel(SimTK::MassProperties(m.wheel_mass_kg, Vec3(0), s.i_wheel));
    const SimTK::Transform x_WB(Vec3(0, 0, joint == Joint::kPlanar ? m.wheel_radius_m : 0.0));
    if (joint == Joint::kPlanar) {
      r.chassis = MobilizedBody::Planar(matter.Ground(), x_WB, body, SimTK::Transform());
    } else {
      r.chassis = MobilizedBody::Free(matter.Ground(), x_WB, body, SimTK::Transform());
    }
    for (std::size_t i = 0; i < m.wheels; ++i) {
      // Positive spin drives along t = axle x z with the axle pointing inward.
      const Vec3 outward(r.law.geometry.cos_angle[i], r.law.geometry.sin_angle[i], 0);
      const Rotation r_BAxle(SimTK::UnitVec3(-outward), SimTK::ZAxis, Vec3(0, 0, 1), SimTK::XAxis);
      r.wheel[i] = MobilizedBody::Pin(r.chassis, SimTK::Transform(r_BAxle, m.wheel_center_radius_m * outward),
                                      wheel, SimTK::Transform());
    }
    robots.push_back(r);
  }

  // Floor forces from Simbody's own positions and velocities (stage Velocity).
  void find_contacts(Robot& r) const {
    const double radius = r.law.geometry.wheel_radius_m;
    const Vec3 p_WheelContact(0, 0, -radius);
    const Vec3& w_WB = r.chassis.getBodyAngularVelocity(state);
    WheelMotion<double> motion;
    PerWheel<Vec3> drive_W, outward_W;
    PerWheel<double> load_N{};
    const SimTK::Vector& speeds = state.getU();
    for (std::size_t i = 0; i < r.law.geometry.wheels; ++i) {
      const SimTK::Transform& x_WWheel = r.wheel[i].getBodyTransform(state);
      const Vec3 axle = x_WWheel.R().z();
      const double level = 1.0 / std::sqrt(axle[0] * axle[0] + axle[1] * axle[1]);
      outward_W[i] = Vec3(-axle[0] * level, -axle[1] * level, 0);
      drive_W[i] = Vec3(axle[1] * level, -axle[0] * level, 0);  // axle x z
      const Vec3 v_W = r.wheel[i].getBodyOriginVelocity(state);
      const Vec3 v_contact_W = v_W + w_WB % p_WheelContact;
      motion.drive_speed_m_s[i] = dot(v_contact_W, drive_W[i]);
      motion.roller_speed_m_s[i] = dot(v_contact_W, outward_W[i]);
      motion.rim_speed_m_s[i] = radius * speeds[r.first_wheel_u + static_cast<int>(i)];
      if (joint == Joint::kFree) {
        const double depth_m = radius - x_WWheel.p()[2];
        load_N[i] = depth_m > 0 ? std::max(0.0, r.floor_N_per_m * depth_m - r.floor_N_s_per_m * v_W[2]) : 0.0;
      }
    }
    if (r.effects != nullptr) {
      find_effects(r, motion, joint == Joint::kPlanar ? nullptr : &load_N);
    } else {
      r.contacts =
          joint == Joint::kPlanar ? contact_forces(r.law, motion) : contact_forces_at(r.law, motion, load_N);
    }
    lift_wheels(r.law, r.lifted, r.contacts);
    for (std::size_t i = 0; i < r.law.geometry.wheels; ++i) {
      r.f_wheel_W[i] =
          r.contacts.force_longitudinal_N[i] * drive_W[i] + r.contacts.force_lateral_N[i] * outward_W[i];
      if (joint == Joint::kFree) r.f_wheel_W[i][2] = load_N[i];
    }
  }

  // The same with effects, in the level body frame.
  void find_effects(Robot& r, const WheelMotion<double>& motion, const PerWheel<double>* load_N) const {
    FloorState at;
    const Vec3& v_W = r.chassis.getBodyOriginVelocity(state);
    const Rotation& r_WB = r.chassis.getBodyRotation(state);
    at.yaw_rad = joint == Joint::kPlanar ? r.chassis.getOneQ(state, 0) : std::atan2(r_WB[1][0], r_WB[0][0]);
    const double c = std::cos(at.yaw_rad), s = std::sin(at.yaw_rad);
    at.velocity = {c * v_W[0] + s * v_W[1], -s * v_W[0] + c * v_W[1],
                   r.chassis.getBodyAngularVelocity(state)[2]};
    for (std::size_t i = 0; i < r.law.geometry.wheels; ++i) {
      at.omega_wheel_rad_s[i] = r.wheel[i].getOneU(state, 0);
      at.theta_wheel_rad[i] = r.wheel[i].getOneQ(state, 0);
    }
    r.contacts = r.effects->contacts(r.law, motion, at, load_N, r.more);
    const double x = r.more.body_force_x_N, y = r.more.body_force_y_N;
    r.f_body_W = Vec3(c * x - s * y, s * x + c * y, 0);
  }

  // What the floor, the motors and the weight do to a robot's bodies and pins.
  void apply_forces(const Robot& r, const WheelTorques& torques, StepPart part) {
    const bool gravity = joint == Joint::kFree;
    SpatialVec on_chassis(Vec3(0), Vec3(0));
    if (gravity) {
      const Vec3 arm_W = r.chassis.getBodyRotation(state) * r.p_BoCm_B;
      const Vec3 weight(0, 0, -r.weight_chassis_N);
      on_chassis += SpatialVec(arm_W % weight, weight);
    }
    if (r.effects != nullptr) on_chassis += SpatialVec(Vec3(0, 0, r.more.body_moment_z_Nm), r.f_body_W);
    body_forces[r.first_body] = on_chassis;
    const SimTK::Vector& speeds = state.getU();
    for (std::size_t i = 0; i < r.law.geometry.wheels; ++i) {
      const int n = static_cast<int>(i);
      const Vec3 p_WheelContact(0, 0, -r.radius_m(i));
      Vec3 f_W = r.f_wheel_W[i];
      const Vec3 moment_W = p_WheelContact % f_W;
      if (gravity) f_W[2] -= r.weight_wheel_N;
      body_forces[r.first_body + 1 + n] = SpatialVec(moment_W, f_W);
      const double omega_wheel_rad_s = speeds[r.first_wheel_u + n];
      double torque_Nm = r.gear_ratio * torques[i].at(part, r.gear_ratio * omega_wheel_rad_s) -
                         r.wheel_viscous_Nm_s_per_rad * omega_wheel_rad_s;
      // static friction answers the floor
      if (torques[i].locked) torque_Nm = r.radius_m(i) * r.contacts.force_longitudinal_N[i];
      mobility_forces[r.first_wheel_u + n] = torque_Nm;
    }
  }

  SimTK::MultibodySystem system;
  SimTK::SimbodyMatterSubsystem matter;
  Joint joint;
  StateLayout layout;
  std::vector<Robot> robots;
  SimTK::State state;
  SimTK::Vector mobility_forces, udot;
  SimTK::Vector_<SpatialVec> body_forces, body_accelerations;
};

Chassis::Chassis(const std::vector<RobotModel>& robots, Joint joint,
                 const std::vector<const FloorEffects*>& effects)
    : impl_(std::make_unique<Impl>(robots, joint, effects)) {}
Chassis::~Chassis() = default;
Chassis::Chassis(Chassis&&) noexcept = default;
Chassis& Chassis::operator=(Chassis&&) noexcept = default;

const StateLayout& Chassis::layout() const { return impl_->layout; }

void Chassis::lift(std::size_t robot, const PerWheel<bool>& lifted) { impl_->robots[robot].lifted = lifted; }

void Chassis::set_state(const std::vector<double>& q, const std::vector<double>& u) {
  Impl& c = *impl_;
  std::copy(q.begin(), q.end(), &c.state.updQ()[0]);
  std::copy(u.begin(), u.end(), &c.state.updU()[0]);
  c.system.realize(c.state, SimTK::Stage::Velocity);
  for (Robot& r : c.robots) c.find_contacts(r);
}

const WheelContacts<double>& Chassis::contacts(std::size_t robot) const {
  return impl_->robots[robot].contacts;
}

const FloorForces& Chassis::floor_forces(std::size_t robot) const { return impl_->robots[robot].more; }

void Chassis::accelerations(const std::vector<WheelTorques>& torques, StepPart part,
                            std::vector<double>& udot) {
  Impl& c = *impl_;
  c.system.realize(c.state, SimTK::Stage::Dynamics);
  for (std::size_t n = 0; n < c.robots.size(); ++n) c.apply_forces(c.robots[n], torques[n], part);
  c.matter.calcAccelerationIgnoringConstraints(c.state, c.mobility_forces, c.body_forces, c.udot,
                                               c.body_accelerations);
  std::copy_n(&c.udot[0], udot.size(), udot.begin());
  const StateLayout& l = layout();
  for (std::size_t n = 0; n < c.robots.size(); ++n) {
    for (std::size_t i = 0; i < c.robots[n].law.geometry.wheels; ++i) {
      if (torques[n][i].locked) udot[n * l.u_per_robot + l.wheel_u + i] = 0.0;  // rounding would creep
    }
  }
}

void Chassis::position_rates(const std::vector<double>& q, const std::vector<double>& u,
                             std::vector<double>& qdot) const {
  if (impl_->joint == Joint::kPlanar) {
    std::copy(u.begin(), u.end(), qdot.begin());
    return;
  }
  const StateLayout& l = layout();
  for (std::size_t n = 0; n < impl_->robots.size(); ++n) {
    const double* e = q.data() + n * l.q_per_robot;
    const double* w = u.data() + n * l.u_per_robot;
    double* out = qdot.data() + n * l.q_per_robot;
    // de/dt = 1/2 (0, omega_W) e
    out[0] = 0.5 * (-w[0] * e[1] - w[1] * e[2] - w[2] * e[3]);
    out[1] = 0.5 * (w[0] * e[0] + w[1] * e[3] - w[2] * e[2]);
    out[2] = 0.5 * (w[1] * e[0] + w[2] * e[1] - w[0] * e[3]);
    out[3] = 0.5 * (w[2] * e[0] + w[0] * e[2] - w[1] * e[1]);
    std::copy_n(w + 3, l.u_per_robot - 3, out + 4);
  }
}

void Chassis::normalise(std::vector<double>& q) const {
  if (impl_->joint == Joint::kPlanar) return;
  for (std::size_t n = 0; n < impl_->robots.size(); ++n) {
    double* e = q.data() + n * layout().q_per_robot;
    const double scale = 1.0 / std::sqrt(e[0] * e[0] + e[1] * e[1] + e[2] * e[2] + e[3] * e[3]);
    for (int i = 0; i < 4; ++i) e[i] *= scale;
  }
}

Heading Chassis::heading(const std::vector<double>& q, std::size_t robot) const {
  const double* qr = q.data() + robot * layout().q_per_robot;
  if (impl_->joint == Joint::kPlanar) return heading_of(qr[0]);
  const Rotation r_WB(SimTK::Quaternion(qr[0], qr[1], qr[2], qr[3]));
  return heading_of(std::atan2(r_WB[1][0], r_WB[0][0]));
}

BodyMotion Chassis::motion(const std::vector<double>& q, const std::vector<double>& u,
                           std::size_t robot) const {
  const StateLayout& l = layout();
  const double* qr = q.data() + robot * l.q_per_robot;
  const double* ur = u.data() + robot * l.u_per_robot;
  if (impl_->joint == Joint::kPlanar) {
    const double c = std::cos(qr[0]), s = std::sin(qr[0]);
    return {qr[1], qr[2], qr[0], {c * ur[1] + s * ur[2], -s * ur[1] + c * ur[2], ur[0]}};
  }
  const Rotation r_WB(SimTK::Quaternion(qr[0], qr[1], qr[2], qr[3]));
  const Vec3 v_B = ~r_WB * Vec3(ur[3], ur[4], ur[5]);
  const Vec3 w_B = ~r_WB * Vec3(ur[0], ur[1], ur[2]);
  return {qr[4], qr[5], std::atan2(r_WB[1][0], r_WB[0][0]), {v_B[0], v_B[1], w_B[2]}};
}

void Chassis::place(std::vector<double>& q, std::vector<double>& u, std::size_t robot, double x_m, double y_m,
                    double yaw_rad) const {
  const StateLayout& l = layout();
  double* qr = q.data() + robot * l.q_per_robot;
  std::fill_n(qr, l.q_per_robot, 0.0);
  std::fill_n(u.data() + robot * l.u_per_robot, l.u_per_robot, 0.0);
  if (impl_->joint == Joint::kPlanar) {
    qr[0] = yaw_rad, qr[1] = x_m, qr[2] = y_m;
    return;
  }
  // Sunk and tilted so that the springs carry the loads at rest: depth_i = N_i / k = A + B x_i + C y_i.
  const Robot& r = impl_->robots[robot];
  const WheelGeometry<double>& g = r.law.geometry;
  Eigen::Vector3d plane;
  with_wheel_rows(g.wheels, [&](auto rows) {
    WheelRows<double, rows()> place(static_cast<Eigen::Index>(g.wheels), 3);
    Eigen::Matrix<double, rows(), 1, 0, rows() == Eigen::Dynamic ? static_cast<int>(kMaxWheels) : rows(), 1>
        depth_m(place.rows());
    for (std::size_t i = 0; i < r.law.geometry.wheels; ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      place.row(row) << 1.0, g.wheel_center_radius_m * g.cos_angle[i],
          g.wheel_center_radius_m * g.sin_angle[i];
      depth_m(row) = r.law.load.at_rest_N[i] / r.floor_N_per_m;
    }
    const Eigen::Matrix3d normal = place.transpose() * place;
    plane = normal.inverse() * (place.transpose() * depth_m);
  });
  const Rotation yaw(yaw_rad, SimTK::ZAxis);
  const Rotation pitch(std::asin(plane(1)), SimTK::YAxis), roll(std::asin(-plane(2)), SimTK::XAxis);
  const SimTK::Quaternion e = (yaw * pitch * roll).convertRotationToQuaternion();
  for (int i = 0; i < 4; ++i) qr[i] = e[i];
  qr[4] = x_m, qr[5] = y_m, qr[6] = g.wheel_radius_m - plane(0);
}

std::vector<double> Chassis::mass_matrix() const {
  SimTK::Matrix m;
  impl_->matter.calcM(impl_->state, m);
  std::vector<double> out;
  for (int row = 0; row < m.nrow(); ++row) {
    for (int col = 0; col < m.ncol(); ++col) out.push_back(m(row, col));
  }
  return out;
}

std::vector<double> Chassis::velocity_forces() const {
  const Impl& c = *impl_;
  const SimTK::Vector zero(c.state.getNU(), 0.0);
  const SimTK::Vector_<SpatialVec> no_forces(c.matter.getNumBodies(), SpatialVec(Vec3(0)));
  SimTK::Vector result;
  c.system.realize(c.state, SimTK::Stage::Dynamics);
  c.matter.calcResidualForceIgnoringConstraints(c.state, zero, no_forces, zero, result);
  return {&result[0], &result[0] + result.size()};
}

double Chassis::height_m(std::size_t robot) const {
  return impl_->robots[robot].chassis.getBodyOriginLocation(impl_->state)[2];
}

double Chassis::tilt_rad(std::size_t robot) const {
  return std::acos(std::min(1.0, impl_->robots[robot].chassis.getBodyRotation(impl_->state).z()[2]));
}

}  // namespace omnihil
