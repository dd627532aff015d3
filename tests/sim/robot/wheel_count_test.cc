// Robots of two to six wheels: kinematics, loads and steady drives in closed form, back ends against each other.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "sim/robot/validate.h"
#include "sim/robot/wheel_load.h"
#include "sim/rolling/rolling_robot.h"
#include "tests/sim/rolling/rolling_sample.h"

namespace omnihil {
namespace {

// Wheels at these angles, centre of mass in the middle, motors without friction, rollers without drag.
RobotModel with_wheels(const std::vector<double>& angle_deg) {
  RobotModel m = frictionless_motor(sample_robot());
  m.name = "of " + std::to_string(angle_deg.size());
  m.center_of_mass_x_m = m.center_of_mass_y_m = 0.0;
  m.wheels = angle_deg.size();
  m.wheel_angle_rad = {};
  for (std::size_t i = 0; i < m.wheels; ++i) m.wheel_angle_rad[i] = angle_deg[i] * kDegree;
  m.tyre_lateral.extremum_value = m.tyre_lateral.asymptote_value = 0.0;
  return m;
}

RobotModel kiwi() { return with_wheels({150, 270, 30}); }

// Wheels without rollers, left and right.
RobotModel differential() {
  RobotModel m = with_wheels({90, 270});
  m.tyre_lateral = m.tyre_longitudinal;
  return m;
}

const std::vector<std::vector<double>> kOmni = {
    {150, 270, 30}, {40, 140, 220, 320}, {0, 72, 144, 216, 288}, {30, 90, 150, 210, 270, 330}};

TEST(WheelCount, ThreeWheelsTurnAsTheBodyMovesOverThem) {
  // (-sin a v_forward + cos a v_left + R_b w) / r, by hand for 150, 270 and 30 degrees
  const auto g = wheel_geometry(kiwi());
  const auto w = wheel_speeds<double>(g, {1.0, 2.0, 3.0});
  const double turn = 0.0805 * 3.0, half = 0.5 * std::sqrt(3.0);
  EXPECT_NEAR(w[0], (-0.5 * 1.0 - half * 2.0 + turn) / 0.027, 1e-12);
  EXPECT_NEAR(w[1], (1.0 + turn) / 0.027, 1e-12);
  EXPECT_NEAR(w[2], (-0.5 * 1.0 + half * 2.0 + turn) / 0.027, 1e-12);
}

TEST(WheelCount, BodyVelocityUndoesWheelSpeedsForAnyNumber) {
  for (const auto& angles : kOmni) {
    const auto g = wheel_geometry(with_wheels(angles));
    const auto v = body_velocity(g, wheel_speeds<double>(g, {1.3, -0.4, 5.0}));
    EXPECT_NEAR(v.v_forward_m_s, 1.3, 1e-12) << angles.size();
    EXPECT_NEAR(v.v_left_m_s, -0.4, 1e-12) << angles.size();
    EXPECT_NEAR(v.omega_body_rad_s, 5.0, 1e-11) << angles.size();
  }
}

TEST(WheelCount, ADifferentialDriveKnowsTwoSpeedsAndClaimsNoThird) {
  const auto g = wheel_geometry(differential());
  // left wheel at +y: its positive direction points backwards
  const double left = 8.0, right = 12.0, r = 0.027, half_track_m = 0.0805;
  const auto v = body_velocity<double>(g, {-left, right});
  EXPECT_NEAR(v.v_forward_m_s, r * (left + right) / 2.0, 1e-12);
  EXPECT_NEAR(v.v_left_m_s, 0.0, 1e-12);
  EXPECT_NEAR(v.omega_body_rad_s, r * (right - left) / (2.0 * half_track_m), 1e-12);
}

// A roller pushes along its own axis only: a mecanum wheel with rollers at 45 degrees is an omni wheel that stands across
// its rollers' axis, of radius r cos 45, as far from the centre as that axis passes it.
TEST(WheelCount, MecanumWheelsAreOmniWheelsAcrossTheirRollers) {
  const double half_length_m = 0.15, half_width_m = 0.12, r = 0.03;
  RobotModel m = with_wheels({45, 135, 225, 315});
  m.wheel_center_radius_m = (half_length_m + half_width_m) / std::sqrt(2.0);
  m.wheel_radius_m = r / std::sqrt(2.0);
  const double vx = 0.7, vy = -0.4, w = 1.9, arm = (half_length_m + half_width_m) * w;
  const auto omega = wheel_speeds<double>(wheel_geometry(m), {vx, vy, w});
  // Muir and Neuman 1987: front left, rear left, rear right, front right; positive rolls the robot forward there
  const double front_left = (vx - vy - arm) / r, rear_left = (vx + vy - arm) / r;
  const double rear_right = (vx - vy + arm) / r, front_right = (vx + vy + arm) / r;
  EXPECT_NEAR(-omega[0], front_left, 1e-11);
  EXPECT_NEAR(-omega[1], rear_left, 1e-11);
  EXPECT_NEAR(omega[2], rear_right, 1e-11);
  EXPECT_NEAR(omega[3], front_right, 1e-11);
}

TEST(WheelCount, WheelsCarryTheWeightAndItsMomentWhateverTheirNumber) {
  for (const auto& angles : kOmni) {
    RobotModel m = with_wheels(angles);
    m.center_of_mass_x_m = 0.006;
    m.center_of_mass_y_m = -0.004;
    const auto g = wheel_geometry(m);
    const auto law =
        wheel_load_law(g, m.mass_kg, m.center_of_mass_x_m, m.center_of_mass_y_m, m.center_of_mass_height_m);
    double sum = 0.0, about_y = 0.0, about_x = 0.0;
    for (std::size_t i = 0; i < m.wheels; ++i) {
      sum += law.at_rest_N[i];
      about_y += law.at_rest_N[i] * m.wheel_center_radius_m * g.cos_angle[i];
      about_x += law.at_rest_N[i] * m.wheel_center_radius_m * g.sin_angle[i];
    }
    const double weight_N = m.mass_kg * kGravity_m_s2;
    EXPECT_NEAR(sum, weight_N, 1e-12 * weight_N);
    EXPECT_NEAR(about_y, weight_N * 0.006, 1e-12);
    EXPECT_NEAR(about_x, weight_N * -0.004, 1e-12);
  }
}

TEST(WheelCount, TwoWheelsCarryHalfEachAndShiftLoadAlongTheirAxleOnly) {
  const RobotModel m = differential();
  const auto law = wheel_load_law(wheel_geometry(m), m.mass_kg, 0.01, 0.0, m.center_of_mass_height_m);
  EXPECT_NEAR(law.at_rest_N[0], 0.5 * m.mass_kg * kGravity_m_s2,
              1e-12);  // a caster holds the moment of 10 mm
  EXPECT_NEAR(law.at_rest_N[1], 0.5 * m.mass_kg * kGravity_m_s2, 1e-12);
  EXPECT_NEAR(law.transfer(0, 1.0, 0.0), 0.0, 1e-15);
  // dN (2 R_b) = -h F_y
  EXPECT_NEAR(law.transfer(0, 0.0, 1.0), -m.center_of_mass_height_m / (2.0 * m.wheel_center_radius_m), 1e-14);
}

// Each wheel's motor pulls towards its idle speed with (k N / r)^2 / R newtons per m/s; together they hold the body on its
// curve, m w x v.
TEST(WheelCount, ARollingRobotSettlesWhereItsMotorsBalance) {
  for (const auto& angles : kOmni) {
    const RobotModel m = with_wheels(angles);
    const double k = m.motor.torque_constant_Nm_per_A * m.gear_ratio / m.wheel_radius_m;
    const double pull_N_s_per_m = k * k / m.motor.resistance_ohm;
    RollingRobot<double> robot(rolling(m, false), {}, {});
    RollingState<double> x = robot.start({}, {});
    RollingInput<double> in;
    for (std::size_t i = 0; i < m.wheels; ++i)
      in.duty_ratio[i] = 0.05 * std::sin(1.0 + 2.0 * static_cast<double>(i));
    for (int ms = 0; ms < 3000; ++ms) robot.advance(x, in, 1e-3);
    const auto g = wheel_geometry(m);
    const BodyVelocity<double> v{x.velocity[0], x.velocity[1], x.velocity[2]};
    double force_x = 0.0, force_y = 0.0, moment = 0.0;
    for (std::size_t i = 0; i < m.wheels; ++i) {
      const double idle_m_s = in.duty_ratio[i] * m.bus_voltage_V / k;
      const double force_N = pull_N_s_per_m * (idle_m_s - rim_speed_m_s(g, i, v));
      force_x -= g.sin_angle[i] * force_N;
      force_y += g.cos_angle[i] * force_N;
      moment += g.wheel_center_radius_m * force_N;
    }
    EXPECT_GT(std::hypot(x.velocity[0], x.velocity[1]), 1e-3) << angles.size();
    EXPECT_NEAR(force_x, -m.mass_kg * v.omega_body_rad_s * v.v_left_m_s, 1e-4) << angles.size();
    EXPECT_NEAR(force_y, m.mass_kg * v.omega_body_rad_s * v.v_forward_m_s, 1e-4) << angles.size();
    EXPECT_NEAR(moment, 0.0, 1e-5) << angles.size();
    EXPECT_EQ(robot.steps_unsolved(), 0.0);
  }
}

// Where the idle speeds agree with one straight motion, or one turn on the spot, no wheel pushes, and nothing slips.
TEST(WheelCount, ThePlantSettlesAtTheSpeedThatItsDutiesMean) {
  for (const auto& angles : kOmni) {
    for (const BodyVelocity<double>& v :
         {BodyVelocity<double>{0.3, 0.2, 0.0}, BodyVelocity<double>{0.0, 0.0, 1.0}}) {
      const RobotModel m = with_wheels(angles);
      Plant plant = one_robot(m, planar_options(500'000));
      const auto wanted = wheel_speeds<double>(wheel_geometry(m), v);
      PerWheel<double> duty{};
      for (std::size_t i = 0; i < m.wheels; ++i)
        duty[i] = wanted[i] * m.gear_ratio * m.motor.torque_constant_Nm_per_A / m.bus_voltage_V;
      plant.write_duties(0, duty);
      plant.advance(4'000'000'000);
      const RobotTruth t = plant.truth(0);
      EXPECT_NEAR(t.v_forward_m_s, v.v_forward_m_s, 1e-6) << angles.size();
      EXPECT_NEAR(t.v_left_m_s, v.v_left_m_s, 1e-6) << angles.size();
      EXPECT_NEAR(t.omega_body_rad_s, v.omega_body_rad_s, 1e-6) << angles.size();
      double load = 0.0;
      for (std::size_t i = 0; i < m.wheels; ++i) load += t.load_N[i];
      EXPECT_NEAR(load, m.mass_kg * kGravity_m_s2, 1e-9);
    }
  }
}

TEST(WheelCount, ADifferentialDriveGoesStraightAndRoundAndNotSideways) {
  const RobotModel m = differential();
  ASSERT_EQ(robot_problems(m), std::vector<std::string>{});
  const double idle =
      0.1 * m.bus_voltage_V / m.motor.torque_constant_Nm_per_A / m.gear_ratio;  // rad/s of a wheel at 0.1
  Plant straight = one_robot(m, planar_options(500'000));
  straight.write_duties(0, {-0.1, 0.1});
  straight.advance(4'000'000'000);
  EXPECT_NEAR(straight.truth(0).v_forward_m_s, idle * m.wheel_radius_m, 1e-6);
  EXPECT_NEAR(straight.truth(0).v_left_m_s, 0.0, 1e-9);
  EXPECT_NEAR(straight.truth(0).y_m, 0.0, 1e-9);
  Plant round = one_robot(m, planar_options(500'000));
  round.write_duties(0, {-0.05, 0.1});
  round.advance(4'000'000'000);
  const RobotTruth t = round.truth(0);
  // the curve's force, m v w, is held by the tyres at a small slip outwards: 1.5 peak / extremum_slip x g over the scale of
  // 0.5 m/s
  const double slip_m_s = t.v_forward_m_s * t.omega_body_rad_s / kGravity_m_s2 / (1.5 * 0.75 / 0.10) * 0.5;
  EXPECT_NEAR(t.v_left_m_s, -slip_m_s, 0.05 * slip_m_s);
  // which drags along the body's x, m w slip, against two motors of (k N / r)^2 / R newtons per m/s
  const double k = m.motor.torque_constant_Nm_per_A * m.gear_ratio / m.wheel_radius_m;
  const double drag_m_s = m.mass_kg * t.omega_body_rad_s * slip_m_s / (2.0 * k * k / m.motor.resistance_ohm);
  EXPECT_NEAR(t.v_forward_m_s, 0.75 * idle * m.wheel_radius_m - drag_m_s, 2e-4);
  EXPECT_NEAR(t.omega_body_rad_s, 0.25 * idle * m.wheel_radius_m / m.wheel_center_radius_m, 1e-2);
}

TEST(WheelCount, ClosedFormAndSimbodyAgree) {
  for (const auto& angles : {kOmni[0], kOmni[2], kOmni[3], std::vector<double>{90, 270}}) {
    RobotModel m = with_wheels(angles);
    m.center_of_mass_x_m = 0.004;
    m.tyre_lateral = angles.size() == 2 ? m.tyre_longitudinal : kDefaultTyreLateral;
    PlantOptions o = planar_options(250'000);
    Plant planar = one_robot(m, o);
    o.physics = Physics::kSimbody;
    Plant simbody = one_robot(m, o);
    for (int ms = 0; ms < 100; ++ms) {
      PerWheel<double> duty{};
      for (std::size_t i = 0; i < m.wheels; ++i)
        duty[i] = 0.3 * std::sin(0.02 * ms + 1.3 * static_cast<double>(i));
      planar.write_duties(0, duty);
      simbody.write_duties(0, duty);
      planar.advance(1'000'000);
      simbody.advance(1'000'000);
    }
    const RobotTruth a = planar.truth(0), b = simbody.truth(0);
    EXPECT_GT(std::hypot(a.x_m, a.y_m) + std::abs(a.yaw_rad), 1e-3) << angles.size();
    EXPECT_NEAR(a.x_m, b.x_m, 1e-9) << angles.size();
    EXPECT_NEAR(a.y_m, b.y_m, 1e-9) << angles.size();
    EXPECT_NEAR(a.yaw_rad, b.yaw_rad, 1e-9) << angles.size();
    for (std::size_t i = 0; i < m.wheels; ++i)
      EXPECT_NEAR(a.omega_wheel_rad_s[i], b.omega_wheel_rad_s[i], 1e-6);
  }
}

TEST(WheelCount, RobotsOfSeveralNumbersShareAPlant) {
  const std::vector<RobotModel> robots = {kiwi(), with_wheels(kOmni[3]), differential(),
                                          with_wheels(kOmni[1])};
  Plant together(robots, planar_options(500'000));
  std::vector<Plant> alone;
  for (const RobotModel& m : robots) alone.push_back(one_robot(m, planar_options(500'000)));
  for (int ms = 0; ms < 50; ++ms) {
    for (std::size_t n = 0; n < robots.size(); ++n) {
      PerWheel<double> duty{};
      for (std::size_t i = 0; i < robots[n].wheels; ++i)
        duty[i] = 0.2 * std::sin(0.1 * ms + static_cast<double>(n + i));
      together.write_duties(static_cast<int>(n), duty);
      alone[n].write_duties(0, duty);
      alone[n].advance(1'000'000);
    }
    together.advance(1'000'000);
  }
  for (std::size_t n = 0; n < robots.size(); ++n) {
    EXPECT_EQ(together.truth(static_cast<int>(n)).v_forward_m_s, alone[n].truth(0).v_forward_m_s) << n;
    EXPECT_EQ(together.sample_all(static_cast<int>(n)).encoder_counts, alone[n].sample_all(0).encoder_counts)
        << n;
  }
  PlantOptions simbody;
  simbody.physics = Physics::kSimbody;
  EXPECT_THROW(Plant(robots, simbody), std::invalid_argument);
}

TEST(WheelCount, AFifthWheelIsSensedAndFaultyAsTheOthers) {
  Plant plant = one_robot(with_wheels(kOmni[3]), planar_options(500'000));
  RobotFaults faults;
  faults.encoder_stuck[4] = true;
  plant.set_faults(0, faults);
  plant.write_duties(0, {0.1, 0.1, 0.1, 0.1, 0.1, 0.1});
  plant.advance(500'000'000);
  const PlantSensors s = plant.sample_all(0);
  EXPECT_GT(s.encoder_counts[5], 1000);
  EXPECT_EQ(s.encoder_counts[4], 0);
  EXPECT_EQ(s.encoder_counts[5], s.encoder_counts[0]);  // it turns on the spot
}

TEST(WheelCount, DerivativesAreExactForThreeAndSixWheels) {
  for (const auto& angles : {kOmni[0], kOmni[3]}) {
    const RobotModel m = with_wheels(angles);
    const auto run = [&](auto scalar, double mass_kg) {
      using T = decltype(scalar);
      RollingParams<double> at = rolling(m, false);
      at.mass_kg = mass_kg;
      RollingParams<T> p = rolling_params_as<T>(at);
      if constexpr (!std::is_same_v<T, double>) p.mass_kg = T(mass_kg, 0);
      RollingRobot<T> robot(p, {}, {});
      RollingState<T> x = robot.start({}, {});
      RollingInput<T> in;
      for (int ms = 0; ms < 100; ++ms) {
        for (std::size_t i = 0; i < m.wheels; ++i)
          in.duty_ratio[i] = T(0.05 * std::sin(0.03 * ms + 2.0 * static_cast<double>(i)));
        robot.advance(x, in, 1e-3);
      }
      return x.velocity[0];
    };
    const Jet y = run(Jet(0.0), 2.4);
    const double h = 1e-4, difference = (run(0.0, 2.4 + h) - run(0.0, 2.4 - h)) / (2.0 * h);
    EXPECT_NEAR(y.v[0], difference, 1e-5 * std::abs(difference)) << angles.size();
    EXPECT_NEAR(y.a, run(0.0, 2.4), 1e-12) << angles.size();
  }
}

TEST(WheelCount, WhatCannotDriveIsRefused) {
  RobotModel one_side = with_wheels({90, 90, 270});
  one_side.tyre_lateral.extremum_value = 0.0;  // rollers: nothing holds it sideways
  EXPECT_FALSE(robot_problems(one_side).empty());
  RobotModel single = with_wheels({90});
  EXPECT_FALSE(robot_problems(single).empty());
  for (const auto& angles : kOmni) EXPECT_EQ(robot_problems(with_wheels(angles)), std::vector<std::string>{});
}

}  // namespace
}  // namespace omnihil
