#include "sim/drive/drive_sim.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "tests/sim/effects/bench.h"

namespace omnihil::test {
namespace {

DriveInput<double> duty(double value) { return {.kind = CommandKind::kDuty, .setpoint = value}; }

// Settled: k i = b omega, u = R i + k omega  =>  omega = u / (k + R b / k)
TEST(DriveSim, SettlesWhereTorqueBalancesFriction) {
  const DriveParams<double> p = small_drive();
  const DriveSim<double> sim(p, nothing(), 50e-6);
  auto state = sim.initial_state();
  sim.advance(state, duty(0.5), 40000);
  const double u = 0.5 * p.supply_voltage_V, k = p.torque_constant_Nm_per_A;
  EXPECT_NEAR(state.omega_rotor_rad_s, u / (k + p.resistance_ohm * p.viscous_friction_Nm_s_per_rad / k),
              1e-9);
  EXPECT_NEAR(state.current_A, p.viscous_friction_Nm_s_per_rad * state.omega_rotor_rad_s / k, 1e-12);
}

// A locked rotor: i = u/R (1 - exp(-R t / L)), exactly at every sub-step.
TEST(DriveSim, FollowsTheExponentialOfALockedWinding) {
  DriveParams<double> p = small_drive();
  p.coulomb_friction_Nm = 10.0;
  const DriveSim<double> sim(p, nothing(), 50e-6);
  auto state = sim.initial_state();
  for (int n = 1; n <= 40; ++n) {
    const auto r = sim.advance(state, duty(0.3), 1);
    EXPECT_TRUE(r.held);
    const double t = n * 50e-6;
    EXPECT_NEAR(state.current_A, 3.0 * (1.0 - std::exp(-1.2 * t / 5.6e-4)), 1e-12);
  }
  EXPECT_EQ(state.omega_rotor_rad_s, 0.0);
}

TEST(DriveSim, HoldsBelowTheFrictionLevelAndStartsAboveIt) {
  DriveParams<double> p = small_drive();
  p.coulomb_friction_Nm = 0.02;
  const DriveSim<double> sim(p, nothing(), 50e-6);
  const double holding_duty = 0.02 / p.torque_constant_Nm_per_A * p.resistance_ohm / p.supply_voltage_V;
  auto state = sim.initial_state();
  EXPECT_TRUE(sim.advance(state, duty(0.999 * holding_duty), 4000).held);
  EXPECT_EQ(state.theta_rotor_rad, 0.0);
  EXPECT_FALSE(sim.advance(state, duty(1.001 * holding_duty), 4000).held);
  EXPECT_GT(state.theta_rotor_rad, 0.0);
}

// Free run against dry friction alone: stops after J w / c seconds, having turned J w^2 / (2 c).
TEST(DriveSim, StopsWhereDryFrictionTakesTheLastEnergy) {
  DriveParams<double> p = small_drive();
  p.viscous_friction_Nm_s_per_rad = 0.0;
  const double c = 0.003, w = 50.0;
  const DriveSim<double> sim(p, with({use_of("coulomb_friction", {c})}), 50e-6);
  auto state = sim.initial_state();
  state.omega_rotor_rad_s = w;
  const double j = inertia_at_rotor(p), stop_s = j * w / c;
  DriveInput<double> torque{.kind = CommandKind::kMotorTorque};
  const int most = static_cast<int>(0.9 * stop_s / 50e-6);
  sim.advance(state, torque, most);
  EXPECT_NEAR(state.omega_rotor_rad_s, w - c / j * most * 50e-6, 1e-9);
  sim.advance(state, torque, static_cast<int>(0.2 * stop_s / 50e-6));
  EXPECT_EQ(state.omega_rotor_rad_s, 0.0);
  EXPECT_NEAR(state.theta_rotor_rad, j * w * w / (2.0 * c), 1e-9);
}

TEST(DriveSim, ClosesTheEnergyBalanceToRounding) {
  for (const bool effects : {false, true}) {
    const DriveParams<double> p = small_drive();
    const DriveSim<double> sim(p, effects ? with({use_of("cogging", {0.004})}) : nothing(), 50e-6);
    auto state = sim.initial_state();
    double electrical = 0, heat = 0, viscous = 0, cogging = 0;
    for (int n = 0; n < 4000; ++n) {
      const auto before = state;
      const auto r = sim.advance(state, duty(n < 2000 ? 0.8 : -0.3), 1);
      electrical += r.electrical_energy_J;
      heat += r.heat_J;
      const double mean = 0.5 * (before.omega_rotor_rad_s + state.omega_rotor_rad_s);
      viscous += p.viscous_friction_Nm_s_per_rad * mean * mean * 50e-6;
      // What the shaft got besides viscous loss and the winding: J dw/dt + b w - k i, times w.
      const double rest = r.mean_shaft_torque_Nm + p.viscous_friction_Nm_s_per_rad * mean -
                          p.torque_constant_Nm_per_A * r.mean_current_A;
      cogging += rest * mean * 50e-6;
    }
    const double w = state.omega_rotor_rad_s, i = state.current_A;
    const double stored = 0.5 * inertia_at_rotor(p) * w * w + 0.5 * p.inductance_H * i * i;
    EXPECT_NEAR(electrical, heat + viscous + stored - cogging, 1e-9 * electrical);
    if (!effects) {
      EXPECT_NEAR(cogging, 0.0, 1e-9 * electrical);
    }
  }
}

double end_speed(const EffectSet<double>& effects, double step_s) {
  const DriveSim<double> sim(small_drive(), effects, step_s);
  auto state = sim.initial_state();
  state.theta_rotor_rad = 0.01;
  sim.advance(state, duty(0.8), static_cast<int>(0.02 / step_s + 0.5));
  return state.omega_rotor_rad_s;
}

// Halving the sub-step quarters the error: second order, with effects that depend on angle and speed too.
TEST(DriveSim, IsOfSecondOrderInTheSubStep) {
  for (const auto& effects : {nothing(), with({use_of("cogging", {0.004, 24, 0.3})})}) {
    const double h = 50e-6;
    const double e1 = end_speed(effects, h) - end_speed(effects, h / 2);
    const double e2 = end_speed(effects, h / 2) - end_speed(effects, h / 4);
    const double e3 = end_speed(effects, h / 4) - end_speed(effects, h / 8);
    EXPECT_NEAR(e1 / e2, 4.0, 0.5);
    EXPECT_NEAR(e2 / e3, 4.0, 0.5);
  }
}

TEST(DriveSim, RunsTheSameWithAndWithoutTheShortPath) {
  const DriveParams<double> p = small_drive();
  // A torque of exactly zero effect that keeps the general path: cogging whose order turns it into a constant
  // zero.
  const DriveSim<double> plain(p, nothing(), 50e-6), general(p, with({use_of("cogging", {1e-300})}), 50e-6);
  auto a = plain.initial_state(), b = general.initial_state();
  for (int n = 0; n < 200; ++n) {
    const double value = std::sin(0.1 * n);
    const auto ra = plain.advance(a, duty(value), 20), rb = general.advance(b, duty(value), 20);
    EXPECT_NEAR(a.omega_rotor_rad_s, b.omega_rotor_rad_s, 1e-9);
    EXPECT_NEAR(a.current_A, b.current_A, 1e-10);
    EXPECT_NEAR(ra.mean_current_A, rb.mean_current_A, 1e-10);
    EXPECT_NEAR(ra.mean_shaft_torque_Nm, rb.mean_shaft_torque_Nm, 1e-10);
    EXPECT_NEAR(ra.heat_J, rb.heat_J, 1e-12);
  }
}

TEST(DriveSim, GivesBackTheTorqueThatABenchNeedsToTurnIt) {
  DriveParams<double> p = small_drive();
  p.coulomb_friction_Nm = 0.002;
  const DriveSim<double> sim(p, nothing(), 50e-6);
  auto state = sim.initial_state();
  DriveInput<double> in{.kind = CommandKind::kMotorCurrent};
  in.speed_is_imposed = true;
  in.imposed_start_rad_s = 10.0;
  in.imposed_end_rad_s = 11.0;  // in 1 ms
  const auto r = sim.advance(state, in, 20);
  // tau = J dw/dt + b w + c
  EXPECT_NEAR(r.mean_outside_torque_Nm,
              inertia_at_rotor(p) * 1000.0 + p.viscous_friction_Nm_s_per_rad * 10.5 + 0.002, 1e-12);
  EXPECT_NEAR(state.theta_rotor_rad, 10.5e-3, 1e-12);
}

TEST(DriveSim, NeverExceedsTheCurrentLimitAtASubStepsEnd) {
  DriveParams<double> p = small_drive();
  p.current_limit_A = 2.0;
  const DriveSim<double> sim(p, nothing(), 50e-6);
  auto state = sim.initial_state();
  double most = 0.0;
  for (int n = 0; n < 4000; ++n) {
    sim.advance(state, duty(n < 2000 ? 1.0 : 0.5), 1);
    most = std::max(most, std::abs(state.current_A));
  }
  EXPECT_LE(most, 2.0 + 1e-12);
  EXPECT_GT(most, 1.999);
}

TEST(DriveSim, LetsTheCurrentDieWhenReleasedAndThenCoasts) {
  DriveParams<double> p = small_drive();
  p.viscous_friction_Nm_s_per_rad = 0.0;
  const DriveSim<double> sim(p, nothing(), 50e-6);
  auto state = sim.initial_state();
  sim.advance(state, duty(0.5), 200);
  ASSERT_GT(state.current_A, 0.5);
  DriveInput<double> off = duty(0.5);
  off.enabled = false;
  sim.advance(state, off, 20);
  EXPECT_EQ(state.current_A, 0.0);
  const double speed = state.omega_rotor_rad_s;
  sim.advance(state, off, 2000);
  EXPECT_EQ(state.omega_rotor_rad_s, speed);
}

// d/dL at L = 0 of speed, angle and drawn energy against 2 d(L) - d(2 L), d the difference over L.
TEST(DriveSim, HasTheDerivativeOfAnInductanceOfZero) {
  for (const bool effects : {false, true}) {
    const std::vector<EffectUse> uses =
        effects ? std::vector<EffectUse>{use_of("winding_heating", {0.004, 4.0, 3.0})}
                : std::vector<EffectUse>{};
    const auto run = [&](auto inductance) {
      using T = decltype(inductance);
      DriveParams<T> p = drive_params_as<T>(small_drive());
      p.inductance_H = inductance;
      const DriveSim<T> sim(p, EffectSet<T>(uses), 50e-6);
      auto state = sim.initial_state();
      T energy = T(0);
      for (const double value : {0.6, -0.2, 0.4}) {
        energy +=
            sim.advance(state, {.kind = CommandKind::kDuty, .setpoint = T(value)}, 20).electrical_energy_J;
      }
      return std::array<T, 3>{state.omega_rotor_rad_s, state.theta_rotor_rad, energy};
    };
    const double small = 1e-9;
    const auto at = run(0.0), once = run(small), twice = run(2.0 * small);
    const auto jet = run(Jet(0.0, 0));
    for (std::size_t n = 0; n < at.size(); ++n) {
      const double expected = 2.0 * (once[n] - at[n]) / small - (twice[n] - at[n]) / (2.0 * small);
      EXPECT_NE(expected, 0.0);
      EXPECT_NEAR(jet[n].v[0], expected, 1e-4 * std::abs(expected)) << n;
      EXPECT_NEAR(jet[n].a, at[n], 1e-12 * std::abs(at[n]));
    }
  }
}

}  // namespace
}  // namespace omnihil::test
