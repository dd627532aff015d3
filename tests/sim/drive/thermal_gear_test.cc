#include <gtest/gtest.h>

#include "sim/drive/gear.h"
#include "sim/drive/thermal.h"
#include "sim/law/scalar.h"

namespace omnihil {
namespace {

// A 50 W flat motor's data sheet: 1.57 and 8.28 K/W, 28.8 and 78.3 s.
ThermalParams<double> sheet_thermal() { return thermal_of_datasheet(1.57, 8.28, 28.8, 78.3); }

TEST(Thermal, SteadyRiseIsHeatTimesResistances) {
  const auto p = sheet_thermal();
  ThermalState<double> s;
  for (int k = 0; k < 1000; ++k) advance_thermal(p, s, 4.0, 10.0);
  EXPECT_NEAR(s.winding_K, 4.0 * (1.57 + 8.28), 1e-6);
  EXPECT_NEAR(s.housing_K, 4.0 * 8.28, 1e-6);
}

TEST(Thermal, StepLengthDoesNotMatterForHeldHeat) {
  const auto p = sheet_thermal();
  ThermalState<double> one, many;
  advance_thermal(p, one, 5.0, 40.0);
  for (int k = 0; k < 400; ++k) advance_thermal(p, many, 5.0, 0.1);
  EXPECT_NEAR(one.winding_K, many.winding_K, 1e-10);
  EXPECT_NEAR(one.housing_K, many.housing_K, 1e-10);
}

TEST(Thermal, EnergyIsInTheMassesOrGoneToTheAir) {
  const auto p = sheet_thermal();
  ThermalState<double> s;
  double lost_J = 0.0;
  const double h = 0.001;
  for (int k = 0; k < 60000; ++k) {
    const double before = s.housing_K;
    advance_thermal(p, s, 6.0, h);
    lost_J += 0.5 * (before + s.housing_K) / p.housing_to_ambient_K_per_W * h;
  }
  const double kept_J = p.winding_J_per_K * s.winding_K + p.housing_J_per_K * s.housing_K;
  EXPECT_NEAR(kept_J + lost_J, 6.0 * 60.0, 1e-6 * 360.0);
}

TEST(Thermal, FirstSecondsHeatTheWindingAlone) {
  const auto p = sheet_thermal();
  ThermalState<double> s;
  advance_thermal(p, s, 10.0, 0.1);
  EXPECT_NEAR(s.winding_K, 10.0 * 0.1 / p.winding_J_per_K, 0.01 * s.winding_K);
  EXPECT_LT(s.housing_K, 0.01 * s.winding_K);
}

TEST(Thermal, CopperAndMagnetsFollowTheirCoefficients) {
  EXPECT_NEAR(warm_resistance_ohm(0.447, kCopperPerK, 60.0) / 0.447, 1.2358, 1e-4);
  EXPECT_NEAR(warm_flux_Wb(0.002, kNeodymiumPerK, 60.0) / 0.002, 0.934, 1e-12);
}

TEST(Thermal, DerivativesAreThoseOfFiniteDifferences) {
  const auto end = [](auto r_wh, auto c_h) {
    using T = decltype(r_wh);
    const ThermalParams<T> p{r_wh, T(8.28), T(18.0), c_h};
    ThermalState<T> s;
    for (int k = 0; k < 30; ++k) advance_thermal(p, s, T(5.0), 1.0);
    return s.winding_K;
  };
  const Jet exact = end(Jet(1.57, 0), Jet(9.5, 1));
  const double e = 1e-5;
  EXPECT_NEAR(exact.v[0], (end(1.57 + e, 9.5) - end(1.57 - e, 9.5)) / (2 * e), 1e-6);
  EXPECT_NEAR(exact.v[1], (end(1.57, 9.5 + e) - end(1.57, 9.5 - e)) / (2 * e), 1e-6);
}

const GearParams<double> kLossy{.ratio = 3, .drive_efficiency = 0.95, .backdrive_efficiency = 0.9};

TEST(Gear, LosesInEitherDirectionOfPower) {
  for (const double omega : {-50.0, 50.0})
    for (const double tau : {-0.1, 0.1}) {
      const double out = gear_output_Nm(kLossy, tau, omega);
      const double p_in = tau * omega, p_out = out * omega / 3.0;
      if (p_in > 0)
        EXPECT_NEAR(p_out, 0.95 * p_in, 1e-12);
      else
        EXPECT_NEAR(0.9 * p_out, p_in, 1e-12);  // more comes from the load than reaches the rotor
      EXPECT_LE(p_out, p_in + 1e-15);
      EXPECT_NEAR(gear_rotor_Nm(kLossy, out, omega), tau, 1e-15);
    }
}

TEST(Gear, ShaftCarriesNothingInThePlayAndNeverPulls) {
  const GearParams<double> g{
      .ratio = 3, .gap_rad = 0.01, .stiffness_Nm_per_rad = 100, .damping_Nm_s_per_rad = 0.1};
  EXPECT_EQ(shaft_torque_Nm(g, 0.0049, 3.0), 0.0);
  EXPECT_NEAR(shaft_torque_Nm(g, 0.007, 0.0), 100 * 0.002, 1e-12);
  EXPECT_NEAR(shaft_torque_Nm(g, -0.007, 0.0), -100 * 0.002, 1e-12);
  EXPECT_EQ(shaft_torque_Nm(g, 0.0051, -10.0), 0.0);
}

TEST(Gear, TwoMassesSwingAtTheClosedFormsFrequencyAndKeepTheirEnergy) {
  const GearParams<double> g{.ratio = 3, .stiffness_Nm_per_rad = 50};
  const GearMasses<double> m{.rotor_kg_m2 = 1e-5, .output_kg_m2 = 4e-4};
  GearState<double> s;
  s.omega_output_rad_s = 1.0;
  // reduced inertia at the output: 1 / (1 / (N^2 J_r) + 1 / J_o)
  const double reduced = 1.0 / (1.0 / (9 * 1e-5) + 1.0 / 4e-4), omega = std::sqrt(50 / reduced);
  const auto energy = [&] {
    const double twist = s.theta_rotor_rad / 3 - s.theta_output_rad;
    return 0.5 * (1e-5 * s.omega_rotor_rad_s * s.omega_rotor_rad_s +
                  4e-4 * s.omega_output_rad_s * s.omega_output_rad_s + 50 * twist * twist);
  };
  s.side = 1;
  const double before = energy(), h = 2e-6;
  int crossings = 0;
  double first = 0.0, last = 0.0, previous = 0.0;
  for (int k = 1; k < 200000; ++k) {
    advance_gear(g, m, s, 0.0, 0.0, h);
    const double twist = s.theta_rotor_rad / 3 - s.theta_output_rad;
    if (previous < 0.0 && twist >= 0.0) {
      if (crossings++ == 0) first = k * h;
      last = k * h;
    }
    previous = twist;
  }
  EXPECT_NEAR(energy(), before, 1e-9 * before);
  EXPECT_NEAR(2 * std::numbers::pi * (crossings - 1) / (last - first), omega, 1e-3 * omega);
}

TEST(Gear, ReversalCrossesThePlayBeforeTheLoadMoves) {
  const GearParams<double> g{
      .ratio = 3, .gap_rad = 0.02, .stiffness_Nm_per_rad = 200, .damping_Nm_s_per_rad = 0.2};
  const GearMasses<double> m{.rotor_kg_m2 = 1e-5, .output_kg_m2 = 4e-4};
  GearState<double> s;
  s.theta_rotor_rad = 3 * 0.01;  // at the play's positive end
  const double tau = -0.02, h = 10e-6;
  double free_s = 0.0;
  while (s.omega_output_rad_s == 0.0 && free_s < 1.0) {
    advance_gear(g, m, s, tau, 0.0, h);
    free_s += h;
  }
  // the rotor falls through 3 * 0.02 rad alone: t = sqrt(2 * 0.06 J / tau)
  EXPECT_NEAR(free_s, std::sqrt(2 * 0.06 * 1e-5 / 0.02), 3 * h);
}

TEST(Gear, StiffShaftIsTheRigidGear) {
  const GearParams<double> g{
      .ratio = 3, .drive_efficiency = 0.95, .stiffness_Nm_per_rad = 1e6, .damping_Nm_s_per_rad = 50};
  const GearMasses<double> m{.rotor_kg_m2 = 1e-5, .output_kg_m2 = 4e-4};
  GearState<double> s;
  s.omega_rotor_rad_s = 0.03, s.omega_output_rad_s = 0.01;
  s.side = 1;
  for (int k = 0; k < 2000; ++k) advance_gear(g, m, s, 0.02, 0.0, 50e-6);
  // (N^2 eta J_r + J_o) a_out = N eta tau
  const double a_out = 3 * 0.95 * 0.02 / (9 * 0.95 * 1e-5 + 4e-4);
  EXPECT_NEAR(s.omega_output_rad_s, a_out * 0.1, 0.002 * a_out * 0.1);
  EXPECT_NEAR(s.omega_rotor_rad_s, 3 * s.omega_output_rad_s, 1e-4 * s.omega_rotor_rad_s);
}

}  // namespace
}  // namespace omnihil
