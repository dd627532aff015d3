#include "sim/robot/tyre.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>
#include <string>

#include "sim/robot/integrate.h"
#include "sim/robot/planar.h"
#include "sim/robot/slip.h"
#include "sim/robot/validate.h"
#include "tests/sim/robot/sample_robot.h"

namespace omnihil {
namespace {

constexpr TyreCurve kCurve{0.1, 0.8, 0.4, 0.5};

// Table I of the seed paper taken at its word: eq. (4), F_max = 2 * 1e6 N, whatever the wheel load.
RobotModel table_i_literal() {
  RobotModel m = symmetric_robot();
  m.name = "table I, literal";
  constexpr double kStiffness = 1e6;
  const double load_N = m.mass_kg * 9.80665 / kWheels;
  m.tyre_longitudinal = {0.0001, 2.0 * kStiffness / load_N, 0.0002, 0.01 * kStiffness / load_N};
  m.tyre_lateral = {1.0, 0.002 * kStiffness / load_N, 2.0, 0.001 * kStiffness / load_N};
  return m;
}

// Table I's slips with its extrema as friction coefficients.
RobotModel table_i_coefficients() {
  RobotModel m = symmetric_robot();
  m.name = "table I, coefficients";
  m.center_of_mass_height_m = 0.02;  // with a coefficient of 2 a higher one would tip
  m.tyre_longitudinal = {0.0001, 2.0, 0.0002, 0.01};
  m.tyre_lateral = {1.0, 0.002, 2.0, 0.001};
  return m;
}

// A sliding perturbation of 1 nm/s at standstill after some explicit steps: below 1e-9 it decays.
double perturbation_after(const RobotModel& m, double step_s, int steps) {
  PlanarMechanics back({m});
  std::vector<double> q(planar_layout(kWheels).q_per_robot), u(planar_layout(kWheels).u_per_robot);
  u = {0.0, 1e-9, 0.7e-9, 1e-8, -2e-8, 3e-8, 0.5e-8};
  IntegratorScratch scratch(q.size(), u.size());
  const std::vector<WheelTorques> free_wheels(1);
  for (int n = 0; n < steps; ++n) {
    back.set_state(q, u);
    step_semi_implicit_euler(back, free_wheels, step_s, q, u, scratch);
  }
  back.set_state(q, u);
  double worst = 0.0;
  for (double slip : back.contacts(0).slip_longitudinal_ratio) worst = std::max(worst, std::abs(slip));
  return worst * m.slip_speed_floor_m_s;
}

TEST(Tyre, PassesThroughExtremumAndAsymptoteAndStaysThere) {
  EXPECT_DOUBLE_EQ(grip(kCurve, 0.1), 0.8);
  EXPECT_DOUBLE_EQ(grip(kCurve, 0.4), 0.5);
  EXPECT_DOUBLE_EQ(grip(kCurve, 1.7), 0.5);
  EXPECT_DOUBLE_EQ(grip(kCurve, 0.0), 0.0);
}

TEST(Tyre, IsOddAndNeverAboveItsExtremum) {
  for (double slip = 0.0; slip < 2.0; slip += 0.001) {
    EXPECT_DOUBLE_EQ(grip(kCurve, -slip), -grip(kCurve, slip));
    EXPECT_LE(grip(kCurve, slip), 0.8);
    EXPECT_GE(grip(kCurve, slip), 0.0);
  }
}

TEST(Tyre, SlopeIsContinuousAtEveryJoint) {
  const double h = 1e-7;
  for (double joint : {0.0, 0.1, 0.4}) {
    const double below = (grip(kCurve, joint) - grip(kCurve, joint - h)) / h;
    const double above = (grip(kCurve, joint + h) - grip(kCurve, joint)) / h;
    EXPECT_NEAR(below, above, 1e-4) << "at slip " << joint;
  }
  EXPECT_NEAR((grip(kCurve, h) - grip(kCurve, 0.0)) / h, steepest_grip(kCurve), 1e-4);
}

TEST(Slip, IsThePrintedEquationWhereItIsPrinted) {
  EXPECT_DOUBLE_EQ(slip_ratio(2.0, 1.5, 0.1), 1.0 - 1.5 / 2.0);   // v > R omega > 0
  EXPECT_DOUBLE_EQ(slip_ratio(1.5, 2.0, 0.1), -1.0 + 1.5 / 2.0);  // R omega > v > 0
}

TEST(Slip, IsOddInBothSpeedsForEveryCombinationOfSigns) {
  for (double v : {-2.0, -0.3, 0.0, 0.01, 1.0}) {
    for (double rim : {-1.0, -0.01, 0.0, 0.5, 3.0}) {
      EXPECT_DOUBLE_EQ(slip_ratio(-v, -rim, 0.2), -slip_ratio(v, rim, 0.2));
      EXPECT_LE(std::abs(slip_ratio(v, rim, 0.2)), v * rim >= 0.0 ? 1.0 : 2.0);
      EXPECT_EQ(slip_ratio(v, rim, 0.2) > 0.0, v > rim);
    }
  }
}

TEST(Slip, IsZeroForRollingAndAtStandstillAndProportionalBelowTheFloor) {
  EXPECT_EQ(slip_ratio(1.7, 1.7, 0.2), 0.0);
  EXPECT_EQ(slip_ratio(0.0, 0.0, 0.2), 0.0);
  EXPECT_DOUBLE_EQ(slip_ratio(0.01, 0.0, 0.2), 0.05);
  EXPECT_DOUBLE_EQ(slip_ratio(0.01, -0.01, 0.2), 0.1);
}

TEST(Slip, IsContinuousAcrossTheFloorAndAcrossEqualSpeeds) {
  for (double v : {0.2, -0.2, 1.0}) {
    EXPECT_NEAR(slip_ratio(v * (1 - 1e-9), 0.5, 0.2), slip_ratio(v * (1 + 1e-9), 0.5, 0.2), 1e-8);
  }
}

TEST(Stability, ExplicitStepsDecayJustBelowTheBoundAndGrowJustAbove) {
  for (const RobotModel& m : {sample_robot(), symmetric_robot(), table_i_coefficients()}) {
    const double bound_s = explicit_limit(Integrator::kSemiImplicitEuler) / stiffest_contact_rate(m);
    EXPECT_LT(perturbation_after(m, 0.95 * bound_s, 200), 1e-9) << m.name;
    // loads are not all the largest one, so the bound is a little on the safe side
    EXPECT_GT(perturbation_after(m, 1.30 * bound_s, 200), 1e-6) << m.name;
  }
}

TEST(Stability, DefaultTyreIsStableAtOneMillisecond) {
  for (const RobotModel& m : {sample_robot(), symmetric_robot()}) {
    EXPECT_LT(stiffest_contact_rate(m) * 1e-3, explicit_limit(Integrator::kSemiImplicitEuler)) << m.name;
  }
}

TEST(TableI, LiteralValuesNeedStepsFarBelowAMicrosecondAndExplodeAtOneMillisecond) {
  const RobotModel m = table_i_literal();
  const double longest_s = explicit_limit(Integrator::kSemiImplicitEuler) / stiffest_contact_rate(m);
  // 1.5 * 2e6 N / (0.0001 * 0.5 m/s) = 6e10 N s/m on about 0.1 kg
  EXPECT_LT(longest_s, 1e-11);
  EXPECT_GT(longest_s, 1e-13);
  EXPECT_GT(perturbation_after(m, 1e-3, 3), 0.1);  // m/s, out of 1 nm/s
}

TEST(TableI, ItsSlipsWithFrictionCoefficientsStillNeedStepsBelowAMicrosecond) {
  const double longest_s =
      explicit_limit(Integrator::kSemiImplicitEuler) / stiffest_contact_rate(table_i_coefficients());
  EXPECT_LT(longest_s, 1e-6);
  EXPECT_GT(perturbation_after(table_i_coefficients(), 1e-3, 3), 1e-6);
}

TEST(TableI, ThePlantRefusesItAndNamesTheLongestStep) {
  try {
    one_robot(table_i_coefficients(), planar_options());
    FAIL() << "accepted";
  } catch (const std::invalid_argument& e) {
    EXPECT_NE(std::string(e.what()).find("too stiff for mechanical_step_ns"), std::string::npos) << e.what();
    EXPECT_NE(std::string(e.what()).find("the step must be below"), std::string::npos) << e.what();
  }
}

}  // namespace
}  // namespace omnihil
