// Whole-robot physics against closed forms, balances and symmetries.
#include <gtest/gtest.h>

#include <algorithm>

#include "sim/robot/geometry.h"
#include "sim/robot/planar_law.h"
#include "tests/sim/robot/sample_robot.h"

namespace omnihil {
namespace {

// Duties whose no-load wheel speeds are eq. (5) of a body velocity: u = k gear omega_wheel.
RobotDrive no_load_drive(const RobotModel& m, const BodyVelocity<double>& v) {
  const auto omega = wheel_speeds(wheel_geometry(m), v);
  PerWheel<double> duty{};
  for (std::size_t i = 0; i < kWheels; ++i) {
    duty[i] = m.motor.torque_constant_Nm_per_A * m.gear_ratio * omega[i] / m.bus_voltage_V;
  }
  return duty_drive(duty);
}

RobotModel without_any_loss(RobotModel m) {
  m = frictionless_motor(m);
  m.tyre_lateral.extremum_value = m.tyre_lateral.asymptote_value = 0.0;
  m.center_of_mass_x_m = m.center_of_mass_y_m = 0.0;  // else turning takes a centripetal force
  return m;
}

double kinetic_energy_J(const RobotModel& m, const RobotTruth& t) {
  const double cx = m.center_of_mass_x_m, cy = m.center_of_mass_y_m, w = t.omega_body_rad_s;
  const double vx = t.v_forward_m_s, vy = t.v_left_m_s;
  double energy = 0.5 * m.mass_kg * (vx * vx + vy * vy) + 0.5 * m.yaw_inertia_kg_m2 * w * w +
                  m.mass_kg * w * (cx * vy - cy * vx);
  for (double omega : t.omega_wheel_rad_s) energy += 0.5 * spin_inertia_kg_m2(m) * omega * omega;
  return energy;
}

TEST(Physics, WithoutLossesItReachesTheMotorsNoLoadSpeedInEveryDirection) {
  const RobotModel m = without_any_loss(sample_robot());
  for (const BodyVelocity<double>& v :
       {BodyVelocity<double>{1.0, 0.0, 0.0}, {0.0, -0.8, 0.0}, {0.0, 0.0, 6.0}}) {
    Plant plant = one_robot(m, planar_options(250'000));
    plant.write(0, no_load_drive(m, v));
    plant.advance(4'000'000'000);
    const RobotTruth t = plant.truth(0);
    EXPECT_NEAR(t.v_forward_m_s, v.v_forward_m_s, 1e-6);
    EXPECT_NEAR(t.v_left_m_s, v.v_left_m_s, 1e-6);
    EXPECT_NEAR(t.omega_body_rad_s, v.omega_body_rad_s, 1e-5);
  }
}

TEST(Physics, SteadyTorquesBalanceOnEveryWheel) {
  const RobotModel m = sample_robot();
  Plant plant = one_robot(m, planar_options(250'000));
  plant.write(0, no_load_drive(m, {1.2, 0.4, 0.0}));
  plant.advance(4'000'000'000);
  const RobotTruth t = plant.truth(0);
  const RobotDrive drive = no_load_drive(m, {1.2, 0.4, 0.0});
  const double k = m.motor.torque_constant_Nm_per_A;
  for (std::size_t i = 0; i < kWheels; ++i) {
    const double u = drive.duty_ratio[i] * m.bus_voltage_V, omega = t.omega_rotor_rad_s[i];
    // eq. (7): (k/R) u - (k^2/R) omega = tau_c sign + b omega + r F / gear
    const double motor_Nm = k / m.motor.resistance_ohm * (u - k * omega);
    const double load_Nm = std::copysign(m.motor.coulomb_friction_Nm, omega) +
                           m.motor.viscous_friction_Nm_s_per_rad * omega +
                           m.wheel_radius_m * t.force_longitudinal_N[i] / m.gear_ratio;
    EXPECT_NEAR(motor_Nm, load_Nm, 1e-5) << "wheel " << i;
    EXPECT_GT(std::abs(motor_Nm), 1e-3);
  }
}

TEST(Physics, ARollingRobotSlowsByRollerDragOverMassAndWheels) {
  const RobotModel m = frictionless_motor(symmetric_robot());
  Plant plant = one_robot(m, planar_options(250'000));
  plant.write(0, no_load_drive(m, {3.0, 0.0, 0.0}));
  plant.advance(2'000'000'000);
  plant.write(0, RobotDrive{});  // coast
  plant.advance(100'000'000);
  const RobotTruth a = plant.truth(0);
  plant.advance(100'000'000);
  const RobotTruth b = plant.truth(0);
  double drag_N = 0.0, mass_kg = m.mass_kg;
  for (std::size_t i = 0; i < kWheels; ++i) {
    const double c = std::cos(m.wheel_angle_rad[i]), s = std::sin(m.wheel_angle_rad[i]);
    ASSERT_GT(std::abs(c * b.v_forward_m_s), m.slip_speed_floor_m_s);
    drag_N += m.tyre_lateral.extremum_value * 0.5 * (a.load_N[i] + b.load_N[i]) * std::abs(c);
    mass_kg += spin_inertia_kg_m2(m) * s * s / (m.wheel_radius_m * m.wheel_radius_m);
  }
  EXPECT_NEAR((a.v_forward_m_s - b.v_forward_m_s) / 0.1, drag_N / mass_kg, 0.01 * drag_N / mass_kg);
  EXPECT_GT(drag_N, 0.2);
}

TEST(Physics, OneMetrePerSecondForwardSlipsLessThanOnePercent) {
  for (const RobotModel& m : {sample_robot(), symmetric_robot()}) {
    Plant plant = one_robot(m, planar_options(250'000));
    const auto target = wheel_speeds<double>(wheel_geometry(m), {1.0, 0.0, 0.0});
    PerWheel<double> integral{};
    for (int ms = 0; ms < 3000; ++ms) {  // a plain PI loop on the wheels' speed
      const RobotTruth t = plant.truth(0);
      PerWheel<double> duty{};
      for (std::size_t i = 0; i < kWheels; ++i) {
        const double error = target[i] - t.omega_wheel_rad_s[i];
        integral[i] += error * 1e-3;
        duty[i] = std::clamp(0.01 * error + 0.1 * integral[i], -1.0, 1.0);
      }
      plant.write(0, duty_drive(duty));
      plant.advance(1'000'000);
    }
    const RobotTruth t = plant.truth(0);
    EXPECT_NEAR(t.v_forward_m_s, 1.0, 0.01);
    EXPECT_NEAR(t.v_left_m_s, 0.0, 0.01);
    const auto rolling =
        wheel_speeds<double>(wheel_geometry(m), {t.v_forward_m_s, t.v_left_m_s, t.omega_body_rad_s});
    for (std::size_t i = 0; i < kWheels; ++i) {
      EXPECT_LT(std::abs(t.slip_longitudinal_ratio[i]), 0.01);
      EXPECT_NEAR(t.omega_wheel_rad_s[i], rolling[i], 0.01 * std::abs(rolling[i]));
    }
  }
}

TEST(Physics, ABalancedRobotSpinsOnTheSpot) {
  RobotModel m = symmetric_robot();
  m.wheel_angle_rad = {45 * kDegree, 135 * kDegree, 225 * kDegree, 315 * kDegree};
  Plant plant = one_robot(m, planar_options());
  plant.write(0, duty_drive({0.2, 0.2, 0.2, 0.2}));
  plant.advance(1'000'000'000);
  const RobotTruth t = plant.truth(0);
  EXPECT_GT(t.yaw_rad, 3.0);
  EXPECT_NEAR(t.x_m, 0.0, 1e-12);
  EXPECT_NEAR(t.y_m, 0.0, 1e-12);
}

TEST(Physics, TheMirrorImageOfADriveIsTheMirrorImageOfItsPath) {
  const RobotModel m = symmetric_robot();  // wheels 0 and 3, 1 and 2 are each other's images
  Plant plant = one_robot(m, planar_options()), image = one_robot(m, planar_options());
  for (int ms = 0; ms < 2000; ++ms) {
    const RobotDrive d = excitation_drive(0, ms * 1e-3);
    plant.write(0, d);
    image.write(0, duty_drive({-d.duty_ratio[3], -d.duty_ratio[2], -d.duty_ratio[1], -d.duty_ratio[0]}));
    plant.advance(1'000'000);
    image.advance(1'000'000);
  }
  const RobotTruth t = plant.truth(0), i = image.truth(0);
  EXPECT_GT(std::abs(t.y_m), 0.1);
  EXPECT_NEAR(t.x_m, i.x_m, 1e-9);
  EXPECT_NEAR(t.y_m, -i.y_m, 1e-9);
  EXPECT_NEAR(t.yaw_rad, -i.yaw_rad, 1e-9);
  EXPECT_NEAR(t.omega_wheel_rad_s[0], -i.omega_wheel_rad_s[3], 1e-8);
}

TEST(Physics, WhereItStartsAndHowItIsTurnedDoesNotMatter) {
  const RobotModel m = sample_robot();
  Plant here = one_robot(m, planar_options()), there = one_robot(m, planar_options());
  there.set_pose(0, 2.0, -1.0, 1.1);
  excite(here, 1.0);
  excite(there, 1.0);
  const RobotTruth a = here.truth(0), b = there.truth(0);
  EXPECT_NEAR(b.x_m, 2.0 + std::cos(1.1) * a.x_m - std::sin(1.1) * a.y_m, 1e-10);
  EXPECT_NEAR(b.y_m, -1.0 + std::sin(1.1) * a.x_m + std::cos(1.1) * a.y_m, 1e-10);
  EXPECT_NEAR(b.yaw_rad, 1.1 + a.yaw_rad, 1e-10);
}

// Work of motors = gain of kinetic energy + friction + sliding + rollers, by quadrature over fine steps. Also
// momentum: the floor's forces change the centre of mass's momentum and nothing else does.
TEST(Physics, EnergyAndMomentumBalanceUnderHardDriving) {
  const RobotModel m = sample_robot();
  const double h = 50e-6;
  Plant plant = one_robot(m, planar_options(50'000));
  double motors_J = 0.0, friction_J = 0.0, floor_J = 0.0, impulse_x = 0.0, impulse_y = 0.0;
  RobotTruth before = plant.truth(0);
  const auto floor_power_W = [&](const RobotTruth& t) {  // of the floor's forces on the sliding surfaces
    double power = 0.0;
    for (std::size_t i = 0; i < kWheels; ++i) {
      const double s = std::sin(m.wheel_angle_rad[i]), c = std::cos(m.wheel_angle_rad[i]);
      const double sliding = -s * t.v_forward_m_s + c * t.v_left_m_s +
                             m.wheel_center_radius_m * t.omega_body_rad_s -
                             m.wheel_radius_m * t.omega_wheel_rad_s[i];
      power += t.force_longitudinal_N[i] * sliding +
               t.force_lateral_N[i] * (c * t.v_forward_m_s + s * t.v_left_m_s);
    }
    return power;
  };
  const auto force_W = [&](const RobotTruth& t) {
    double fx = 0.0, fy = 0.0;
    for (std::size_t i = 0; i < kWheels; ++i) {
      const double a = m.wheel_angle_rad[i] + t.yaw_rad;
      fx += -std::sin(a) * t.force_longitudinal_N[i] + std::cos(a) * t.force_lateral_N[i];
      fy += std::cos(a) * t.force_longitudinal_N[i] + std::sin(a) * t.force_lateral_N[i];
    }
    return std::array<double, 2>{fx, fy};
  };
  for (int n = 0; n < 20'000; ++n) {
    if (n % 20 == 0) plant.write(0, excitation_drive(0, n * h));
    plant.advance(50'000);
    const RobotTruth t = plant.truth(0);
    for (std::size_t i = 0; i < kWheels; ++i) {
      const double omega = 0.5 * (before.omega_rotor_rad_s[i] + t.omega_rotor_rad_s[i]);
      motors_J += t.motor_torque_Nm[i] * omega * h;
      friction_J += (m.motor.coulomb_friction_Nm * std::abs(omega) +
                     m.motor.viscous_friction_Nm_s_per_rad * omega * omega) *
                    h;
    }
    floor_J += 0.5 * (floor_power_W(before) + floor_power_W(t)) * h;
    impulse_x += 0.5 * (force_W(before)[0] + force_W(t)[0]) * h;
    impulse_y += 0.5 * (force_W(before)[1] + force_W(t)[1]) * h;
    before = t;
  }
  EXPECT_GT(motors_J, 1.0);
  EXPECT_LT(floor_J, -0.05);
  EXPECT_NEAR(motors_J + floor_J - friction_J, kinetic_energy_J(m, before), 2e-3 * motors_J);
  const double c = std::cos(before.yaw_rad), s = std::sin(before.yaw_rad), w = before.omega_body_rad_s;
  const double cm_x = before.v_forward_m_s - w * m.center_of_mass_y_m;  // v + omega x c, body frame
  const double cm_y = before.v_left_m_s + w * m.center_of_mass_x_m;
  EXPECT_NEAR(impulse_x, m.mass_kg * (c * cm_x - s * cm_y), 1e-3);
  EXPECT_NEAR(impulse_y, m.mass_kg * (s * cm_x + c * cm_y), 1e-3);
}

// Largest wheel-speed error against a fine run, in a drive without friction's events.
double error_at(Integrator integrator, std::int64_t step_ns) {
  const RobotModel m = frictionless_motor(sample_robot());
  const auto run = [&](Integrator method, std::int64_t step) {
    PlantOptions o = planar_options(step, method);
    o.electrical_step_ns = 10'000;
    Plant plant = one_robot(m, o);
    for (int ms = 0; ms < 300; ++ms) {
      RobotDrive d = excitation_drive(0, ms * 1e-3);
      for (double& duty : d.duty_ratio) duty *= 0.5;
      plant.write(0, d);
      plant.advance(1'000'000);
    }
    return plant.truth(0);
  };
  const RobotTruth a = run(integrator, step_ns), b = run(Integrator::kRungeKutta4, 10'000);
  return std::hypot(a.x_m - b.x_m, a.y_m - b.y_m, 0.08 * (a.yaw_rad - b.yaw_rad));
}

TEST(Physics, HalvingTheStepHalvesTheErrorOfEulerAndQuartersThatOfRungeKutta) {
  const double euler =
      error_at(Integrator::kSemiImplicitEuler, 500'000) / error_at(Integrator::kSemiImplicitEuler, 250'000);
  EXPECT_GT(euler, 1.6);
  EXPECT_LT(euler, 2.6);
  const double runge_kutta =
      error_at(Integrator::kRungeKutta4, 500'000) / error_at(Integrator::kRungeKutta4, 250'000);
  EXPECT_GT(runge_kutta, 3.0);
}

}  // namespace
}  // namespace omnihil
