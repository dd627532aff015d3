#include "sim/drive/dq_motor.h"

#include <gtest/gtest.h>

#include "sim/drive/dc_drive.h"
#include "sim/law/scalar.h"
#include "tests/sim/drive/phase_bench.h"

namespace omnihil {
namespace {

PhaseMotor<double> salient_motor() {
  PhaseMotor<double> m = sine_motor();
  m.inductance_d_H = 0.9e-4;
  m.inductance_q_H = 1.5e-4;
  return m;
}

PhaseMotor<double> saturating_motor() {
  PhaseMotor<double> m = salient_motor();
  m.inductance_saturation_per_A = 1.0 / 20.0;
  m.flux_saturation_per_A = 1.0 / 40.0;
  return m;
}

TEST(DqMotor, SteadyStateMeetsTheVoltageEquations) {
  const PhaseMotor<double> m = salient_motor();
  DqState<double> x;
  DqStepResult<double> r;
  for (int k = 0; k < 400000; ++k)
    r = advance_dq(m, x, {.v_d_V = -1.0, .v_q_V = 5.0, .tau_load_Nm = 0.03}, 20e-6);
  const double we = 8 * x.omega_rotor_rad_s;
  EXPECT_NEAR(m.resistance_ohm * x.i_d_A - we * m.inductance_q_H * x.i_q_A, -1.0, 1e-9);
  EXPECT_NEAR(m.resistance_ohm * x.i_q_A + we * (m.inductance_d_H * x.i_d_A + m.flux_linkage_Wb), 5.0, 1e-9);
  const double torque =
      1.5 * 8 * (m.flux_linkage_Wb * x.i_q_A + (m.inductance_d_H - m.inductance_q_H) * x.i_d_A * x.i_q_A);
  EXPECT_NEAR(torque, 0.03 + m.viscous_friction_Nm_s_per_rad * x.omega_rotor_rad_s, 1e-12);
}

// Over a start and a step of the voltage: gap of the energy balance, relative to the energy taken.
double energy_gap_ratio(const PhaseMotor<double>& m, double h_s) {
  DqState<double> x;
  double in = 0.0, heat = 0.0, mechanical = 0.0;
  const int n = static_cast<int>(std::lround(0.1 / h_s));
  for (int k = 0; k < n; ++k) {
    const double v = 2 * k < n ? 4.0 : -2.0;
    const auto r = advance_dq(m, x, {.v_d_V = -0.5, .v_q_V = v, .tau_load_Nm = 0.02}, h_s);
    in += r.electrical_J;
    heat += r.heat_J;
    mechanical += r.mechanical_J;
  }
  return (in - heat - mechanical - dq_stored_J(m, x.i_d_A, x.i_q_A)) / std::abs(in);
}

TEST(DqMotor, EnergyInIsHeatAndWorkAndStored) {
  EXPECT_LT(std::abs(energy_gap_ratio(salient_motor(), 50e-6)), 1e-6);
  EXPECT_LT(std::abs(energy_gap_ratio(saturating_motor(), 2e-6)), 1e-6);
}

TEST(DqMotor, SaturationsEnergyGapFallsWithTheStepSquared) {
  const double coarse = std::abs(energy_gap_ratio(saturating_motor(), 40e-6));
  const double fine = std::abs(energy_gap_ratio(saturating_motor(), 20e-6));
  EXPECT_GT(coarse / fine, 3.0);
}

DqState<double> run_smooth(const PhaseMotor<double>& m, double h_s) {
  DqState<double> x;
  const int n = static_cast<int>(std::lround(0.02 / h_s));
  for (int k = 0; k < n; ++k) {
    const double t = (k + 0.5) * h_s;
    advance_dq(m, x, {.v_d_V = -1.0, .v_q_V = 4.0 + 2.0 * std::sin(600.0 * t), .tau_load_Nm = 0.02}, h_s);
  }
  return x;
}

TEST(DqMotor, HalvingTheStepQuartersTheError) {
  for (const auto& m : {salient_motor(), saturating_motor()}) {
    const auto truth = run_smooth(m, 0.625e-6);
    const auto error = [&](double h_s) {
      const auto x = run_smooth(m, h_s);
      return std::abs(x.i_q_A - truth.i_q_A) + 0.1 * std::abs(x.omega_rotor_rad_s - truth.omega_rotor_rad_s);
    };
    const double ratio = error(40e-6) / error(20e-6);
    EXPECT_GT(ratio, 3.6);
    EXPECT_LT(ratio, 4.4);
  }
}

TEST(DqMotor, WithNoDirectCurrentItIsTheDcEquivalentMotor) {
  // v_d that holds i_d at zero: -omega_e L_q i_q; then U = sqrt(3) v_q, I = sqrt(3)/2 i_q, exactly
  const PhaseMotor<double> m = sine_motor();
  const MotorParams dc = dc_equivalent_of(m, Commutation::kSinusoidal, sheet_motor());
  const double h_s = 10e-6, v_q = 6.0;
  const DcDrive drive = make_dc_drive(dc, 0.0, h_s);
  DcDriveState y;
  DqState<double> x;
  double omega = 0.0;
  for (int k = 0; k < 20000; ++k) {
    const double we = 8 * (x.omega_rotor_rad_s + 0.5 * x.omega_change_rad_s);
    const double load = 0.04;
    advance_dq(m, x, {.v_d_V = -we * m.inductance_q_H * x.i_q_A, .v_q_V = v_q, .tau_load_Nm = load}, h_s);
    const auto r = advance_drive(drive, y,
                                 {.mode = OMNIHIL_DRIVE_DUTY,
                                  .duty_ratio = 0.5,
                                  .bus_voltage_V = 2.0 * std::sqrt(3.0) * v_q,
                                  .omega_rotor_rad_s = omega,
                                  .tau_load_Nm = load + m.viscous_friction_Nm_s_per_rad * omega},
                                 1);
    omega = r.omega_end_rad_s;
    if (k % 500 == 499) {
      EXPECT_NEAR(x.omega_rotor_rad_s, omega, 1e-3 * 300.0) << k;
      EXPECT_NEAR(0.5 * std::sqrt(3.0) * x.i_q_A, y.current_A, 1e-2) << k;
    }
  }
  EXPECT_NEAR(x.omega_rotor_rad_s, omega, 1e-5 * omega);
  EXPECT_NEAR(0.5 * std::sqrt(3.0) * x.i_q_A, y.current_A, 1e-5 * y.current_A);
}

TEST(DqMotor, FluxIsTheGradientOfOneCoEnergy) {
  // reciprocity and the differential inductances, against finite differences
  const PhaseMotor<double> m = saturating_motor();
  const double e = 1e-5;
  for (const double i_d : {-6.0, 0.0, 3.0})
    for (const double i_q : {-15.0, 0.5, 20.0}) {
      const auto f = dq_flux(m, i_d, i_q);
      const auto dp = dq_flux(m, i_d + e, i_q), dm = dq_flux(m, i_d - e, i_q);
      const auto qp = dq_flux(m, i_d, i_q + e), qm = dq_flux(m, i_d, i_q - e);
      EXPECT_NEAR((dp.psi_d_Wb - dm.psi_d_Wb) / (2 * e), f.dd_H, 1e-10);
      EXPECT_NEAR((dp.psi_q_Wb - dm.psi_q_Wb) / (2 * e), f.dq_H, 1e-10);
      EXPECT_NEAR((qp.psi_d_Wb - qm.psi_d_Wb) / (2 * e), f.dq_H, 1e-10);
      EXPECT_NEAR((qp.psi_q_Wb - qm.psi_q_Wb) / (2 * e), f.qq_H, 1e-10);
      // dW = 3/2 i . dpsi
      const double dW = dq_stored_J(m, i_d, i_q + e) - dq_stored_J(m, i_d, i_q - e);
      EXPECT_NEAR(dW / (2 * e), 1.5 * (i_d * f.dq_H + i_q * f.qq_H), 1e-9);
    }
}

TEST(DqMotor, NeutralSaturationChangesNothingBitForBit) {
  PhaseMotor<double> with = salient_motor();
  with.flux_saturation_per_A = 0.0;
  with.inductance_saturation_per_A = 0.0;
  const auto a = run_smooth(salient_motor(), 20e-6), b = run_smooth(with, 20e-6);
  EXPECT_EQ(a.i_q_A, b.i_q_A);
  EXPECT_EQ(a.omega_rotor_rad_s, b.omega_rotor_rad_s);
  with.flux_saturation_per_A = 1e-9;
  with.inductance_saturation_per_A = 1e-9;
  EXPECT_NEAR(run_smooth(with, 20e-6).i_q_A, a.i_q_A, 1e-9);
}

TEST(DqMotor, FluxSaturationWeakensTorqueAsTheEffectOfThatNameSays) {
  PhaseMotor<double> m = sine_motor();
  const double plain = dq_torque_Nm(m, 0.0, 20.0);
  m.flux_saturation_per_A = 1.0 / 40.0;
  EXPECT_NEAR(dq_torque_Nm(m, 0.0, 20.0) / plain, 1.0 / (1.0 + 0.25), 1e-12);
}

TEST(DqMotor, DerivativesAreThoseOfFiniteDifferences) {
  const auto end = [](auto m) {
    using T = decltype(m.resistance_ohm);
    DqState<T> x;
    for (int k = 0; k < 200; ++k)
      advance_dq(m, x, DqInput<T>{.v_d_V = T(-0.5), .v_q_V = T(5.0), .tau_load_Nm = T(0.01)}, 50e-6);
    return x;
  };
  const PhaseMotor<double> base = saturating_motor();
  PhaseMotor<Jet> m;
  m.resistance_ohm = Jet(base.resistance_ohm, 0);
  m.inductance_d_H = Jet(base.inductance_d_H, 1);
  m.inductance_q_H = Jet(base.inductance_q_H, 2);
  m.flux_linkage_Wb = Jet(base.flux_linkage_Wb, 3);
  m.rotor_inertia_kg_m2 = Jet(base.rotor_inertia_kg_m2, 4);
  m.viscous_friction_Nm_s_per_rad = Jet(base.viscous_friction_Nm_s_per_rad, 5);
  m.inductance_saturation_per_A = Jet(base.inductance_saturation_per_A, 6);
  m.flux_saturation_per_A = Jet(base.flux_saturation_per_A, 7);
  m.pole_pairs = base.pole_pairs;
  const auto exact = end(m);
  double PhaseMotor<double>::*const field[8] = {&PhaseMotor<double>::resistance_ohm,
                                                &PhaseMotor<double>::inductance_d_H,
                                                &PhaseMotor<double>::inductance_q_H,
                                                &PhaseMotor<double>::flux_linkage_Wb,
                                                &PhaseMotor<double>::rotor_inertia_kg_m2,
                                                &PhaseMotor<double>::viscous_friction_Nm_s_per_rad,
                                                &PhaseMotor<double>::inductance_saturation_per_A,
                                                &PhaseMotor<double>::flux_saturation_per_A};
  for (int k = 0; k < 8; ++k) {
    const double e = 1e-5 * base.*field[k];
    PhaseMotor<double> up = base, down = base;
    up.*field[k] += e;
    down.*field[k] -= e;
    const double slope = (end(up).i_q_A - end(down).i_q_A) / (2 * e);
    EXPECT_NEAR(exact.i_q_A.v[k], slope, 1e-5 * std::abs(slope) + 1e-6) << k;
    const double turn = (end(up).omega_rotor_rad_s - end(down).omega_rotor_rad_s) / (2 * e);
    EXPECT_NEAR(exact.omega_rotor_rad_s.v[k], turn, 1e-5 * std::abs(turn) + 1e-4) << k;
  }
}

}  // namespace
}  // namespace omnihil
