#include "sim/drive/phase_motor.h"

#include <gtest/gtest.h>

#include <array>

#include "sim/drive/back_emf.h"
#include "tests/sim/drive/phase_bench.h"

namespace omnihil {
namespace {

TEST(BackEmfShape, SineIsMinusSineOfEachPhasesAngle) {
  for (double deg = -400.0; deg < 400.0; deg += 7.3) {
    const auto f = back_emf_shape(kSine, deg * kDegree);
    for (int x = 0; x < 3; ++x)
      EXPECT_NEAR(f[static_cast<std::size_t>(x)], -std::sin((deg - 120.0 * x) * kDegree), 1e-14);
  }
}

TEST(BackEmfShape, TrapezoidHasItsFlatTopAndStraightRamps) {
  // top of 120 degrees: ramps of 30 degrees; f is negative in the first half turn
  const auto phase_a = [](double deg) { return back_emf_shape(kTrapezoid, deg * kDegree)[0]; };
  EXPECT_NEAR(phase_a(0.0), 0.0, 1e-15);
  EXPECT_NEAR(phase_a(15.0), -0.5, 1e-12);
  EXPECT_NEAR(phase_a(30.0 + 1e-9), -1.0, 1e-9);
  EXPECT_EQ(phase_a(90.0), -1.0);
  EXPECT_NEAR(phase_a(165.0), -0.5, 1e-12);
  EXPECT_NEAR(phase_a(195.0), 0.5, 1e-12);
  EXPECT_EQ(phase_a(270.0), 1.0);
  EXPECT_NEAR(phase_a(345.0), 0.5, 1e-12);
  EXPECT_NEAR(phase_a(-15.0), 0.5, 1e-12);
}

TEST(BackEmfShape, IsOddAndTheOtherPhasesLagBy120Degrees) {
  for (const BackEmf& e : {kSine, kTrapezoid, BackEmf{BackEmfShape::kTrapezoid, 0.0}}) {
    for (double deg = 0.5; deg < 360.0; deg += 11.0) {
      const auto f = back_emf_shape(e, deg * kDegree), back = back_emf_shape(e, -deg * kDegree);
      EXPECT_NEAR(f[0], -back[0], 1e-12);
      EXPECT_NEAR(f[1], back_emf_shape(e, (deg - 120.0) * kDegree)[0], 1e-12);
      EXPECT_NEAR(f[2], back_emf_shape(e, (deg - 240.0) * kDegree)[0], 1e-12);
    }
  }
}

TEST(PhaseMotor, BlockTorqueConstantIsTheMeanOverWhatAPhaseConducts) {
  for (const BackEmf& e : {kSine, kTrapezoid, BackEmf{BackEmfShape::kTrapezoid, 60.0 * kDegree},
                           BackEmf{BackEmfShape::kTrapezoid, 0.0}}) {
    const int n = 120000;
    double sum = 0.0;
    for (int k = 0; k < n; ++k) sum += back_emf_shape(e, (210.0 + 120.0 * (k + 0.5) / n) * kDegree)[0];
    EXPECT_NEAR(mean_block_back_emf(e), sum / n, 1e-8);
  }
}

TEST(PhaseMotor, TerminalValuesAreTwoPhasesInSeries) {
  const MotorParams sheet = sheet_motor();
  const PhaseMotor<double> m = trapezoid_motor();
  EXPECT_DOUBLE_EQ(2.0 * m.resistance_ohm, sheet.resistance_ohm);
  EXPECT_DOUBLE_EQ(m.inductance_d_H + m.inductance_q_H, sheet.inductance_H);
  EXPECT_NEAR(2.0 * 8 * m.flux_linkage_Wb, sheet.torque_constant_Nm_per_A, 1e-15);
  EXPECT_TRUE(problems_of(m).empty());
}

TEST(PhaseMotor, BackAndForthGivesTheSameDcMotor) {
  const MotorParams sheet = sheet_motor();
  for (const Commutation c : {Commutation::kBlock, Commutation::kSinusoidal})
    for (const BackEmf& e : {kSine, kTrapezoid}) {
      const MotorParams dc = dc_equivalent_of(phase_motor_of(sheet, c, e), c, sheet);
      EXPECT_DOUBLE_EQ(dc.resistance_ohm, sheet.resistance_ohm);
      EXPECT_DOUBLE_EQ(dc.inductance_H, sheet.inductance_H);
      EXPECT_NEAR(dc.torque_constant_Nm_per_A, sheet.torque_constant_Nm_per_A, 1e-15);
    }
}

TEST(PhaseMotor, SineMotorUnderBlocksLosesThreeOverPiAgainstItsPeak) {
  // line-to-line peak sqrt(3) p lambda; its mean over 60 degrees around the peak is 3/pi of it
  const double ratio = torque_constant_factor(kSine, Commutation::kBlock) /
                       torque_constant_factor(kSine, Commutation::kSinusoidal);
  EXPECT_NEAR(ratio, 3.0 / std::numbers::pi, 1e-15);
}

TEST(PhaseMotor, EveryProblemIsNamedAtOnce) {
  PhaseMotor<double> m = sine_motor();
  m.resistance_ohm = -1.0;
  m.rotor_inertia_kg_m2 = 0.0;
  m.pole_pairs = 0;
  m.back_emf.flat_top_rad = 4.0;
  m.flux_saturation_per_A = std::nan("");
  const auto problems = problems_of(m);
  ASSERT_EQ(problems.size(), 5u);
  EXPECT_NE(problems[0].find("resistance_ohm = -1"), std::string::npos);
}

}  // namespace
}  // namespace omnihil
