// The properties that MuJoCo's tests ask of its DC motor, asked of this drive. Expected values by hand.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/sim/effects/bench.h"

namespace omnihil::test {
namespace {

DriveInput<double> turned(double speed_rad_s, CommandKind kind, double setpoint) {
  DriveInput<double> in{.kind = kind, .setpoint = setpoint};
  in.speed_is_imposed = true;
  in.imposed_start_rad_s = in.imposed_end_rad_s = speed_rad_s;
  return in;
}

DriveParams<double> frictionless() {
  DriveParams<double> p = small_drive();
  p.viscous_friction_Nm_s_per_rad = 0.0;
  return p;
}

// Without inductance the torque is K / R (V - K omega) at once.
TEST(DcMotorList, StatelessSteadyState) {
  DriveParams<double> p = frictionless();
  p.inductance_H = 0.0;
  const double k = p.torque_constant_Nm_per_A, r = p.resistance_ohm;
  const DriveSim<double> sim(p, nothing(), 50e-6);
  for (const double omega : {-200.0, 0.0, 50.0, 400.0}) {
    for (const double volts : {-12.0, 3.0, 12.0}) {
      auto state = sim.initial_state();
      const auto out = sim.advance(state, turned(omega, CommandKind::kMotorVoltage, volts), 1);
      EXPECT_NEAR(-out.mean_outside_torque_Nm, k / r * (volts - k * omega), 1e-12);
    }
  }
}

// With inductance the current is the exponential exactly, whatever the sub-step.
TEST(DcMotorList, CurrentFilterExactIntegration) {
  const DriveParams<double> p = frictionless();
  const double settled = (6.0 - p.torque_constant_Nm_per_A * 100.0) / p.resistance_ohm;
  for (const double h : {1e-5, 50e-6, 1e-3, 5e-3}) {
    const DriveSim<double> sim(p, nothing(), h);
    auto state = sim.initial_state();
    for (int n = 1; n <= 20; ++n) {
      sim.advance(state, turned(100.0, CommandKind::kMotorVoltage, 6.0), 1);
      EXPECT_NEAR(state.current_A, settled * (1.0 - std::exp(-p.resistance_ohm * n * h / p.inductance_H)),
                  1e-11);
    }
  }
}

// Cogging is its sine at every angle, and zero in the mean over a turn.
TEST(DcMotorList, CoggingTorque) {
  const auto effects = with({use_of("cogging", {0.004, 48, 0.3})});
  const int parts = 4800;
  const double turn_s = 1.0, h = turn_s / parts;
  const DriveSim<double> sim(frictionless(), effects, h);
  auto state = sim.initial_state();
  double sum = 0.0;
  for (int n = 0; n < parts; ++n) {
    const auto out = sim.advance(state, turned(2.0 * std::numbers::pi, CommandKind::kMotorCurrent, 0.0), 1);
    // mean of the sine over the sub-step, by its integral
    const double a = 48 * 2.0 * std::numbers::pi * n / parts + 0.3,
                 b = a + 48 * 2.0 * std::numbers::pi / parts;
    EXPECT_NEAR(-out.mean_outside_torque_Nm, 0.004 * (std::cos(a) - std::cos(b)) / (b - a), 1e-12);
    sum += out.mean_outside_torque_Nm;
  }
  EXPECT_NEAR(sum / parts, 0.0, 1e-12);
}

// Limits of current and duty limit the motor's torque; cogging comes on top.
TEST(DcMotorList, CoggingBypassesSaturation) {
  DriveParams<double> p = frictionless();
  p.current_limit_A = 1.0;
  p.duty_limit_ratio = 0.5;
  EffectUse cogging = use_of("cogging", {0.01, 48, std::numbers::pi / 2});  // full at angle zero
  AxisInput in = held(CommandKind::kDuty, 1.0, 0.1);
  in.imposed_velocity_rad_s.assign(in.time_s.size(), 0.0);
  const auto without = run_axis(p, nothing(), in).back();
  const auto with_it = run_axis(p, with({cogging}), in).back();
  EXPECT_NEAR(-without.load_torque_Nm, p.torque_constant_Nm_per_A * 1.0, 1e-9);  // limited
  EXPECT_NEAR(-with_it.load_torque_Nm, p.torque_constant_Nm_per_A * 1.0 + 0.01, 1e-9);
}

// Sliding at a steady speed LuGre friction is g(omega) against the motion.
TEST(DcMotorList, LuGreSteadyState) {
  const double c = 0.004, s = 0.006, speed_scale = 2.0;
  const auto effects = with({use_of("lugre_friction", {c, s, speed_scale, 10.0, 0.01})});
  const DriveSim<double> sim(frictionless(), effects, 50e-6);
  for (const double omega : {0.5, -2.0, 30.0}) {
    auto state = sim.initial_state();
    sim.advance(state, turned(omega, CommandKind::kMotorCurrent, 0.0), 20000);
    const auto out = sim.advance(state, turned(omega, CommandKind::kMotorCurrent, 0.0), 1);
    const double ratio = omega / speed_scale;
    EXPECT_NEAR(out.mean_outside_torque_Nm, std::copysign(c + (s - c) * std::exp(-ratio * ratio), omega),
                1e-12);
  }
}

// A small torque bends the bristles like a spring: theta = tau / s0, and let go it springs back.
TEST(DcMotorList, LuGreBristleSpring) {
  const double stiffness = 10.0, level = 1.0, torque = 0.001;
  const auto effects = with({use_of("lugre_friction", {level, level, 5.0, stiffness, 0.02})});
  const DriveSim<double> sim(frictionless(), effects, 50e-6);
  auto state = sim.initial_state();
  sim.advance(state, {.kind = CommandKind::kMotorTorque, .setpoint = torque}, 40000);
  // s0 theta = -g ln(1 - tau / g): a spring to a thousandth
  EXPECT_NEAR(state.theta_rotor_rad, torque / stiffness, 1e-3 * torque / stiffness);
  EXPECT_NEAR(state.omega_rotor_rad_s, 0.0, 1e-9);
  sim.advance(state, {.kind = CommandKind::kMotorTorque}, 40000);
  // but for the hysteresis (tau / g)^2 g / s0
  EXPECT_NEAR(state.theta_rotor_rad, 0.0, 2e-3 * torque / stiffness);
}

// T = R i^2 R_th, at which the resistance has grown by a T: with current imposed T = P R_th / (1 - a P R_th).
TEST(DcMotorList, ThermalSteadyState) {
  const double a = 0.00393, rth = 8.0, i = 1.5;
  DriveParams<double> p = frictionless();
  p.coulomb_friction_Nm = 1.0;
  const auto out = run_axis(p, with({use_of("winding_heating", {a, rth, 0.5, 0.0, 50.0})}),
                            held(CommandKind::kMotorCurrent, i, 100.0, 20.0));
  const double cold = p.resistance_ohm * i * i * rth;
  EXPECT_NEAR(out.back().winding_rise_K, cold / (1.0 - a * cold), 1e-6);
}

// At a held voltage and a locked rotor the torque falls to k V / (R (1 + a T)), T = V^2 R_th / (R (1 + a T)).
TEST(DcMotorList, ThermalAffectsForce) {
  const double a = 0.00393, rth = 8.0, volts = 3.0;
  DriveParams<double> p = frictionless();
  AxisInput in = held(CommandKind::kMotorVoltage, volts, 100.0, 20.0);
  in.imposed_velocity_rad_s.assign(in.time_s.size(), 0.0);
  const auto out = run_axis(p, with({use_of("winding_heating", {a, rth, 0.5, 0.0, 50.0})}), in);
  // a T^2 + T - V^2 R_th / R = 0
  const double heat = volts * volts * rth / p.resistance_ohm;
  const double rise = (std::sqrt(1.0 + 4.0 * a * heat) - 1.0) / (2.0 * a);
  EXPECT_NEAR(out.back().winding_rise_K, rise, 1e-5);
  EXPECT_NEAR(-out.back().load_torque_Nm,
              p.torque_constant_Nm_per_A * volts / (p.resistance_ohm * (1.0 + a * rise)), 1e-9);
  EXPECT_NEAR(-out[1].load_torque_Nm, p.torque_constant_Nm_per_A * volts / p.resistance_ohm,
              0.02 * p.torque_constant_Nm_per_A * volts / p.resistance_ohm);
}

// Whatever duty is asked, the winding gets no more than the bus, or the limit's share of it.
TEST(DcMotorList, VoltageLimit) {
  DriveParams<double> p = frictionless();
  for (const double limit : {1.0, 0.6}) {
    p.duty_limit_ratio = limit;
    const DriveSim<double> sim(p, nothing(), 50e-6);
    for (const double duty : {3.0, -3.0}) {
      auto state = sim.initial_state();
      const auto out = sim.advance(state, turned(0.0, CommandKind::kDuty, duty), 20000);
      EXPECT_NEAR(out.mean_voltage_V, std::copysign(limit * 12.0, duty), 1e-9);
      EXPECT_NEAR(state.current_A, std::copysign(limit * 12.0 / p.resistance_ohm, duty), 1e-9);
    }
  }
}

}  // namespace
}  // namespace omnihil::test
