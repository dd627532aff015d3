#include <gtest/gtest.h>

#include <cmath>

#include "tests/sim/effects/bench.h"

namespace omnihil::test {
namespace {

constexpr double kCoulomb = 0.003, kStatic = 0.0045, kSpeed = 5.0, kStiffness = 3.0, kDamping = 0.01;

EffectSet<double> bristles() {
  return with({use_of("lugre_friction", {kCoulomb, kStatic, kSpeed, kStiffness, kDamping})});
}

// Turned at a held speed, slid far past breakaway: tau = c + (s - c) exp(-(w / w_s)^2).
TEST(LugreFriction, SlidesWithTheStribeckCurve) {
  const DriveParams<double> p = small_drive();
  for (const double speed : {0.5, -3.0, 6.0, -20.0}) {
    AxisInput in = held(CommandKind::kMotorCurrent, 0.0, 0.5);
    in.imposed_velocity_rad_s.assign(in.time_s.size(), speed);
    const double level = kCoulomb + (kStatic - kCoulomb) * std::exp(-speed * speed / (kSpeed * kSpeed));
    EXPECT_NEAR(run_axis(p, bristles(), in).back().load_torque_Nm,
                std::copysign(level, speed) + p.viscous_friction_Nm_s_per_rad * speed, 1e-9);
  }
}

// Turned from rest by an angle x: s0 z = g (1 - exp(-s0 x / g)), in the limit of small x the spring s0 x.
TEST(LugreFriction, BendsLikeASpringBeforeItSlides) {
  const double speed = 0.01;
  AxisInput in = held(CommandKind::kMotorCurrent, 0.0, 0.2);
  in.imposed_velocity_rad_s.assign(in.time_s.size(), speed);
  DriveParams<double> p = small_drive();
  p.viscous_friction_Nm_s_per_rad = 0.0;
  const auto out =
      run_axis(p, with({use_of("lugre_friction", {kCoulomb, kStatic, kSpeed, kStiffness, 0.0})}), in);
  const double g = kCoulomb + (kStatic - kCoulomb) * std::exp(-speed * speed / (kSpeed * kSpeed));
  for (std::size_t n = 1; n < out.size(); ++n) {
    const double x = speed * (out[n].time_s - 0.5e-3);  // mean over the millisecond before
    EXPECT_NEAR(out[n].load_torque_Nm, g * (1.0 - std::exp(-kStiffness * x / g)), 2e-6);
  }
  const double x = speed * 0.5e-3;
  EXPECT_NEAR(out[1].load_torque_Nm, kStiffness * x, 0.01 * kStiffness * x);
}

TEST(LugreFriction, IsCoulombFrictionInTheLimitOfStiffBristles) {
  const AxisInput in = excite(Excitation::kSteps, 0.6, 2.0);
  const auto dry = run_axis(small_drive(), with({use_of("coulomb_friction", {kCoulomb})}), in);
  const auto stiff =
      run_axis(small_drive(), with({use_of("lugre_friction", {kCoulomb, 0.0, kSpeed, 200.0, 0.08})}), in);
  for (std::size_t n = 0; n < dry.size(); ++n) {
    EXPECT_NEAR(stiff[n].omega_rotor_rad_s, dry[n].omega_rotor_rad_s, 0.2);
  }
}

// What goes in as work is lost or in the bristles: never more comes out than was put in.
TEST(LugreFriction, NeverGivesBackMoreThanItsBristlesHold) {
  DriveParams<double> p = small_drive();
  p.viscous_friction_Nm_s_per_rad = 0.0;
  AxisInput in = held(CommandKind::kMotorCurrent, 0.0, 4.0);
  double work = 0.0, least = 0.0, most = 0.0;
  for (std::size_t n = 0; n < in.time_s.size(); ++n) {
    const double t = in.time_s[n];
    in.imposed_velocity_rad_s.push_back(8.0 * std::sin(3.0 * t) * std::sin(23.0 * t));
  }
  const auto out = run_axis(p, bristles(), in);
  const double j = inertia_at_rotor(p);
  for (std::size_t n = 1; n < out.size(); ++n) {
    const double w0 = in.imposed_velocity_rad_s[n - 1], w1 = in.imposed_velocity_rad_s[n];
    const double friction_Nm = out[n].load_torque_Nm - j * (w1 - w0) / 1e-3;
    work += friction_Nm * 0.5 * (w0 + w1) * 1e-3;
    most = std::max(most, work);
    least = std::min(least, work - most);
  }
  const double held_J = 0.5 * kStatic * kStatic / kStiffness;  // s0 z^2 / 2 at breakaway
  EXPECT_GE(least, -1.2 * held_J);
  EXPECT_GT(work, 100.0 * held_J);
}

// Signature: a torque below breakaway moves the shaft elastically, and it comes back but for a rest.
TEST(LugreFriction, ShowsAsElasticCreepBelowBreakaway) {
  const DriveParams<double> p = small_drive();
  AxisInput in = held(CommandKind::kMotorCurrent, 0.0, 4.0);
  const double k = p.torque_constant_Nm_per_A;
  for (std::size_t n = 0; n < in.time_s.size(); ++n) {
    const double t = in.time_s[n];
    in.command[n] = 0.5 * kStatic / k * (t < 2.0 ? t / 2.0 : (4.0 - t) / 2.0);
  }
  const auto out = run_axis(p, bristles(), in);
  // s0 x = -g ln(1 - tau / g) up; g = s, as it creeps far below w_s
  EXPECT_NEAR(out[2000].theta_rotor_rad, -kStatic / kStiffness * std::log(1.0 - 0.5), 2e-5);
  // down: dz/dx is 1 + s0 z / g on the way back, so s0 x = g ln(1 + tau / g)
  EXPECT_NEAR(out[2000].theta_rotor_rad - out.back().theta_rotor_rad, kStatic / kStiffness * std::log(1.5),
              2e-5);
  EXPECT_FALSE(out[1000].held);
}

// Held below breakaway by a steady torque it does not drift.
TEST(LugreFriction, DoesNotDriftUnderASteadyTorque) {
  const DriveParams<double> p = small_drive();
  const auto out = run_axis(
      p, bristles(), held(CommandKind::kMotorCurrent, 0.6 * kStatic / p.torque_constant_Nm_per_A, 10.0));
  EXPECT_NEAR(out.back().theta_rotor_rad, out[5000].theta_rotor_rad, 1e-9);
  EXPECT_GT(out.back().theta_rotor_rad, 0.0);
}

// An angle that is corrected at every sample to a measured one moves no bristle.
TEST(LugreFriction, DoesNotSeeAMeasuredAngle) {
  AxisInput in = excite(Excitation::kSteps, 0.3, 1.0);
  const auto free = run_axis(small_drive(), bristles(), in);
  for (const auto& sample : free) {
    const double error_rad = 0.01 * std::sin(300.0 * sample.time_s);  // ten times the bristles' length
    in.measured_position_rad.push_back(sample.theta_rotor_rad + error_rad);
  }
  const auto slaved = run_axis(small_drive(), bristles(), in);
  for (std::size_t n = 0; n < free.size(); ++n) {
    EXPECT_NEAR(slaved[n].omega_rotor_rad_s, free[n].omega_rotor_rad_s, 1e-6);
  }
}

// Half the sub-step, about a quarter of the error: also where a step of 1 ms spans the bristles' whole length and
// the level falls meanwhile.
TEST(LugreFriction, ConvergesInSecondOrder) {
  AxisInput in = held(CommandKind::kMotorCurrent, 0.0, 2.0);
  for (std::size_t n = 0; n < in.time_s.size(); ++n)
    in.command[n] = 3.0 * kStatic / small_drive().torque_constant_Nm_per_A * std::sin(6.0 * in.time_s[n]);
  const auto speed_error = [&](double stiffness, double step_s) {
    const auto law = with({use_of("lugre_friction", {kCoulomb, kStatic, kSpeed, stiffness, kDamping})});
    const auto exact = run_axis(small_drive(), law, in, {.step_s = 2e-6});
    const auto coarse = run_axis(small_drive(), law, in, {.step_s = step_s});
    double square = 0.0;
    for (std::size_t n = 0; n < exact.size(); ++n)
      square += std::pow(coarse[n].omega_rotor_rad_s - exact[n].omega_rotor_rad_s, 2);
    return std::sqrt(square / static_cast<double>(exact.size()));
  };
  for (const double stiffness : {0.3, 3.0}) {
    EXPECT_LT(speed_error(stiffness, 1e-4), 1e-3) << stiffness;  // of 98 rad/s
    // a quarter of the step: 1 / 16, asked 1 / 8 (first order: 1 / 4)
    EXPECT_LT(speed_error(stiffness, 5e-5), speed_error(stiffness, 2e-4) / 8.0) << stiffness;
  }
}

// Starting far from angle zero makes no difference.
TEST(LugreFriction, DoesNotDependOnTheAngle) {
  AxisInput in = excite(Excitation::kSteps, 0.3, 1.0);
  const auto here = run_axis(small_drive(), bristles(), in);
  in.initial_position_rad = 64.0;
  const auto there = run_axis(small_drive(), bristles(), in);
  for (std::size_t n = 0; n < here.size(); ++n) {
    EXPECT_NEAR(here[n].omega_rotor_rad_s, there[n].omega_rotor_rad_s, 1e-6);
  }
}

}  // namespace
}  // namespace omnihil::test
