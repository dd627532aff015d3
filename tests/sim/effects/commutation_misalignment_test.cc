#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/sim/drive/phase_bench.h"
#include "tests/sim/effects/bench.h"

namespace omnihil::test {
namespace {

// Torque at a held speed and current.
double torque_at(double angle_rad, double speed_rad_s, double current_A) {
  DriveParams<double> p = small_drive();
  p.viscous_friction_Nm_s_per_rad = 0.0;
  AxisInput in = held(CommandKind::kMotorCurrent, current_A, 0.05);
  in.imposed_velocity_rad_s.assign(in.time_s.size(), speed_rad_s);
  return -run_axis(p, with({use_of("commutation_misalignment", {angle_rad})}), in).back().load_torque_Nm;
}

TEST(CommutationMisalignment, GivesTheCosineAtStall) {
  EXPECT_NEAR(torque_at(0.2, 0.0, 3.0), 0.0255 * 3.0 * std::cos(0.2), 1e-12);
  EXPECT_NEAR(torque_at(-0.2, 0.0, 3.0), 0.0255 * 3.0 * std::cos(0.2), 1e-12);
}

// k (cos d + sin d q), q = p L w i / (R i + k w + p L w i)
TEST(CommutationMisalignment, MakesUpForTheLagOfTheCurrentOneWay) {
  const double reactive_V = 8 * 5.6e-4 * 200.0 * 2.0;
  const double q = reactive_V / (1.2 * 2.0 + 0.0255 * 200.0 + reactive_V);
  EXPECT_NEAR(torque_at(0.2, 200.0, 2.0), 0.051 * (std::cos(0.2) + std::sin(0.2) * q), 1e-12);
  EXPECT_NEAR(torque_at(0.2, -200.0, -2.0), -0.051 * (std::cos(0.2) - std::sin(0.2) * q), 1e-12);
}

// Mean torque at full duty and a held speed, of the switched six-step drive whose sensors sit beside. A fast
// PWM, because commutation waits for its period's end.
double switched_torque(double angle_rad, double speed_rad_s) {
  MotorParams sheet = sheet_motor();
  sheet.resistance_ohm = 1.2;
  sheet.inductance_H = 5.6e-4;
  sheet.torque_constant_Nm_per_A = 0.0255;
  sheet.viscous_friction_Nm_s_per_rad = 0.0;
  const SwitchedDrive d = make_switched_drive(phase_motor_of(sheet, Commutation::kBlock, kSine),
                                              {.pwm_frequency_Hz = 100e3}, {.max_step_s = 5e-6});
  SwitchedState x;
  x.motor.omega_rotor_rad_s = speed_rad_s;
  const double turn_s = 2.0 * std::numbers::pi / (8.0 * speed_rad_s);  // electrical
  PhaseFlow flow;
  const auto run = [&](double duration_s) {
    for (double t = 0.0; t < duration_s; t += d.period_s) {
      const double theta_elec_rad = 8.0 * x.motor.theta_rotor_rad + angle_rad;
      advance_period(d, x, six_step(theta_elec_rad, 1.0, PwmMode::kComplementary),
                     {.bus_voltage_V = 12.0, .speed_is_imposed = true}, 0.5, flow);
    }
  };
  run(0.02);
  flow = {};
  run(10.0 * turn_s);
  return flow.impulse_Nm_s / flow.time_s;
}

// Torque over that of the aligned drive: the averaged law against the switched bridge.
TEST(CommutationMisalignment, AgreesWithTheSwitchedSixStepDrive) {
  const auto averaged_torque = [](double angle_rad, double speed_rad_s) {
    DriveParams<double> p = small_drive();
    p.viscous_friction_Nm_s_per_rad = 0.0;
    AxisInput in = held(CommandKind::kDuty, 1.0, 0.05);
    in.imposed_velocity_rad_s.assign(in.time_s.size(), speed_rad_s);
    return -run_axis(p, with({use_of("commutation_misalignment", {angle_rad})}), in).back().load_torque_Nm;
  };
  for (const double speed : {20.0, 140.0, 280.0}) {
    const double switched = switched_torque(0.0, speed), averaged = averaged_torque(0.0, speed);
    for (const double angle : {-0.2, -0.1, 0.1, 0.2}) {
      EXPECT_NEAR(averaged_torque(angle, speed) / averaged, switched_torque(angle, speed) / switched, 0.02)
          << angle << " rad at " << speed << " rad/s";
    }
  }
}

TEST(CommutationMisalignment, VanishesAtSmallAngles) {
  EXPECT_NEAR(torque_at(1e-9, 200.0, 2.0), 0.051, 1e-10);
}

TEST(CommutationMisalignment, IsMirroredWithItsAngle) {
  const AxisInput in = excite(Excitation::kSteps, 0.7, 1.0), back = excite(Excitation::kSteps, -0.7, 1.0);
  const auto a = run_axis(small_drive(), with({use_of("commutation_misalignment", {0.2})}), in);
  const auto b = run_axis(small_drive(), with({use_of("commutation_misalignment", {-0.2})}), back);
  for (std::size_t n = 0; n < a.size(); ++n) {
    EXPECT_NEAR(a[n].omega_rotor_rad_s, -b[n].omega_rotor_rad_s, 1e-9);
  }
}

// Signature: free speed up both ways while torque per ampere at rest is down.
TEST(CommutationMisalignment, ShowsAsMoreSpeedAndLessTorquePerAmpere) {
  DriveParams<double> p = small_drive();
  p.viscous_friction_Nm_s_per_rad = 0.0;
  for (const double duty : {0.5, -0.5}) {
    const auto out =
        run_axis(p, with({use_of("commutation_misalignment", {0.2})}), held(CommandKind::kDuty, duty, 3.0));
    EXPECT_NEAR(out.back().omega_rotor_rad_s, 12.0 * duty / (0.0255 * std::cos(0.2)), 1e-6);
  }
  EXPECT_LT(torque_at(0.2, 0.0, 1.0), 0.0255);
}

// Signature: under load the directions part; forwards, where commutation is early, an ampere gives more.
TEST(CommutationMisalignment, ShowsAsADifferenceOfDirectionsUnderLoad) {
  const auto current = [](double angle, double sign) {
    AxisInput in = held(CommandKind::kDuty, 0.8 * sign, 3.0);
    in.load_torque_Nm.assign(in.time_s.size(), -0.05 * sign);
    const auto out = run_axis(small_drive(), with({use_of("commutation_misalignment", {angle})}), in).back();
    return std::abs(out.motor_current_A);
  };
  EXPECT_GT(current(0.2, -1.0), current(0.2, 1.0) * 1.04);
  EXPECT_NEAR(current(0.2, -1.0), current(-0.2, 1.0), 1e-9);
}

}  // namespace
}  // namespace omnihil::test
