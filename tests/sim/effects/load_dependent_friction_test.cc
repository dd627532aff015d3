#include <gtest/gtest.h>

#include <cmath>

#include "tests/sim/effects/bench.h"

namespace omnihil::test {
namespace {

double level_at(double tau_motor_Nm, double tau_load_Nm, std::vector<double> params) {
  TorquePort<double> port;
  port.tau_motor_Nm = tau_motor_Nm;
  port.tau_load_Nm = tau_load_Nm;
  find_effect("load_dependent_friction")->simulate.torque(nullptr, params.data(), nullptr, port);
  return port.friction_positive_Nm;
}

TEST(LoadDependentFriction, AddsUpWhereMotorAndLoadOpposeEachOther) {
  EXPECT_NEAR(level_at(0.05, -0.04, {0.08, 0.06}), 0.08 * 0.05 + 0.06 * 0.04, 1e-15);
  EXPECT_NEAR(level_at(0.05, 0.04, {0.08, 0.06}), 0.08 * 0.05 - 0.06 * 0.04, 1e-15);
  EXPECT_NEAR(level_at(-0.05, 0.04, {0.08, 0.06}), level_at(0.05, -0.04, {0.08, 0.06}), 1e-15);
}

TEST(LoadDependentFriction, VanishesWithoutLoad) {
  EXPECT_EQ(level_at(0.0, 0.0, {0.3, 0.3}), 0.0);
  const AxisInput in = held(CommandKind::kDuty, 0.0, 0.1);
  EXPECT_EQ(run_axis(small_drive(), with({use_of("load_dependent_friction", {0.3, 0.3})}), in)
                .back()
                .omega_rotor_rad_s,
            0.0);
}

// A load of any size cannot turn a motor whose gear takes all of it, and can where the fraction is less.
TEST(LoadDependentFriction, LocksAgainstTheLoadAtAFractionOfOne) {
  for (const double load : {0.001, 0.1, 10.0}) {
    AxisInput in = held(CommandKind::kMotorTorque, 0.0, 0.05);
    in.load_torque_Nm.assign(in.time_s.size(), load);
    EXPECT_TRUE(
        run_axis(small_drive(), with({use_of("load_dependent_friction", {0.0, 1.0})}), in).back().held);
    EXPECT_FALSE(
        run_axis(small_drive(), with({use_of("load_dependent_friction", {0.0, 0.99})}), in).back().held);
  }
}

TEST(LoadDependentFriction, SeesLoadsThatOtherEffectsBring) {
  DriveParams<double> p = small_drive();
  p.gear_ratio = 3.0;
  const auto effects = with({use_of("constant_load", {0.06}), use_of("load_dependent_friction", {0.0, 0.1})});
  AxisInput in = held(CommandKind::kMotorCurrent, 0.0, 0.1);
  in.imposed_velocity_rad_s.assign(in.time_s.size(), -5.0);
  // at the output: the load itself, a tenth of it as friction, and viscous friction
  EXPECT_NEAR(run_axis(p, effects, in).back().load_torque_Nm,
              -0.06 - 0.006 - 9.0 * p.viscous_friction_Nm_s_per_rad * 5.0, 1e-12);
}

// Both fractions are unknowns at neutral, each with the derivative of its own.
TEST(LoadDependentFriction, HasTheDerivativeOfEachFractionAloneAtNeutral) {
  const std::vector<Jet> p{Jet(0.0, 0), Jet(0.0, 1)};
  TorquePort<Jet> port;
  port.tau_motor_Nm = Jet(-0.05);
  port.tau_load_Nm = Jet(0.02);
  find_effect("load_dependent_friction")->differentiate.torque(nullptr, p.data(), nullptr, port);
  EXPECT_EQ(port.friction_positive_Nm.a, 0.0);
  EXPECT_DOUBLE_EQ(port.friction_positive_Nm.v[0], 0.05);
  EXPECT_DOUBLE_EQ(port.friction_positive_Nm.v[1], 0.02);
}

// Signature: at one steady speed the friction grows in proportion to the load, with the direction's sign.
TEST(LoadDependentFriction, ShowsAsFrictionInProportionToTheLoad) {
  const DriveParams<double> p = small_drive();
  const auto effects = with({use_of("load_dependent_friction", {0.08, 0.06})});
  for (const double sign : {1.0, -1.0}) {
    for (const double load : {0.01, 0.03, 0.05}) {
      AxisInput in = held(CommandKind::kDuty, 0.6 * sign, 3.0);
      in.load_torque_Nm.assign(in.time_s.size(), -load * sign);
      const auto out = run_axis(p, effects, in).back();
      const double motor = p.torque_constant_Nm_per_A * out.motor_current_A * sign;
      const double friction = motor - load - p.viscous_friction_Nm_s_per_rad * out.omega_rotor_rad_s * sign;
      EXPECT_NEAR(friction, 0.08 * motor + 0.06 * load, 1e-9);
    }
  }
}

}  // namespace
}  // namespace omnihil::test
