#include "sim/drive/needed_torque.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/sim/effects/bench.h"

namespace omnihil::test {
namespace {

TEST(NeededTorque, SolvesALawThatLooksAtItself) {
  // tau = 2 + |tau| / 2 -> 4; tau = -2 + |tau| / 2 -> -4/3; without the law: what it says
  EXPECT_NEAR(needed_torque(0.0, [](double t) { return 2.0 + 0.5 * std::abs(t); }), 4.0, 1e-12);
  EXPECT_NEAR(needed_torque(9.0, [](double t) { return -2.0 + 0.5 * std::abs(t); }), -4.0 / 3.0, 1e-12);
  EXPECT_NEAR(needed_torque(0.0, [](double) { return 0.7; }), 0.7, 1e-15);
  // a slope close to one, and a smooth law: cos(x) = x at 0.739085...
  EXPECT_NEAR(needed_torque(1.0, [](double t) { return 1.0 + 0.99 * t; }), 100.0, 1e-9);
  EXPECT_NEAR(needed_torque(0.0, [](double t) { return std::cos(t); }), 0.7390851332151607, 1e-12);
}

TEST(NeededTorque, HasTheDerivativeOfTheSolution) {
  // tau = a + k tau: dtau/da = 1 / (1 - k), dtau/dk = a / (1 - k)^2
  const Jet a(2.0, 0), k(0.6, 1);
  const Jet tau = needed_torque(Jet(0.0), [&](const Jet& t) { return Jet(a + k * t); });
  EXPECT_NEAR(tau.a, 5.0, 1e-12);
  EXPECT_NEAR(tau.v[0], 2.5, 1e-9);
  EXPECT_NEAR(tau.v[1], 2.0 / 0.16, 1e-9);
}

// A drive that speeds up at 200 rad/s2 and is given some torque that has nothing to do with that.
AxisInput speeding_up(double given_Nm, bool compared) {
  AxisInput in = held(CommandKind::kMotorTorque, given_Nm, 0.1);
  for (const double t : in.time_s) in.imposed_velocity_rad_s.push_back(10.0 + 200.0 * t);
  in.command_is_compared = compared;
  return in;
}

// What the model says the motor gave: the torque given and what lacks.
double needed_at(double given_Nm, bool compared, const EffectSet<double>& effects) {
  DriveParams<double> p = small_drive();
  p.viscous_friction_Nm_s_per_rad = 0.0;
  p.coulomb_friction_Nm = 3e-3;
  return given_Nm + run_axis(p, effects, speeding_up(given_Nm, compared)).back().load_torque_Nm;
}

constexpr double kInertia_kg_m2 = 2.925e-5;                   // of small_drive
constexpr double kMotion_Nm = kInertia_kg_m2 * 200.0 + 3e-3;  // J a + Coulomb: all that the motion takes

// Friction of 99 % of the motor's torque: the motion then takes a hundred times the torque, whatever was
// measured. With the measured torque as its argument it left 1 % of any residual.
TEST(NeededTorque, ALossIsOfTheTorqueThatTheMotionNeeds) {
  const auto loss = with({use_of("load_dependent_friction", {0.99, 0.0})});
  for (const double given : {-0.5, 0.0, 0.02, 0.7}) {
    EXPECT_NEAR(needed_at(given, true, loss), kMotion_Nm / 0.01, 1e-9) << given;
    EXPECT_NEAR(needed_at(given, false, loss), kMotion_Nm + 0.99 * std::abs(given), 1e-12) << given;
  }
}

TEST(NeededTorque, AGearsLossIsOfTheTorqueThatTheMotionNeeds) {
  const auto loss = with({use_of("gear_efficiency", {0.75})});
  // (1 - loss) tau = J a + Coulomb, and braking: tau (1 + loss / (1 - loss)) = J a + Coulomb
  EXPECT_NEAR(needed_at(0.4, true, loss), kMotion_Nm / 0.25, 1e-12);
  DriveParams<double> p = small_drive();
  p.viscous_friction_Nm_s_per_rad = 0.0;
  AxisInput in = held(CommandKind::kMotorTorque, 0.1, 0.1);
  for (const double t : in.time_s) in.imposed_velocity_rad_s.push_back(100.0 - 200.0 * t);
  in.command_is_compared = true;
  EXPECT_NEAR(0.1 + run_axis(p, loss, in).back().load_torque_Nm, -kInertia_kg_m2 * 200.0 / 4.0, 1e-12);
}

// Laws that do not look at the motor's torque need what they needed, with states or without.
TEST(NeededTorque, LeavesOtherLawsAlone) {
  for (const auto& effects : {with({use_of("stribeck_friction", {4e-3, 2.0})}),
                              with({use_of("lugre_friction", {4e-3, 2.0})}), nothing()}) {
    EXPECT_NEAR(needed_at(0.3, true, effects), needed_at(0.3, false, effects), 1e-14);
  }
}

}  // namespace
}  // namespace omnihil::test
