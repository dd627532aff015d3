#include "identify/select/plausibility.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <optional>

#include "tests/identify/select/acceptance_fixture.h"

namespace omnihil {
namespace {

// Four microseconds at 1 kHz: the model's own sub-steps make as much.
TEST(PlausibilityTest, RefusesATimeBelowTheResolution) {
  AcceptanceFixture fixture;
  fixture.context.resolution.rate_Hz = 1000.0;
  Fitted child = fixture.leaving(0.7, 0.7, 0.7);
  ParameterEstimate delay;
  delay.path = "actuator_delay.delay_s";
  delay.unit = "s";
  delay.value = 4e-6;
  delay.sigma = 1e-7;
  child.fit.parameters = {delay};
  const AcceptanceResult lost =
      test_acceptance(fixture.context, fixture.leaving(1, 1, 1), child, "actuator_delay", 100);
  EXPECT_FALSE(lost.accepted());
  EXPECT_NE(lost.why.find("below the time resolution"), std::string::npos) << lost.why;
  child.fit.parameters[0].value = 4e-5;
  EXPECT_TRUE(
      test_acceptance(fixture.context, fixture.leaving(1, 1, 1), child, "actuator_delay", 100).accepted());
  // nor within a period of a loop that is described in place of its firmware
  fixture.context.resolution.loop_period_s = 1e-3;
  const AcceptanceResult within =
      test_acceptance(fixture.context, fixture.leaving(1, 1, 1), child, "actuator_delay", 100);
  EXPECT_FALSE(within.accepted());
  EXPECT_NE(within.why.find("a period of the speed loop"), std::string::npos) << within.why;
}

// A hundredth of a count of play: what a contact's compliance made up for.
TEST(PlausibilityTest, RefusesAPlayFarBelowTheEncodersResolution) {
  AcceptanceFixture fixture;
  fixture.context.resolution.rate_Hz = 1000.0;
  Fitted child = fixture.leaving(0.7, 0.7, 0.7);
  ParameterEstimate gap;
  gap.path = "backlash.gap_rad";
  gap.unit = "rad";
  gap.value = 2.7e-5;
  gap.sigma = 5e-6;
  child.fit.parameters = {gap};
  const auto with = [&](double counts, double gap_rad) {
    fixture.context.resolution.counts_per_rotor_turn = counts;
    child.fit.parameters[0].value = gap_rad;
    return test_acceptance(fixture.context, fixture.leaving(1, 1, 1), child, "backlash", 100);
  };
  EXPECT_FALSE(with(4096, 2.7e-5).accepted());
  EXPECT_NE(with(4096, 2.7e-5).why.find("below the angle resolution"), std::string::npos);
  EXPECT_TRUE(with(4096, 2e-4).accepted()) << "many reversals tell less than a count";
  EXPECT_TRUE(with(0, 2.7e-5).accepted()) << "no encoder, no counts";
}

// Critical: 2 sqrt(3 N m/rad x 3e-5 kg m2) = 0.019 N m s/rad.
TEST(PlausibilityTest, RefusesBristlesThatAreALag) {
  const AcceptanceFixture fixture;
  const auto with = [&](double damping_Nm_s_per_rad) {
    Fitted child = fixture.leaving(0.7, 0.7, 0.7);
    EXPECT_EQ(set_value(child.fit.model, "motor.rotor_inertia_kg_m2", 3e-5), "");
    EXPECT_EQ(set_value(child.fit.model, "load.inertia_kg_m2", 0.0), "");
    ParameterEstimate stiffness, damping;
    stiffness.path = "lugre_friction.stiffness_Nm_per_rad";
    stiffness.value = 3.0;
    damping.path = "lugre_friction.damping_Nm_s_per_rad";
    damping.value = damping_Nm_s_per_rad;
    child.fit.parameters = {stiffness, damping};
    return test_acceptance(fixture.context, fixture.leaving(1, 1, 1), child, "lugre_friction", 100);
  };
  EXPECT_TRUE(with(0.04).accepted()) << with(0.04).why;
  EXPECT_FALSE(with(0.2).accepted());
  EXPECT_NE(with(0.2).why.find("a lag, not a spring"), std::string::npos) << with(0.2).why;
}

TEST(PlausibilityTest, RefusesABaseParameterThatIsPushedOutOfItsTolerance) {
  const AcceptanceFixture fixture;
  Fitted parent = fixture.leaving(1, 1, 1), child = fixture.leaving(0.7, 0.7, 0.7);
  ParameterEstimate r;
  r.path = "motor.resistance_ohm";
  r.prior_sigma = 0.1;
  r.prior_deviation_sigmas = 1.0;
  parent.fit.parameters = {r};
  r.prior_deviation_sigmas = -5.0;
  child.fit.parameters = {r};
  const AcceptanceResult j = test_acceptance(fixture.context, parent, child, "x", 100);
  EXPECT_FALSE(j.accepted());
  EXPECT_NE(j.why.find("motor.resistance_ohm"), std::string::npos) << j.why;
}

// A tolerance of 30 % puts a bound of zero at 3.3 standard deviations: no limit beyond that would ever refuse it.
TEST(PlausibilityTest, RefusesWhatTakesABaseParametersPlace) {
  const AcceptanceFixture fixture;
  const auto accepted = [&](double before_sigmas, double after_sigmas, bool bound_before) {
    Fitted parent = fixture.leaving(1, 1, 1), child = fixture.leaving(0.7, 0.7, 0.7);
    ParameterEstimate friction;
    friction.path = "coulomb_friction.torque_Nm";
    friction.prior_sigma = 0.3;
    friction.prior_deviation_sigmas = before_sigmas;
    friction.at_bound = bound_before;
    parent.fit.parameters = {friction};
    friction.prior_deviation_sigmas = after_sigmas;
    friction.at_bound = true;
    child.fit.parameters = {friction};
    return test_acceptance(fixture.context, parent, child, "grease_drag", 100).accepted();
  };
  EXPECT_FALSE(accepted(0.5, -3.33, false));
  EXPECT_TRUE(accepted(-3.33, -3.33, true));  // it was there before
  EXPECT_TRUE(accepted(0.0, -1.0, false));    // a belief so vague that zero is within it
}

// What its prior rejects without the addition too (p < 1 %) absorbs something else: no reason against a decisive gain.
TEST(PlausibilityTest, ABaseParameterThatWasBentBeforeIsNoReasonAgainstADecisiveGain) {
  AcceptanceFixture fixture;
  const Fitted parent = fixture.leaving(1, 1, 1);
  FitResult base;
  const auto accepted = [&](double before_sigmas, double left, std::optional<double> at_first_sigmas = {}) {
    ParameterEstimate inductance;
    inductance.path = "motor.inductance_H";
    inductance.prior_sigma = 1e-4;
    inductance.prior_deviation_sigmas = at_first_sigmas.value_or(0.0);
    base.parameters = {inductance};
    fixture.context.base_fit = at_first_sigmas ? &base : nullptr;
    inductance.prior_deviation_sigmas = before_sigmas;
    Fitted bent = parent, child = fixture.leaving(left, left, left);
    bent.fit.parameters = {inductance};
    inductance.prior_deviation_sigmas = 5.9;
    child.fit.parameters = {inductance};
    return test_acceptance(fixture.context, bent, child, "x", 100).accepted();
  };
  EXPECT_TRUE(accepted(3.1, 0.7));   // 51 % of the energy
  EXPECT_FALSE(accepted(3.1, 0.9));  // 19 %: not decisive
  EXPECT_FALSE(accepted(1.9, 0.7));  // not rejected before
  EXPECT_TRUE(accepted(3.1, 0.7, 2.6));
  EXPECT_FALSE(accepted(3.1, 0.7, 0.5));  // an effect found before this one bent it
  base.parameters.clear();                // a number of such an effect, which the base fit does not have
  const FitResult without = base;
  fixture.context.base_fit = &without;
  ParameterEstimate strength;
  strength.path = "stribeck_friction.extra_torque_Nm";
  strength.prior_sigma = 1e-3;
  strength.prior_deviation_sigmas = 6.8;
  Fitted larger = parent, child = fixture.leaving(0.3, 0.3, 0.3);
  larger.fit.parameters = {strength};
  strength.prior_deviation_sigmas = 8.2;
  child.fit.parameters = {strength};
  EXPECT_TRUE(test_acceptance(fixture.context, larger, child, "x", 100).accepted());
}

TEST(PlausibilityTest, ReadsAParameterAtItsBoundAsASymptom) {
  const AcceptanceFixture fixture;
  Fitted child = fixture.leaving(0.7, 0.7, 0.7);
  ParameterEstimate p;
  p.path = "quadratic_drag.coefficient_Nm_s2_per_rad2";
  p.value = 1.0;
  p.sigma = 1e-3;
  p.at_bound = true;
  child.fit.parameters = {p};
  const AcceptanceResult j =
      test_acceptance(fixture.context, fixture.leaving(1, 1, 1), child, "quadratic_drag", 100);
  EXPECT_FALSE(j.accepted());
  EXPECT_NE(j.why.find("symptom"), std::string::npos) << j.why;
}

TEST(PlausibilityTest, RefusesAStrengthThatIsNotSignificant) {
  const AcceptanceFixture fixture;
  Fitted child = fixture.leaving(0.9, 0.9, 0.9);
  ParameterEstimate p;
  p.path = "lugre_friction.static_torque_Nm";
  p.value = 5e-5;
  p.sigma = 8e-5;
  child.fit.parameters = {p};
  EXPECT_FALSE(
      test_acceptance(fixture.context, fixture.leaving(1, 1, 1), child, "lugre_friction", 100).accepted());
}

// Four wheels' ratios share their scale with the wheels' radius: each is known to 4 parts in a thousand, what
// parts them to one in ten thousand.
TEST(PlausibilityTest, CorrelatedStrengthsAreTestedJointly) {
  const AcceptanceFixture fixture;
  Fitted child = fixture.leaving(0.9, 0.9, 0.9);
  const std::vector<double> ratios = {0.999, 1.002, 1.0, 0.999};
  constexpr double kShared = 4e-3, kOwn = 1e-4;
  for (std::size_t i = 0; i < 4; ++i) {
    ParameterEstimate p;
    p.path = "wheel_radius_mismatch.ratio_" + std::to_string(i + 1);
    p.value = ratios[i];
    p.sigma = kShared;
    child.fit.parameters.push_back(p);
  }
  child.fit.covariance = Eigen::MatrixXd::Constant(4, 4, kShared * kShared);
  child.fit.covariance.diagonal().array() += kOwn * kOwn;
  EXPECT_TRUE(test_acceptance(fixture.context, fixture.leaving(1, 1, 1), child, "wheel_radius_mismatch", 100)
                  .accepted());
  // a common scale alone is the wheels' radius
  for (ParameterEstimate& p : child.fit.parameters) p.value = 1.002;
  EXPECT_FALSE(test_acceptance(fixture.context, fixture.leaving(1, 1, 1), child, "wheel_radius_mismatch", 100)
                   .accepted());
}

// A low pass by a firmware's loop: 12 ms in all are known to 1 ms, what of them is the loop's half period is not.
TEST(PlausibilityTest, ALoopsPeriodIsTestedWithItsTimeConstant) {
  const AcceptanceFixture fixture;
  Fitted child = fixture.leaving(0.9, 0.9, 0.9);
  constexpr double kSum = 1e-3, kParts = 20e-3;
  for (const auto& [name, value] : {std::pair{"time_constant_s", 7e-3}, {"loop_period_s", 10e-3}}) {
    ParameterEstimate p;
    p.path = std::string("speed_low_pass.") + name;
    p.value = value;
    p.sigma = kParts;
    child.fit.parameters.push_back(p);
  }
  // of tau and P: tau + P / 2 has kSum, what is across has kParts
  const Eigen::Vector2d along(1.0, 0.5), across(-0.5, 1.0);
  child.fit.covariance =
      kSum * kSum * along * along.transpose() + kParts * kParts * across * across.transpose();
  EXPECT_TRUE(
      test_acceptance(fixture.context, fixture.leaving(1, 1, 1), child, "speed_low_pass", 100).accepted());
  child.fit.covariance *= 400.0;
  EXPECT_FALSE(
      test_acceptance(fixture.context, fixture.leaving(1, 1, 1), child, "speed_low_pass", 100).accepted());
}

}  // namespace
}  // namespace omnihil
