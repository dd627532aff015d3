#include "sim/robot/contact.h"

#include <gtest/gtest.h>

#include <numeric>

#include "sim/robot/planar_law.h"
#include "tests/sim/robot/sample_robot.h"

namespace omnihil {
namespace {

// A number with its derivative: what a fit needs the laws to work with.
struct Dual {
  double value = 0.0, slope = 0.0;
  Dual() = default;
  Dual(double v) : value(v) {}  // NOLINT: numbers convert
  Dual(double v, double s) : value(v), slope(s) {}
  Dual& operator+=(const Dual& b) { return *this = {value + b.value, slope + b.slope}; }
  Dual& operator-=(const Dual& b) { return *this = {value - b.value, slope - b.slope}; }
  friend Dual operator+(Dual a, const Dual& b) { return a += b; }
  friend Dual operator-(Dual a, const Dual& b) { return a -= b; }
  friend Dual operator-(const Dual& a) { return {-a.value, -a.slope}; }
  friend Dual operator*(const Dual& a, const Dual& b) {
    return {a.value * b.value, a.slope * b.value + a.value * b.slope};
  }
  friend Dual operator/(const Dual& a, const Dual& b) {
    return {a.value / b.value, (a.slope * b.value - a.value * b.slope) / (b.value * b.value)};
  }
  friend bool operator<(const Dual& a, const Dual& b) { return a.value < b.value; }
  friend bool operator<=(const Dual& a, const Dual& b) { return a.value <= b.value; }
};

ContactLaw<Dual> dual_law(const ContactLaw<double>& d) {
  ContactLaw<Dual> law;
  for (std::size_t i = 0; i < kWheels; ++i) {
    law.geometry.cos_angle[i] = d.geometry.cos_angle[i];
    law.geometry.sin_angle[i] = d.geometry.sin_angle[i];
    law.load.at_rest_N[i] = d.load.at_rest_N[i];
    law.load.per_force_x_ratio[i] = d.load.per_force_x_ratio[i];
    law.load.per_force_y_ratio[i] = d.load.per_force_y_ratio[i];
  }
  law.geometry.wheel_center_radius_m = d.geometry.wheel_center_radius_m;
  law.geometry.wheel_radius_m = d.geometry.wheel_radius_m;
  law.longitudinal = d.longitudinal;
  law.lateral = d.lateral;
  law.slip_speed_floor_m_s = d.slip_speed_floor_m_s;
  return law;
}

double sum(const PerWheel<double>& x) { return std::accumulate(x.begin(), x.end(), 0.0); }

WheelContacts<double> skidding(const RobotModel& m) {  // wheels spun up, robot at rest
  const ContactLaw<double> law = contact_law(m);
  const auto omega = wheel_speeds<double>(law.geometry, {1.5, 0.5, 1.0});
  return contact_forces(law, wheel_motion<double>(law, {}, omega));
}

TEST(WheelLoad, SumsToTheWeightAtRest) {
  const RobotModel m = sample_robot();
  const double weight_N = m.mass_kg * 9.80665;
  EXPECT_NEAR(sum(contact_law(m).load.at_rest_N), weight_N, 1e-9 * weight_N);
}

TEST(WheelLoad, IsAQuarterEachForASquareRobot) {
  RobotModel m = symmetric_robot();
  m.wheel_angle_rad = {45 * kDegree, 135 * kDegree, 225 * kDegree, 315 * kDegree};
  const ContactLaw<double> law = contact_law(m);
  for (std::size_t i = 0; i < kWheels; ++i) EXPECT_NEAR(law.load.at_rest_N[i], 2.4 * 9.80665 / 4, 1e-12);
}

TEST(WheelLoad, BalancesTheMomentsOfAnOffsetCentreOfMass) {
  const RobotModel m = sample_robot();
  const auto law = contact_law(m);
  double moment_x = 0.0, moment_y = 0.0;
  for (std::size_t i = 0; i < kWheels; ++i) {
    moment_x += law.load.at_rest_N[i] * m.wheel_center_radius_m * law.geometry.cos_angle[i];
    moment_y += law.load.at_rest_N[i] * m.wheel_center_radius_m * law.geometry.sin_angle[i];
  }
  const double weight_N = m.mass_kg * 9.80665;
  EXPECT_NEAR(moment_x, weight_N * m.center_of_mass_x_m, 1e-12);
  EXPECT_NEAR(moment_y, weight_N * m.center_of_mass_y_m, 1e-12);
}

TEST(WheelLoad, MovesToTheRearByHeightTimesForceAndKeepsItsSum) {
  const RobotModel m = sample_robot();
  const auto c = skidding(m);
  const auto law = contact_law(m);
  double moment_x = 0.0;
  for (std::size_t i = 0; i < kWheels; ++i) {
    moment_x += c.load_N[i] * m.wheel_center_radius_m * law.geometry.cos_angle[i];
  }
  ASSERT_GT(c.force_x_N, 5.0);
  // sum N x = m g c_x - h F_x
  const double weight_N = m.mass_kg * 9.80665;
  EXPECT_NEAR(moment_x, weight_N * m.center_of_mass_x_m - m.center_of_mass_height_m * c.force_x_N, 1e-12);
  EXPECT_NEAR(sum(c.load_N), weight_N, 1e-9 * weight_N);
}

TEST(WheelLoad, NeverFallsBelowZeroAndKeepsItsSumWhenAWheelWouldLift) {
  RobotModel m = sample_robot();
  m.center_of_mass_height_m = 0.15;
  const auto c = skidding(m);
  double least_N = 1e9;
  for (std::size_t i = 0; i < kWheels; ++i) least_N = std::min(least_N, c.load_N[i]);
  EXPECT_NEAR(least_N, 0.0, 1e-12);
  EXPECT_NEAR(sum(c.load_N), m.mass_kg * 9.80665, 1e-9);
}

TEST(Contact, ForceIsGripTimesLoadAgainstTheSlip) {
  const RobotModel m = sample_robot();
  const auto c = skidding(m);
  for (std::size_t i = 0; i < kWheels; ++i) {
    const double expected_N = -grip(m.tyre_longitudinal, c.slip_longitudinal_ratio[i]) * c.load_N[i];
    EXPECT_NEAR(c.force_longitudinal_N[i], expected_N, 1e-12);
    EXPECT_LE(c.force_longitudinal_N[i] * c.slip_longitudinal_ratio[i], 0.0);
    // F_max = F_ext * S with S = load
    EXPECT_LE(std::abs(c.force_longitudinal_N[i]),
              m.tyre_longitudinal.extremum_value * c.load_N[i] * (1 + 1e-12));
  }
}

TEST(Contact, RollingWithoutSlipLeavesTheRollersDragAlone) {
  const RobotModel m = sample_robot();
  const auto law = contact_law(m);
  const BodyVelocity<double> v{2.0, 0.3, 1.0};
  const auto c = contact_forces(law, wheel_motion(law, v, wheel_speeds(law.geometry, v)));
  for (std::size_t i = 0; i < kWheels; ++i) {
    EXPECT_NEAR(c.force_longitudinal_N[i], 0.0, 1e-12);
    const double roller = roller_speed_m_s(law.geometry, i, v);
    ASSERT_GT(std::abs(roller), m.slip_speed_floor_m_s);
    EXPECT_NEAR(c.force_lateral_N[i], -std::copysign(m.tyre_lateral.extremum_value * c.load_N[i], roller),
                1e-12);
  }
}

TEST(Contact, AtRestThereIsNoForceAtAll) {
  const auto law = contact_law(sample_robot());
  const auto c = contact_forces(law, wheel_motion<double>(law, {}, {}));
  EXPECT_EQ(c.force_x_N, 0.0);
  EXPECT_EQ(c.force_y_N, 0.0);
  EXPECT_EQ(c.moment_z_Nm, 0.0);
}

TEST(Contact, DerivativesOfTheLawAreItsDifferences) {
  const auto law = contact_law(sample_robot());
  const auto dual = dual_law(law);
  const BodyVelocity<double> v{1.0, 0.2, 0.5};
  auto omega = wheel_speeds(law.geometry, v);
  for (double& w : omega) w *= 1.03;
  const auto force_at = [&](double v_forward) {
    return contact_forces(law, wheel_motion<double>(law, {v_forward, 0.2, 0.5}, omega)).force_x_N;
  };
  const BodyVelocity<Dual> v_dual{Dual(1.0, 1.0), 0.2, 0.5};
  PerWheel<Dual> omega_dual{};
  for (std::size_t i = 0; i < kWheels; ++i) omega_dual[i] = omega[i];
  const auto c = contact_forces(dual, wheel_motion(dual, v_dual, omega_dual));
  EXPECT_NEAR(c.force_x_N.value, force_at(1.0), 1e-12);
  EXPECT_NEAR(c.force_x_N.slope, (force_at(1.0 + 1e-6) - force_at(1.0 - 1e-6)) / 2e-6, 1e-4);
}

TEST(PlanarLaw, AccelerationsSatisfyNewtonAndEulerAboutTheCentreOfMass) {
  const RobotModel m = sample_robot();
  const auto b = planar_body(m);
  const double fx = 3.0, fy = -1.0, moment = 0.2, w = 4.0;
  const auto a = body_acceleration(b, fx, fy, moment, w);
  const double cx = m.center_of_mass_x_m, cy = m.center_of_mass_y_m;
  // a_cm = a + alpha x c - w^2 c
  EXPECT_NEAR(m.mass_kg * (a.x_m_s2 - a.yaw_rad_s2 * cy - w * w * cx), fx, 1e-12);
  EXPECT_NEAR(m.mass_kg * (a.y_m_s2 + a.yaw_rad_s2 * cx - w * w * cy), fy, 1e-12);
  const double inertia_cm = m.yaw_inertia_kg_m2 - m.mass_kg * (cx * cx + cy * cy);
  EXPECT_NEAR(inertia_cm * a.yaw_rad_s2, moment - (cx * fy - cy * fx), 1e-12);
}

}  // namespace
}  // namespace omnihil
