// A bound of an angle that goes round says nothing against an effect; a bound of another shape does.
#include <gtest/gtest.h>

#include "identify/select/plausibility.h"
#include "sim/law/effect_registry.h"
#include "tests/identify/simulated_robot.h"

namespace omnihil::test {
namespace {

// A fit whose strength is beyond question, with one shape at a bound.
FitResult at_bound(const std::string& strength, const std::string& shape, double bound) {
  FitResult fit;
  fit.model = robot_candidate();
  ParameterEstimate size, angle;
  size.path = strength;
  size.value = 0.02;
  size.sigma = 1e-4;
  angle.path = shape;
  angle.unit = "rad";
  angle.value = bound;
  angle.at_bound = true;
  fit.parameters = {size, angle};
  return fit;
}

TEST(PeriodicBound, SpeaksAgainstNoEffect) {
  const FitResult parent;
  EXPECT_EQ(
      implausibility(parent, at_bound("cogging.amplitude_Nm", "cogging.phase_rad", 6.3), "cogging", false),
      "");
  EXPECT_EQ(implausibility(parent, at_bound("floor_tilt.angle_rad", "floor_tilt.direction_rad", 6.3),
                           "floor_tilt", false),
            "");
}

// Known to 2 pi / sqrt(12) = 1.81 rad is not known at all.
TEST(PeriodicShape, APhaseThatIsNotDeterminedIsNoTorqueOverTheAngle) {
  FitResult fit = at_bound("cogging.amplitude_Nm", "cogging.phase_rad", 1.0);
  fit.parameters.back().at_bound = false;
  fit.parameters.back().sigma = 1.7;
  EXPECT_EQ(implausibility({}, fit, "cogging", true), "");
  fit.parameters.back().sigma = 1.9;
  EXPECT_NE(implausibility({}, fit, "cogging", true), "");
  // a harmonic that is there, beside the main order that is not
  ParameterEstimate second = fit.parameters.back();
  second.path = "cogging.phase_2";
  second.sigma = 0.1;
  fit.parameters.push_back(second);
  EXPECT_EQ(implausibility({}, fit, "cogging", true), "");
}

TEST(PeriodicBound, OfAnotherShapeIsASymptom) {
  EXPECT_EQ(
      implausibility({}, at_bound("wheel_slip.compliance_m_s", "wheel_slip.grip", 2.0), "wheel_slip", false),
      "wheel_slip.grip ends at a bound (2 rad): a symptom, not a result");
}

// The width of a dead time goes to zero where the bridge turns over sharply; at its upper bound it is a resistance.
TEST(SmoothingBound, IsTheSharpLawBelowAndASymptomAbove) {
  EXPECT_EQ(implausibility({}, at_bound("dead_time.voltage_V", "dead_time.current_width_A", 0.001),
                           "dead_time", false),
            "");
  EXPECT_NE(implausibility({}, at_bound("dead_time.voltage_V", "dead_time.current_width_A", 10.0),
                           "dead_time", false),
            "");
}

// The law is of first order in the eccentricity: a tenth of a radian is where it ends, and no disc is so far off its axis.
TEST(StrengthBound, AnEncoderHalfARadianOffItsAxisIsASymptom) {
  FitResult fit;
  fit.model = robot_candidate();
  ParameterEstimate size;
  size.path = "encoder_eccentricity.amplitude_rad";
  size.unit = "rad";
  size.sigma = 1e-3;
  const EffectParam& row = find_effect("encoder_eccentricity")->info->params.front();
  size.value = row.upper;
  size.at_bound = true;
  fit.parameters = {size};
  EXPECT_LE(row.upper * row.upper, 0.01 * (1.0 + 1e-12));  // of second order
  EXPECT_NE(ends_at_bound(fit, "encoder_eccentricity"), "");
  fit.parameters.front().at_bound = false;
  EXPECT_EQ(ends_at_bound(fit, "encoder_eccentricity"), "");
}

}  // namespace
}  // namespace omnihil::test
