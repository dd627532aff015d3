// Winding and rotor under a held voltage, against closed forms.
#include "sim/drive/dc_drive.h"

#include <gtest/gtest.h>

#include <numbers>
#include <stdexcept>
#include <tuple>

#include "tests/sim/drive/motors_for_tests.h"

namespace omnihil {
namespace {

using testing::coast;
using testing::duty;
using testing::kSubstep_s;
using testing::plain_motor;
using testing::Spin;

TEST(DcDrive, NoLoadSpeedIsVoltageOverTorqueConstant) {
  const MotorParams m = plain_motor();
  for (const double inductance_H : {m.inductance_H, 0.0}) {
    MotorParams motor = m;
    motor.inductance_H = inductance_H;
    Spin spin{make_dc_drive(motor, 0.0, kSubstep_s)};
    for (int ms = 0; ms < 2000; ++ms) spin.run(duty(0.75, 16.0), 20);
    EXPECT_NEAR(spin.omega_rad_s, 0.75 * 16.0 / motor.torque_constant_Nm_per_A, 1e-9);
    EXPECT_NEAR(spin.state.current_A, 0.0, 1e-11);
  }
}

TEST(DcDrive, NoLoadSpeedUnderALoadTorqueIsLowerByRTauOverK2) {
  const MotorParams m = plain_motor();
  const double load_Nm = 3.7e-3;
  Spin spin{make_dc_drive(m, 0.0, kSubstep_s)};
  for (int ms = 0; ms < 2000; ++ms) spin.run(duty(1.0, 12.0, 0.0, load_Nm), 20);
  const double k = m.torque_constant_Nm_per_A;
  EXPECT_NEAR(spin.omega_rad_s, 12.0 / k - m.resistance_ohm * load_Nm / (k * k), 1e-8);
  EXPECT_NEAR(spin.state.current_A, load_Nm / k, 1e-10);
}

TEST(DcDrive, StallTorqueIsKUOverR) {
  const MotorParams m = plain_motor();
  Spin spin{make_dc_drive(m, 1e9, kSubstep_s)};  // so much inertia that it stands still
  DcDriveResult r;
  for (int ms = 0; ms < 20; ++ms) r = spin.run(duty(1.0, 12.0), 20);
  EXPECT_NEAR(r.mean_torque_Nm, m.torque_constant_Nm_per_A * 12.0 / m.resistance_ohm, 1e-12);
}

TEST(DcDrive, CurrentStepOfAHeldRotorIsTheRLExponential) {
  const MotorParams m = plain_motor();
  const double tau_s = m.inductance_H / m.resistance_ohm, final_A = 12.0 / m.resistance_ohm;
  DcDrive drive = make_dc_drive(m, 1e9, kSubstep_s);
  DcDriveState state;
  for (int n = 1; n <= 100; ++n) {
    const DcDriveResult r = advance_drive(drive, state, duty(1.0, 12.0), 1);
    const double t = n * kSubstep_s, t0 = t - kSubstep_s;
    EXPECT_NEAR(state.current_A, final_A * (1.0 - std::exp(-t / tau_s)), 1e-12 * final_A);
    // mean of 1 - exp(-t/tau) over the step
    const double mean = 1.0 - tau_s / kSubstep_s * (std::exp(-t0 / tau_s) - std::exp(-t / tau_s));
    EXPECT_NEAR(r.mean_current_A, final_A * mean, 1e-12 * final_A);
  }
}

TEST(DcDrive, HeatOfACurrentStepIsTheIntegralOfRI2) {
  const MotorParams m = plain_motor();
  const double tau_s = m.inductance_H / m.resistance_ohm, final_A = 12.0 / m.resistance_ohm;
  Spin spin{make_dc_drive(m, 1e9, kSubstep_s)};
  spin.run(duty(1.0, 12.0), 37);
  const double t = 37 * kSubstep_s, e = std::exp(-t / tau_s);
  // integral of (1 - exp(-t/tau))^2
  const double integral_s = t - 2.0 * tau_s * (1.0 - e) + 0.5 * tau_s * (1.0 - e * e);
  EXPECT_NEAR(spin.heat_J, m.resistance_ohm * final_A * final_A * integral_s, 1e-12);
}

TEST(DcDrive, RunUpWithoutInductanceHasTheMechanicalTimeConstant) {
  MotorParams m = plain_motor();
  m.inductance_H = 0.0;
  const double extra_kg_m2 = 1e-5, k = m.torque_constant_Nm_per_A;
  const double tau_s = (m.rotor_inertia_kg_m2 + extra_kg_m2) * m.resistance_ohm / (k * k);
  Spin spin{make_dc_drive(m, extra_kg_m2, kSubstep_s)};
  for (int ms = 1; ms <= 200; ++ms) {
    spin.run(duty(1.0, 12.0), 20);
    EXPECT_NEAR(spin.omega_rad_s, 12.0 / k * (1.0 - std::exp(-ms * 1e-3 / tau_s)), 1e-10);
  }
}

TEST(DcDrive, RunUpWithInductanceIsTheSolutionOfTheSecondOrderEquation) {
  const MotorParams m = plain_motor();
  const double r = m.resistance_ohm, l = m.inductance_H, k = m.torque_constant_Nm_per_A,
               j = m.rotor_inertia_kg_m2;
  // L J omega'' + R J omega' + k^2 omega = k u, at rest at first: two real exponentials
  const double root = std::sqrt(r * r / (4 * l * l) - k * k / (l * j));
  const double s1 = -r / (2 * l) + root, s2 = -r / (2 * l) - root;
  Spin spin{make_dc_drive(m, 0.0, kSubstep_s)};
  for (int n = 1; n <= 200; ++n) {
    spin.run(duty(1.0, 12.0), 7);
    const double t = 7 * n * kSubstep_s;
    const double omega = 12.0 / k * (1.0 + (s2 * std::exp(s1 * t) - s1 * std::exp(s2 * t)) / (s1 - s2));
    EXPECT_NEAR(spin.omega_rad_s, omega, 1e-9) << "at " << t << " s";
  }
}

TEST(DcDrive, TorqueWithoutInductanceIsEquationSevenWithItsSpeedFactor) {
  MotorParams m = plain_motor();
  m.inductance_H = 0.0;
  const double k = m.torque_constant_Nm_per_A, k_speed = 1.0 / k;
  for (const double omega : {-300.0, 0.0, 150.0}) {
    DcDriveState state;
    const DcDriveResult r =
        advance_drive(make_dc_drive(m, 1e9, kSubstep_s), state, duty(0.5, 12.0, omega), 20);
    const double torque = k / m.resistance_ohm * 6.0 - k / (m.resistance_ohm * k_speed) * omega;
    EXPECT_NEAR(r.mean_torque_Nm, torque, 1e-12);
  }
}

TEST(DcDrive, TwoSubstepsEqualOneOfTwiceTheLength) {
  for (const double inductance_H : {0.56e-3, 0.0}) {
    MotorParams m = plain_motor();
    m.inductance_H = inductance_H;
    Spin fine{make_dc_drive(m, 2e-6, kSubstep_s)}, coarse{make_dc_drive(m, 2e-6, 2 * kSubstep_s)};
    for (int n = 0; n < 500; ++n) {
      const double d = std::sin(0.1 * n), load_Nm = 0.01 * std::cos(0.03 * n);
      const DcDriveResult a = fine.run(duty(d, 12.0, 0.0, load_Nm), 2);
      const DcDriveResult b = coarse.run(duty(d, 12.0, 0.0, load_Nm), 1);
      EXPECT_NEAR(a.omega_end_rad_s, b.omega_end_rad_s, 1e-12 * (1.0 + std::abs(b.omega_end_rad_s)));
      EXPECT_NEAR(fine.state.current_A, coarse.state.current_A,
                  1e-12 * (1.0 + std::abs(coarse.state.current_A)));
      EXPECT_NEAR(a.mean_torque_Nm, b.mean_torque_Nm, 1e-12);
      EXPECT_NEAR(a.heat_J, b.heat_J, 1e-12);
    }
  }
}

TEST(DcDrive, ManySubstepsAtOnceEqualThemOneByOne) {
  const DcDrive drive = make_dc_drive(plain_motor(), 0.0, kSubstep_s);
  for (const int substeps : {1, 3, 20, 63, 100}) {
    Spin at_once{drive}, one_by_one{drive};
    const DcDriveResult r = at_once.run(duty(0.8, 12.0, 0.0, 0.02), substeps);
    double mean_A = 0.0;
    for (int n = 0; n < substeps; ++n) {
      mean_A += one_by_one.run(duty(0.8, 12.0, 0.0, 0.02), 1).mean_current_A / substeps;
    }
    EXPECT_NEAR(at_once.omega_rad_s, one_by_one.omega_rad_s, 1e-11);
    EXPECT_NEAR(at_once.state.current_A, one_by_one.state.current_A, 1e-12);
    EXPECT_NEAR(at_once.heat_J, one_by_one.heat_J, 1e-12);
    EXPECT_NEAR(r.mean_current_A, mean_A, 1e-12);
  }
}

TEST(DcDrive, AgreesWithTheContinuousLawIntegratedFinely) {
  const MotorParams m = plain_motor();
  const DcDriveConstants<double> c{m.resistance_ohm, m.inductance_H, m.torque_constant_Nm_per_A, 1.2e-5};
  DcDriveContinuousState<double> x{1.5, 40.0};
  const DcDriveContinuousInput<double> in{9.0, 0.03};
  const double h = 1e-6;
  for (int n = 0; n < 3000; ++n) {  // classical Runge-Kutta
    const auto at = [&](const DcDriveRates<double>& r, double t) {
      return DcDriveContinuousState<double>{x.current_A + t * r.current_A_per_s,
                                            x.omega_rotor_rad_s + t * r.omega_rotor_rad_s2};
    };
    const auto k1 = dc_drive_rates(c, x, in), k2 = dc_drive_rates(c, at(k1, h / 2), in),
               k3 = dc_drive_rates(c, at(k2, h / 2), in), k4 = dc_drive_rates(c, at(k3, h), in);
    x.current_A +=
        h / 6 * (k1.current_A_per_s + 2 * k2.current_A_per_s + 2 * k3.current_A_per_s + k4.current_A_per_s);
    x.omega_rotor_rad_s += h / 6 *
                           (k1.omega_rotor_rad_s2 + 2 * k2.omega_rotor_rad_s2 + 2 * k3.omega_rotor_rad_s2 +
                            k4.omega_rotor_rad_s2);
  }
  DcDriveState state{1.5};
  const DcDrive drive = make_dc_drive(m, 1.2e-5 - m.rotor_inertia_kg_m2, kSubstep_s);
  const DcDriveResult r = advance_drive(drive, state, duty(0.75, 12.0, 40.0, 0.03), 60);
  EXPECT_NEAR(state.current_A, x.current_A, 1e-10);
  EXPECT_NEAR(r.omega_end_rad_s, x.omega_rotor_rad_s, 1e-9);
}

TEST(DcDrive, RefusesImpossibleConstantsAllAtOnce) {
  MotorParams m = plain_motor();
  m.resistance_ohm = 0.0;
  m.torque_constant_Nm_per_A = -1.0;
  m.inductance_H = -1e-3;
  try {
    make_dc_drive(m, 0.0, 0.0);
    FAIL() << "was accepted";
  } catch (const std::invalid_argument& e) {
    for (const char* word : {"resistance_ohm", "torque_constant", "inductance_H", "step"}) {
      EXPECT_NE(std::string(e.what()).find(word), std::string::npos) << word;
    }
  }
}

}  // namespace
}  // namespace omnihil
