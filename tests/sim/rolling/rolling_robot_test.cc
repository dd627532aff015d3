// The robot that rolls or slips, solved implicitly: against formulas, against the plant, against itself.
#include "sim/rolling/rolling_robot.h"

#include <gtest/gtest.h>

#include "sim/model/effect_reader.h"
#include "tests/sim/rolling/rolling_sample.h"

namespace omnihil {
namespace {

std::vector<EffectUse> effects(const std::vector<std::string>& texts) {
  std::vector<EffectUse> uses;
  for (const std::string& text : texts) EXPECT_EQ(add_override(text, {}, uses), "");
  return uses;
}

std::vector<double> values_of(const std::vector<EffectUse>& uses) {
  std::vector<double> values;
  for (const EffectUse& use : uses) values.insert(values.end(), use.values.begin(), use.values.end());
  return values;
}

// Duties that change every 50 ms, in all directions, and stop at times.
PerWheel<double> lively(int ms) {
  const int k = ms / 50;
  PerWheel<double> duty{};
  for (std::size_t i = 0; i < kWheels; ++i) {
    duty[i] = k % 7 == 6 ? 0.0 : 0.05 * std::sin(1.3 * k + 1.7 * static_cast<double>(i) * (1 + k % 3));
  }
  return duty;
}

template <typename Look>
void drive(RollingRobot<double>& robot, RollingState<double>& x, int for_ms, int steps_per_ms, Look look,
           double part = 1.0) {
  for (int ms = 0; ms < for_ms; ++ms) {
    RollingInput in;
    in.duty_ratio = lively(ms);
    for (double& duty : in.duty_ratio) duty *= part;
    for (int j = 0; j < steps_per_ms; ++j) robot.advance(x, in, 1e-3 / steps_per_ms);
    look(ms + 1);
  }
}

double energy_J(const RollingParams<double>& p, const RollingState<double>& x) {
  const double w = x.velocity[2];
  const double vx = x.velocity[0] - w * p.center_of_mass_y_m;  // of the centre of mass
  const double vy = x.velocity[1] + w * p.center_of_mass_x_m;
  const double offset2 =
      p.center_of_mass_x_m * p.center_of_mass_x_m + p.center_of_mass_y_m * p.center_of_mass_y_m;
  double sum =
      0.5 * p.mass_kg * (vx * vx + vy * vy) + 0.5 * (p.yaw_inertia_kg_m2 - p.mass_kg * offset2) * w * w;
  for (std::size_t i = 0; i < kWheels; ++i) {
    sum += 0.5 * inertia_at_rotor(p.drive) * x.omega_rotor_rad_s(i) * x.omega_rotor_rad_s(i);
  }
  return sum;
}

TEST(RollingRobot, SpinsUpOnTheSpotAsTheFormulaSays) {
  RobotModel m = frictionless_motor(symmetric_robot());
  m.wheel_angle_rad = {45 * kDegree, 135 * kDegree, 225 * kDegree, 315 * kDegree};
  m.motor.inductance_H = 0.0;
  m.motor.current_limit_A = 0.0;
  const RollingParams<double> p = rolling(m, false);
  RollingRobot<double> robot(p, {}, {});
  RollingState<double> x = robot.start({}, {});
  RollingInput in;
  in.duty_ratio.fill(0.1);
  const double step_s = 1e-4, time_s = 0.05;
  for (int n = 0; n < 500; ++n) robot.advance(x, in, step_s);
  // all four push the yaw: rotor's inertia + the robot's share, J = J_r + I (r / (N R_b))^2 / 4, against the
  // winding's k^2 / R:  omega = u / k (1 - exp(-t k^2 / (R J)))
  const double k = m.motor.torque_constant_Nm_per_A, r = m.motor.resistance_ohm;
  const double lever = m.wheel_radius_m / (m.gear_ratio * m.wheel_center_radius_m);
  const double inertia = inertia_at_rotor(p.drive) + 0.25 * m.yaw_inertia_kg_m2 * lever * lever;
  const double free_rad_s = 0.1 * m.bus_voltage_V / k;
  const double expected = free_rad_s * -std::expm1(-time_s * k * k / (r * inertia));
  EXPECT_NEAR(x.omega_rotor_rad_s(0), expected, 1e-4 * expected);  // second order in the step
  EXPECT_NEAR(x.velocity[2], expected * lever, 1e-4 * expected * lever);
}

TEST(RollingRobot, WheelsThatRollKeepTheRimSpeedsOfOneBody) {
  RollingRobot<double> robot(rolling(sample_robot(), false), effects({"coulomb_friction.torque_Nm=0.0025"}),
                             std::vector<double>{0.0025});
  RollingState<double> x = robot.start({.v_forward_m_s = 0.3}, {});
  const RobotModel m = sample_robot();
  drive(robot, x, 2000, 1, [&](int) {
    for (std::size_t i = 0; i < kWheels; ++i) {
      const BodyVelocity<double> v{x.velocity[0], x.velocity[1], x.velocity[2]};
      const double rim = m.wheel_radius_m * x.omega_rotor_rad_s(i) / m.gear_ratio;
      // 1 um/s per newton
      ASSERT_NEAR(rim, rim_speed_m_s(wheel_geometry(m), i, v), 3e-5);
    }
  });
  EXPECT_EQ(robot.steps_unsolved(), 0.0);
}

TEST(RollingRobot, LessAndLessComplianceEndsInRolling) {
  const RollingParams<double> p = rolling(sample_robot(), false);
  RollingRobot<double> rolls(p, {}, {});
  RollingState<double> x = rolls.start({}, {});
  const double gentle = 0.3;  // no wheel reaches its full grip
  drive(
      rolls, x, 500, 1, [](int) {}, gentle);
  double last = 1e9;
  for (const double compliance : {1e-2, 1e-3, 1e-4}) {
    const auto uses =
        effects({"wheel_slip.compliance_m_s=" + std::to_string(compliance), "wheel_slip.grip=2"});
    RollingRobot<double> slips(p, uses, values_of(uses));
    RollingState<double> y = slips.start({}, {});
    drive(
        slips, y, 500, 1, [](int) {}, gentle);
    const double apart = std::hypot(y.velocity[0] - x.velocity[0], y.velocity[1] - x.velocity[1]);
    EXPECT_LT(apart, 0.3 * last) << compliance;
    EXPECT_EQ(slips.steps_unsolved(), 0.0);
    last = apart;
  }
}

TEST(RollingRobot, FrictionAndFloorOnlyTakeEnergy) {
  for (const bool tyre : {false, true}) {
    const RollingParams<double> p = rolling(sample_robot(), tyre);
    const auto uses = effects({"coulomb_friction.torque_Nm=0.002", "lateral_roller_friction.coefficient=0.05",
                               "rolling_resistance.coefficient=0.01"});
    RollingRobot<double> robot(p, uses, values_of(uses));
    RollingState<double> x =
        robot.start({.v_forward_m_s = 1.0, .v_left_m_s = -0.7, .omega_body_rad_s = 8.0}, {});
    RollingInput off;
    off.enabled.fill(false);
    double last = energy_J(p, x);
    for (int n = 0; n < 3000; ++n) {
      robot.advance(x, off, 1e-3);
      const double now = energy_J(p, x);
      ASSERT_LE(now, last * (1 + 1e-9)) << n << " ms, tyre " << tyre;
      last = now;
    }
    // and it holds: exactly at rest in the end, where the floor's hold does not creep
    if (!tyre) {
      for (std::size_t i = 0; i < kWheels; ++i) EXPECT_EQ(x.omega_rotor_rad_s(i), 0.0);
    }
  }
}

TEST(RollingRobot, DryFrictionHoldsItOnASlopeThatIsNotTooSteep) {
  const RollingParams<double> p = rolling(sample_robot(), false);
  // m g sin(angle) = 2.4 * 9.8 * 0.0175 = 0.41 N; four rotors hold 4 * 0.0025 * 3 / 0.027 = 1.1 N straight on
  for (const double angle_rad : {0.0175, 0.14}) {
    const auto uses =
        effects({"coulomb_friction.torque_Nm=0.0025", "floor_tilt.angle_rad=" + std::to_string(angle_rad)});
    RollingRobot<double> robot(p, uses, values_of(uses));
    RollingState<double> x = robot.start({}, {});
    for (int n = 0; n < 500; ++n) robot.advance(x, {}, 1e-3);
    const double speed = std::hypot(x.velocity[0], x.velocity[1]);
    EXPECT_EQ(speed < 1e-5, angle_rad < 0.1) << angle_rad << " rad: " << speed << " m/s";
  }
}

// How far rotors (share of the largest speed) and body (m/s, rad/s) are from the plant with its tyre, at
// steps so short that it is the truth.
struct FromPlant {
  double rotors = 0.0, body_m_s = 0.0, turn_rad_s = 0.0;
};

FromPlant from_plant(RobotModel m, const std::vector<std::string>& more) {
  auto uses = effects(more);
  if (!uses.empty()) m.effects = std::make_shared<const std::vector<EffectUse>>(uses);
  PlantOptions o;
  o.physics = Physics::kPlanar;
  o.mechanical_step_ns = 100'000;
  o.electrical_step_ns = 20'000;
  Plant plant(std::vector<RobotModel>{m}, o);
  const auto friction =
      effects({"coulomb_friction.torque_Nm=" + std::to_string(m.motor.coulomb_friction_Nm)});
  uses.insert(uses.begin(), friction.begin(), friction.end());
  RollingRobot<double> robot(rolling(m, true), uses, values_of(uses));
  RollingState<double> x = robot.start({}, {});
  double square = 0.0, body_square = 0.0, turn_square = 0.0, largest = 0.0;
  for (int ms = 0; ms < 3000; ++ms) {
    const auto duty = lively(ms);
    RobotDrive drive{};
    RollingInput in;
    in.duty_ratio = duty;
    for (std::size_t i = 0; i < kWheels; ++i) {
      drive.mode[i] = OMNIHIL_DRIVE_DUTY;
      drive.duty_ratio[i] = duty[i];
    }
    plant.write(0, drive);
    const RobotTruth before = plant.truth(0);
    plant.advance(1'000'000);
    const RobotTruth t = plant.truth(0);
    for (int n = 0; n < 20; ++n) {
      // the same places on the floor: a ripple is not to be compared at another phase
      PerWheel<double> theta{};
      for (std::size_t i = 0; i < kWheels; ++i) {
        const double from = before.theta_rotor_rad[i], to = t.theta_rotor_rad[i];
        theta[i] = from + (to - from) * n / 20.0;
      }
      in.theta_rotor_rad = &theta;
      robot.advance(x, in, 0.05e-3);
    }
    for (std::size_t i = 0; i < kWheels; ++i) {
      const double e = x.omega_rotor_rad_s(i) - t.omega_rotor_rad_s[i];
      square += e * e / (4.0 * 3000);
      largest = std::max(largest, std::abs(t.omega_rotor_rad_s[i]));
    }
    const double ex = x.velocity[0] - t.v_forward_m_s, ey = x.velocity[1] - t.v_left_m_s;
    body_square += (ex * ex + ey * ey) / 3000;
    const double turn = x.velocity[2] - t.omega_body_rad_s;
    turn_square += turn * turn / 3000;
  }
  return {std::sqrt(square) / largest, std::sqrt(body_square), std::sqrt(turn_square)};
}

TEST(RollingRobot, AgreesWithThePlantOnATyre) {
  const FromPlant apart = from_plant(sample_robot(), {});
  EXPECT_LT(apart.rotors, 1e-3);  // 0.1 % of the speeds there are
  EXPECT_LT(apart.body_m_s, 1e-3);
}

// A force of the floor on a wheel is one on the body as well.
TEST(RollingRobot, AgreesWithThePlantWhereRollersRipple) {
  const FromPlant apart = from_plant(frictionless_motor(sample_robot()), {"roller_ripple.fraction=0.1"});
  EXPECT_LT(apart.rotors, 1e-2);      // of 4e-2 that the ripple makes
  EXPECT_LT(apart.body_m_s, 2e-3);    // of 9e-3
  EXPECT_LT(apart.turn_rad_s, 0.02);  // the ripple turns it by 0.09 rad/s
}

// Root mean square of the rotors' speeds, each by 1 ms of turning, against steps ten times as short.
double off_by_steps_rad_s(const RollingParams<double>& p, const std::vector<EffectUse>& uses,
                          int steps_per_ms) {
  RollingRobot<double> coarse(p, uses, values_of(uses)), fine(p, uses, values_of(uses));
  RollingState<double> x = coarse.start({}, {}), y = fine.start({}, {});
  double square = 0.0;
  std::vector<PerWheel<double>> fine_rad(3001);
  drive(fine, y, 3000, 10 * steps_per_ms,
        [&](int ms) { fine_rad[static_cast<std::size_t>(ms)] = y.theta_rotor_rad; });
  PerWheel<double> before{};
  drive(coarse, x, 3000, steps_per_ms, [&](int ms) {
    const auto n = static_cast<std::size_t>(ms);
    for (std::size_t i = 0; i < kWheels; ++i) {
      const double e = (x.theta_rotor_rad[i] - before[i] - fine_rad[n][i] + fine_rad[n - 1][i]) / 1e-3;
      square += e * e / (4.0 * 3000);
    }
    before = x.theta_rotor_rad;
  });
  return std::sqrt(square);
}

// A sample period of 1 ms in steps as long as allowed, against ten times as many: a tenth of what an encoder
// of 4096 counts resolves there.
TEST(RollingRobot, StepsAsLongAsAllowedAreExactEnough) {
  const double noise_rad_s = 2.0 * std::numbers::pi / 4096 / 1e-3 / std::sqrt(6.0);  // of counts' differences
  for (const bool tyre : {false, true}) {
    const int steps = static_cast<int>(std::lround(1e-3 / (tyre ? kSlippingStep_s : kRollingStep_s)));
    EXPECT_LT(off_by_steps_rad_s(rolling(sample_robot(), tyre),
                                 effects({"coulomb_friction.torque_Nm=0.0025"}), steps),
              0.1 * noise_rad_s)
        << "tyre " << tyre;
  }
}

// Where nothing sticks and no load is transferred: half the step, a quarter of the error.
TEST(RollingRobot, IsOfOrderTwoOnATyre) {
  RollingParams<double> p = rolling(sample_robot(), true);
  p.has_lateral_tyre = false;  // its force is that of the step's start
  p.center_of_mass_height_m = 0.0;
  p.slip_speed_floor_m_s = 5.0;  // so that the slip's scale is constant
  const double whole = off_by_steps_rad_s(p, {}, 1), half = off_by_steps_rad_s(p, {}, 2);
  EXPECT_GT(whole / half, 3.5);
  EXPECT_LT(whole / half, 4.5);
}

// A wheel that a bench slides over the floor: the slip dies out, m dv/dt = -k s, by (6 - 2 z) / (6 + 4 z + z^2) a step.
TEST(RollingRobot, ASlipDiesOutByThePadeApproximant) {
  RollingParams<double> p = rolling(sample_robot(), true);
  p.wheels = 1;
  p.mass_kg = 0.6;
  p.has_lateral_tyre = false;
  p.drive.viscous_friction_Nm_s_per_rad = 0.0;
  p.drive.torque_constant_Nm_per_A = 1e-9;  // no back-EMF
  const double lever_m = p.wheel_radius_m / p.drive.gear_ratio;
  const double mass_kg = inertia_at_rotor(p.drive) / (lever_m * lever_m);
  const double k_N_s_per_m = 1.5 * p.longitudinal.extremum_value * p.mass_kg * kGravity_m_s2 /
                             (p.longitudinal.extremum_slip * p.slip_speed_floor_m_s);
  for (const double z : {0.1, 1.0, 20.0}) {
    const double h = z * mass_kg / k_N_s_per_m, slip_m_s = 1e-5;
    RollingRobot<double> robot(p, {}, {});
    RollingState<double> x = robot.start({}, {});
    const std::array<double, 3> still{};
    x.drive[0].omega_rotor_rad_s = slip_m_s / lever_m;
    x.force_N[0] = k_N_s_per_m * slip_m_s;
    x.slip_m_s[0] = -slip_m_s;
    robot.advance(x, {.imposed_velocity = &still}, h);
    EXPECT_NEAR(x.omega_rotor_rad_s(0) * lever_m / slip_m_s, (6 - 2 * z) / (6 + 4 * z + z * z), 1e-5) << z;
  }
}

}  // namespace
}  // namespace omnihil
