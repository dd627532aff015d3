// Sees Simbody's headers; compiled with -UNDEBUG (see sim/CMakeLists.txt).
#ifdef NDEBUG
#error \
    "Simbody as packaged changes its class layout with NDEBUG and would crash: compile this file with -UNDEBUG"
#endif
#include "sim/full_wheel/full_wheel_robot.h"

#include <Simbody.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "sim/robot/contact.h"
#include "sim/robot/planar_law.h"

namespace omnihil {
namespace {

using SimTK::MobilizedBody;
using SimTK::Rotation;
using SimTK::SpatialVec;
using SimTK::Vec3;

constexpr double kPi = 3.14159265358979323846;

struct Wheel {
  MobilizedBody body;
  std::vector<MobilizedBody> roller;
  Vec3 outward_B;
  std::size_t on_floor = 0;  // which roller
  double delta_rad = 0.0;
  // of the step
  double load_N = 0.0, along_N = 0.0, across_N = 0.0, bearing_Nm = 0.0, motor_Nm = 0.0;
  double slip_along_m_s = 0.0, slip_across_m_s = 0.0;
  Vec3 station_R{0}, force_W{0};
};

class Held : public SimTK::Force::Custom::Implementation {
 public:
  Held(const std::vector<Wheel>& wheels, const MobilizedBody& chassis, const Vec3& push_W)
      : wheels_(wheels), chassis_(chassis), push_W_(push_W) {}
  void calcForce(const SimTK::State& state, SimTK::Vector_<SpatialVec>& body_forces, SimTK::Vector_<Vec3>&,
                 SimTK::Vector& mobility_forces) const override {
    chassis_.applyForceToBodyPoint(state, Vec3(0), push_W_, body_forces);
    for (const Wheel& w : wheels_) {
      const MobilizedBody& roller = w.roller[w.on_floor];
      roller.applyForceToBodyPoint(state, w.station_R, w.force_W, body_forces);
      mobility_forces[roller.getFirstUIndex(state)] += w.bearing_Nm;
      mobility_forces[w.body.getFirstUIndex(state)] += w.motor_Nm;
    }
  }
  SimTK::Real calcPotentialEnergy(const SimTK::State&) const override { return 0; }
  bool dependsOnlyOnPositions() const override { return false; }

 private:
  const std::vector<Wheel>& wheels_;
  const MobilizedBody& chassis_;
  const Vec3& push_W_;
};

}  // namespace

struct FullWheelRobot::Impl {
  Impl(const RobotModel& m, const RollerParams& p)
      : matter(system), forces(system), model(m), rollers(p), law(contact_law(m)) {
    if (m.wheels != kWheels)
      throw std::invalid_argument("wheels with all their rollers are simulated of robots with four of them");
    system.setUseUniformBackground(true);
    const double count = p.count, R = m.wheel_radius_m, a = R - p.radius_m;
    spin_kg_m2 = 0.5 * p.mass_kg * p.radius_m * p.radius_m;
    const double length_m = 2.0 * R * std::sin(kPi / count);
    const double across_kg_m2 = p.mass_kg * (3.0 * p.radius_m * p.radius_m + length_m * length_m) / 12.0;
    const double rollers_axial = count * (p.mass_kg * a * a + across_kg_m2);
    const double rollers_yaw = 0.5 * count * (p.mass_kg * a * a + spin_kg_m2 + across_kg_m2);
    const double axial = spin_inertia_kg_m2(m) - rollers_axial, diametral = 0.5 * axial;
    const double wheel_kg = m.wheel_mass_kg - count * p.mass_kg;
    if (!(axial > 0.0) || !(wheel_kg > 0.0))
      throw std::invalid_argument("the rollers are heavier than the model's whole wheel");
    const double r_b = m.wheel_center_radius_m, chassis_kg = m.mass_kg - kWheels * m.wheel_mass_kg;
    double moment_x = m.mass_kg * m.center_of_mass_x_m, moment_y = m.mass_kg * m.center_of_mass_y_m;
    double yaw = m.yaw_inertia_kg_m2;
    for (std::size_t i = 0; i < kWheels; ++i) {
      moment_x -= m.wheel_mass_kg * r_b * law.geometry.cos_angle[i];
      moment_y -= m.wheel_mass_kg * r_b * law.geometry.sin_angle[i];
      yaw -= diametral + rollers_yaw + m.wheel_mass_kg * r_b * r_b;
    }
    const SimTK::Body::Rigid body(
        SimTK::MassProperties(chassis_kg, Vec3(moment_x / chassis_kg, moment_y / chassis_kg, 0),
                              SimTK::Inertia(yaw, yaw, yaw)));  // only the yaw entry acts
    chassis =
        MobilizedBody::Planar(matter.Ground(), SimTK::Transform(Vec3(0, 0, R)), body, SimTK::Transform());
    const SimTK::Body::Rigid wheel_body(
        SimTK::MassProperties(wheel_kg, Vec3(0), SimTK::Inertia(diametral, diametral, axial)));
    const SimTK::Body::Rigid roller_body(
        SimTK::MassProperties(p.mass_kg, Vec3(0), SimTK::Inertia(across_kg_m2, across_kg_m2, spin_kg_m2)));
    wheels.resize(kWheels);
    for (std::size_t i = 0; i < kWheels; ++i) {
      Wheel& w = wheels[i];
      w.outward_B = Vec3(law.geometry.cos_angle[i], law.geometry.sin_angle[i], 0);
      // The axle points inward; the wheel's x points up at angle 0, its y along the drive direction.
      const Rotation r_BAxle(SimTK::UnitVec3(-w.outward_B), SimTK::ZAxis, Vec3(0, 0, 1), SimTK::XAxis);
      w.body = MobilizedBody::Pin(chassis, SimTK::Transform(r_BAxle, r_b * w.outward_B), wheel_body,
                                  SimTK::Transform());
      for (int k = 0; k < p.count; ++k) {
        const double psi = 2.0 * kPi * k / count;
        const Vec3 radial(std::cos(psi), std::sin(psi), 0), tangent(-std::sin(psi), std::cos(psi), 0);
        const Rotation r_WRoller(SimTK::UnitVec3(tangent), SimTK::ZAxis, radial, SimTK::XAxis);
        w.roller.push_back(MobilizedBody::Pin(w.body, SimTK::Transform(r_WRoller, a * radial), roller_body,
                                              SimTK::Transform()));
      }
    }
    SimTK::Force::Custom(forces, new Held(wheels, chassis, push_W));
    system.realizeTopology();
    state = system.getDefaultState();
    system.realizeModel(state);
    system.realize(state, SimTK::Stage::Velocity);
  }

  double motor_Nm(std::size_t i, double wheel_rad_s) const {
    if (by_torque) return input[i];
    const double k = model.motor.torque_constant_Nm_per_A, g = model.gear_ratio;
    return g * k * (input[i] - k * g * wheel_rad_s) / model.motor.resistance_ohm -
           g * g * model.motor.viscous_friction_Nm_s_per_rad * wheel_rad_s;
  }

  // Forces of the floor from positions and speeds (stage Velocity), the loaded roller's spin by the end of the step.
  void find_forces(double step_s) {
    const double R = model.wheel_radius_m;
    double sum_x_N = 0.0, sum_y_N = 0.0;
    for (std::size_t i = 0; i < kWheels; ++i) {
      sum_x_N +=
          -law.geometry.sin_angle[i] * wheels[i].along_N + law.geometry.cos_angle[i] * wheels[i].across_N;
      sum_y_N +=
          law.geometry.cos_angle[i] * wheels[i].along_N + law.geometry.sin_angle[i] * wheels[i].across_N;
    }
    const Rotation& r_WB = chassis.getBodyRotation(state);
    for (std::size_t i = 0; i < kWheels; ++i) {
      Wheel& w = wheels[i];
      w.load_N = std::max(0.0, law.load.at_rest_N[i] + law.load.transfer(i, sum_x_N, sum_y_N));
      const double theta = w.body.getOneQ(state, 0), pitch = 2.0 * kPi / rollers.count;
      // Roller k points down when theta + k pitch = pi.
      const double place = (kPi - theta) / pitch;
      const double nearest = std::round(place);
      w.on_floor = static_cast<std::size_t>(
          std::fmod(std::fmod(nearest, rollers.count) + rollers.count, rollers.count));
      w.delta_rad = (nearest - place) * pitch;
      const MobilizedBody& roller = w.roller[w.on_floor];
      const Vec3 outward_W = r_WB * w.outward_B, drive_W = SimTK::cross(-outward_W, Vec3(0, 0, 1));
      const Vec3 point_W = w.body.getBodyOriginLocation(state) - Vec3(0, 0, R);
      w.station_R = roller.findStationAtGroundPoint(state, point_W);
      const Vec3 v_W = roller.findStationVelocityInGround(state, w.station_R);
      const Vec3 hub_W =
          w.body.getBodyOriginVelocity(state) + chassis.getBodyAngularVelocity(state) % Vec3(0, 0, -R);
      const double along = dot(v_W, drive_W), across = dot(v_W, outward_W);
      const double wheel_rad_s = w.body.getOneU(state, 0), spin = roller.getOneU(state, 0);
      const double scale =
          std::max({std::abs(dot(hub_W, drive_W)), std::abs(R * wheel_rad_s), law.slip_speed_floor_m_s});
      // What a rad/s of the roller is at its lowest point, along the axle: r(delta), signed.
      const Vec3 axis_W = roller.getBodyRotation(state).z();
      const double lever = dot(axis_W % (point_W - roller.getBodyOriginLocation(state)), outward_W);
      const auto across_force = [&](double u) {
        const double size = std::hypot(along, u);
        return size > 1e-12 ? -grip<double>(law.longitudinal, size / scale) * w.load_N * u / size : 0.0;
      };
      const double bearing_most_Nm = law.lateral.extremum_value * w.load_N * std::abs(lever);
      const auto bearing = [&](double s) { return -bearing_most_Nm * std::tanh(s / rollers.bearing_rad_s); };
      // I (s - spin) / h = lever F(across + lever (s - spin)) + bearing(s): monotone in s, so bisected. At no slip or at
      // no change the root lies between.
      const auto balance = [&](double s) {
        return spin_kg_m2 * (s - spin) / step_s - lever * across_force(across + lever * (s - spin)) -
               bearing(s);
      };
      const double rolls = spin - across / lever;  // no slip across
      double low = std::min({spin, rolls, 0.0}), high = std::max({spin, rolls, 0.0});
      for (int n = 0; n < 60 && high - low > 1e-9 * (1.0 + std::abs(high)); ++n) {
        const double middle = 0.5 * (low + high);
        (balance(middle) > 0.0 ? high : low) = middle;
      }
      const double next = 0.5 * (low + high);
      w.slip_along_m_s = along;
      w.slip_across_m_s = across + lever * (next - spin);
      const double size = std::hypot(along, w.slip_across_m_s);
      w.across_N = across_force(w.slip_across_m_s);
      w.along_N =
          size > 1e-12 ? -grip<double>(law.longitudinal, size / scale) * w.load_N * along / size : 0.0;
      w.bearing_Nm = bearing(next);
      w.force_W = w.along_N * drive_W + w.across_N * outward_W;
      w.motor_Nm = motor_Nm(i, wheel_rad_s);
    }
  }

  void advance(double step_s) {
    find_forces(step_s);
    state.invalidateAllCacheAtOrAbove(SimTK::Stage::Dynamics);
    system.realize(state, SimTK::Stage::Acceleration);
    state.updU() += step_s * state.getUDot();
    state.updQ() += step_s * state.getU();  // pins and the planar joint: dq/dt = u
    system.realize(state, SimTK::Stage::Velocity);
    const Vec3 centre_W = chassis.getBodyOriginVelocity(state);
    work_in_J += step_s * dot(push_W, centre_W);
    for (const Wheel& w : wheels) {
      work_in_J += step_s * w.motor_Nm * w.body.getOneU(state, 0);
      work_lost_J -= step_s * (w.along_N * w.slip_along_m_s + w.across_N * w.slip_across_m_s +
                               w.bearing_Nm * w.roller[w.on_floor].getOneU(state, 0));
    }
  }

  SimTK::MultibodySystem system;
  SimTK::SimbodyMatterSubsystem matter;
  SimTK::GeneralForceSubsystem forces;
  RobotModel model;
  RollerParams rollers;
  ContactLaw<double> law;
  MobilizedBody chassis;
  std::vector<Wheel> wheels;
  SimTK::State state;
  Vec3 push_W{0};
  std::array<double, kWheels> input{};
  bool by_torque = false;
  double spin_kg_m2 = 0.0, work_in_J = 0.0, work_lost_J = 0.0;
};

FullWheelRobot::FullWheelRobot(const RobotModel& model, const RollerParams& rollers)
    : impl_(std::make_unique<Impl>(model, rollers)) {}
FullWheelRobot::~FullWheelRobot() = default;
FullWheelRobot::FullWheelRobot(FullWheelRobot&&) noexcept = default;
FullWheelRobot& FullWheelRobot::operator=(FullWheelRobot&&) noexcept = default;

void FullWheelRobot::set_volts(const std::array<double, kWheels>& volt) {
  impl_->input = volt;
  impl_->by_torque = false;
}
void FullWheelRobot::set_torques(const std::array<double, kWheels>& torque_Nm) {
  impl_->input = torque_Nm;
  impl_->by_torque = true;
}
void FullWheelRobot::push(double x_N, double y_N) { impl_->push_W = Vec3(x_N, y_N, 0); }
void FullWheelRobot::advance(double step_s) { impl_->advance(step_s); }

PlanarState FullWheelRobot::state() const {
  const MobilizedBody& c = impl_->chassis;
  const SimTK::State& s = impl_->state;
  return {c.getOneQ(s, 1), c.getOneQ(s, 2), c.getOneQ(s, 0),
          c.getOneU(s, 1), c.getOneU(s, 2), c.getOneU(s, 0)};
}
void FullWheelRobot::set_velocity(double v_x_m_s, double v_y_m_s, double omega_rad_s) {
  Impl& r = *impl_;
  r.chassis.setOneU(r.state, 0, omega_rad_s);
  r.chassis.setOneU(r.state, 1, v_x_m_s);
  r.chassis.setOneU(r.state, 2, v_y_m_s);
  r.system.realize(r.state, SimTK::Stage::Velocity);
}
std::array<double, kWheels> FullWheelRobot::wheel_rad_s() const {
  std::array<double, kWheels> out{};
  for (std::size_t i = 0; i < kWheels; ++i) out[i] = impl_->wheels[i].body.getOneU(impl_->state, 0);
  return out;
}
double FullWheelRobot::roller_rad_s(std::size_t wheel) const {
  const Wheel& w = impl_->wheels[wheel];
  return w.roller[w.on_floor].getOneU(impl_->state, 0);
}
std::array<double, kWheels> FullWheelRobot::force_along_N() const {
  std::array<double, kWheels> out{};
  for (std::size_t i = 0; i < kWheels; ++i) out[i] = impl_->wheels[i].along_N;
  return out;
}
std::array<double, kWheels> FullWheelRobot::force_across_N() const {
  std::array<double, kWheels> out{};
  for (std::size_t i = 0; i < kWheels; ++i) out[i] = impl_->wheels[i].across_N;
  return out;
}
double FullWheelRobot::kinetic_J() const { return impl_->system.calcKineticEnergy(impl_->state); }
double FullWheelRobot::work_in_J() const { return impl_->work_in_J; }
double FullWheelRobot::work_lost_J() const { return impl_->work_lost_J; }

}  // namespace omnihil
