// Coasting, current limit and duty limit.
#include <gtest/gtest.h>

#include "sim/drive/dc_drive.h"
#include "tests/sim/drive/motors_for_tests.h"

namespace omnihil {
namespace {

using testing::coast;
using testing::duty;
using testing::kSubstep_s;
using testing::plain_motor;
using testing::Spin;

TEST(Coast, CurrentReachesExactlyZeroAfterTheTimeOfTheClosedForm) {
  const MotorParams m = plain_motor();
  const double i0 = 8.0, bus_V = 12.0;
  // held rotor: L di/dt = -bus - R i  ->  zero at (L/R) ln(1 + R i0 / bus)
  const double zero_s = m.inductance_H / m.resistance_ohm * std::log(1.0 + m.resistance_ohm * i0 / bus_V);
  const DcDrive drive = make_dc_drive(m, 1e9, kSubstep_s);
  DcDriveState state{i0};
  double charge_C = 0.0;
  int substeps = 0;
  while (state.current_A != 0.0 && substeps < 1000) {
    charge_C += advance_drive(drive, state, coast(bus_V, 0.0), 1).mean_current_A * kSubstep_s;
    ++substeps;
  }
  EXPECT_EQ(substeps, static_cast<int>(std::ceil(zero_s / kSubstep_s)));
  // charge until then: integral of (i0 + bus/R) exp(-t R/L) - bus/R
  const double charge = m.inductance_H / m.resistance_ohm * i0 - bus_V / m.resistance_ohm * zero_s;
  EXPECT_NEAR(charge_C, charge, 1e-9 * charge);
}

TEST(Coast, NegativeCurrentIsTheMirrorImage) {
  const DcDrive drive = make_dc_drive(plain_motor(), 0.0, kSubstep_s);
  DcDriveState up{5.0}, down{-5.0};
  for (int n = 0; n < 10; ++n) {
    const DcDriveResult a = advance_drive(drive, up, coast(12.0, 100.0), 1);
    const DcDriveResult b = advance_drive(drive, down, coast(12.0, -100.0), 1);
    EXPECT_DOUBLE_EQ(up.current_A, -down.current_A);
    EXPECT_DOUBLE_EQ(a.mean_torque_Nm, -b.mean_torque_Nm);
    EXPECT_DOUBLE_EQ(a.electrical_energy_J, b.electrical_energy_J);
  }
}

TEST(Coast, WithoutCurrentTheRotorRunsFreeBelowBusSpeed) {
  const MotorParams m = plain_motor();
  Spin spin{make_dc_drive(m, 0.0, kSubstep_s)};
  spin.omega_rad_s = 0.99 * 12.0 / m.torque_constant_Nm_per_A;
  const double before = spin.omega_rad_s;
  const DcDriveResult r = spin.run(coast(12.0, 0.0), 200);
  EXPECT_EQ(spin.state.current_A, 0.0);
  EXPECT_EQ(r.mean_torque_Nm, 0.0);
  EXPECT_EQ(spin.omega_rad_s, before);
}

TEST(Coast, LoadAloneSlowsTheRotor) {
  const MotorParams m = plain_motor();
  Spin spin{make_dc_drive(m, 0.0, kSubstep_s)};
  spin.omega_rad_s = 300.0;
  spin.run(coast(12.0, 0.0, 2e-3), 200);
  EXPECT_NEAR(spin.omega_rad_s, 300.0 - 2e-3 / m.rotor_inertia_kg_m2 * 200 * kSubstep_s, 1e-10);
}

TEST(Coast, AboveBusSpeedTheDiodesBrakeIntoTheBus) {
  for (const double inductance_H : {0.56e-3, 0.0}) {
    MotorParams m = plain_motor();
    m.inductance_H = inductance_H;
    const double k = m.torque_constant_Nm_per_A, omega = 1.5 * 12.0 / k;
    const DcDrive drive = make_dc_drive(m, 1e9, kSubstep_s);
    DcDriveState state;
    DcDriveResult r;
    for (int ms = 0; ms < 20; ++ms) r = advance_drive(drive, state, coast(12.0, omega), 20);
    // settled: (bus - k omega) / R
    EXPECT_NEAR(r.mean_current_A, (12.0 - k * omega) / m.resistance_ohm, 1e-9);
    EXPECT_LT(r.mean_bus_current_A, 0.0);
  }
}

TEST(CurrentLimit, HoldsAtStallWhereTheCurrentWouldBeThreeTimesIt) {
  for (const double inductance_H : {0.56e-3, 0.0}) {
    MotorParams m = plain_motor();
    m.inductance_H = inductance_H;
    m.current_limit_A = 3.0;
    const DcDrive drive = make_dc_drive(m, 1e9, kSubstep_s);
    DcDriveState state;
    for (int n = 0; n < 200; ++n) {
      const DcDriveResult r = advance_drive(drive, state, duty(n < 100 ? 1.0 : -1.0, 12.0), 1);
      EXPECT_LE(std::abs(state.current_A), 3.0);
      EXPECT_LE(std::abs(r.mean_current_A), 3.0);
    }
    EXPECT_EQ(state.current_A, -3.0);
    // the supply gives only the heat: R i^2 / bus
    const DcDriveResult r = advance_drive(drive, state, duty(-1.0, 12.0), 20);
    EXPECT_NEAR(r.mean_bus_current_A, m.resistance_ohm * 9.0 / 12.0, 1e-12);
    EXPECT_NEAR(r.mean_torque_Nm, -3.0 * m.torque_constant_Nm_per_A, 1e-15);
  }
}

TEST(CurrentLimit, HoldsWhileReversingAtFullSpeed) {
  MotorParams m = plain_motor();
  m.current_limit_A = 4.0;
  Spin spin{make_dc_drive(m, 0.0, kSubstep_s)};
  for (int ms = 0; ms < 500; ++ms) {
    for (int n = 0; n < 20; ++n) {
      spin.run(duty(ms / 100 % 2 == 0 ? 1.0 : -1.0, 12.0), 1);
      ASSERT_LE(std::abs(spin.state.current_A), 4.0) << "at " << ms << " ms";
    }
  }
}

TEST(CurrentLimit, LeavesTheDriveAloneWhereItIsNotReached) {
  MotorParams limited = plain_motor();
  limited.current_limit_A = 3.0;
  Spin with{make_dc_drive(limited, 0.0, kSubstep_s)}, without{make_dc_drive(plain_motor(), 0.0, kSubstep_s)};
  for (int ms = 0; ms < 200; ++ms) {
    const double asked = 0.25 * std::sin(0.05 * ms);  // 3 V: at most 2.5 A
    with.run(duty(asked, 12.0), 20);
    without.run(duty(asked, 12.0), 20);
    ASSERT_NEAR(with.omega_rad_s, without.omega_rad_s, 1e-10);
    ASSERT_NEAR(with.state.current_A, without.state.current_A, 1e-12);
  }
}

TEST(CurrentLimit, ManySubstepsAtOnceEqualThemOneByOne) {
  for (const double inductance_H : {0.56e-3, 0.0}) {
    MotorParams m = plain_motor();
    m.inductance_H = inductance_H;
    m.current_limit_A = 4.0;
    Spin at_once{make_dc_drive(m, 0.0, kSubstep_s)}, one_by_one{at_once.drive};
    for (int ms = 0; ms < 400; ++ms) {
      const double asked = ms / 60 % 2 == 0 ? 1.0 : -0.7;
      at_once.run(duty(asked, 12.0), 20);
      for (int n = 0; n < 20; ++n) one_by_one.run(duty(asked, 12.0), 1);
      ASSERT_NEAR(at_once.omega_rad_s, one_by_one.omega_rad_s, 1e-9) << "at " << ms << " ms";
      ASSERT_NEAR(at_once.state.current_A, one_by_one.state.current_A, 1e-10);
      ASSERT_NEAR(at_once.heat_J, one_by_one.heat_J, 1e-10);
    }
  }
}

TEST(CurrentLimit, SpeedRisesEvenlyWhileItHolds) {
  MotorParams m = plain_motor();
  m.current_limit_A = 2.0;
  Spin spin{make_dc_drive(m, 0.0, kSubstep_s)};
  spin.run(duty(1.0, 12.0), 100);  // now at the limit
  const double before = spin.omega_rad_s;
  spin.run(duty(1.0, 12.0), 400);
  EXPECT_NEAR(spin.omega_rad_s - before,
              m.torque_constant_Nm_per_A * 2.0 / m.rotor_inertia_kg_m2 * 400 * kSubstep_s, 1e-9);
}

TEST(CurrentLimit, CannotHoldAgainstABackEmfAboveTheBus) {
  MotorParams m = plain_motor();
  m.current_limit_A = 1.0;
  const double k = m.torque_constant_Nm_per_A, omega = 2.0 * 12.0 / k;  // driven at twice the bus speed
  const DcDrive drive = make_dc_drive(m, 1e9, kSubstep_s);
  DcDriveState state;
  for (int ms = 0; ms < 20; ++ms) advance_drive(drive, state, duty(0.5, 12.0, omega), 20);
  EXPECT_NEAR(state.current_A, (12.0 - 24.0) / m.resistance_ohm, 1e-9);
}

TEST(CurrentLimit, PullsDownACurrentThatStartedAboveIt) {
  MotorParams m = plain_motor();
  m.current_limit_A = 2.0;
  const DcDrive drive = make_dc_drive(m, 1e9, kSubstep_s);
  DcDriveState state{6.0};
  for (int n = 0; n < 8; ++n) advance_drive(drive, state, duty(1.0, 12.0), 1);
  EXPECT_EQ(state.current_A, 2.0);
}

TEST(DutyLimit, LargerDutiesActAsTheLimit) {
  MotorParams m = plain_motor();
  m.duty_limit_ratio = 0.6;
  Spin asked_more{make_dc_drive(m, 0.0, kSubstep_s)}, asked_it{make_dc_drive(m, 0.0, kSubstep_s)};
  const DcDriveResult a = asked_more.run(duty(1.0, 12.0), 20), b = asked_it.run(duty(0.6, 12.0), 20);
  EXPECT_EQ(a.mean_torque_Nm, b.mean_torque_Nm);
  const DcDriveResult c = asked_more.run(duty(-3.0, 12.0), 20), d = asked_it.run(duty(-0.6, 12.0), 20);
  EXPECT_EQ(c.mean_torque_Nm, d.mean_torque_Nm);
}

}  // namespace
}  // namespace omnihil
