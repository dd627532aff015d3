#include "identify/select/acceptance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "identify/estimate/linear_base.h"
#include "sim/law/effect_registry.h"
#include "tests/identify/select/acceptance_fixture.h"

namespace omnihil {
namespace {

TEST(AcceptanceTest, TakesWhatGainsEverywhere) {
  const AcceptanceFixture fixture;
  EXPECT_TRUE(
      test_acceptance(fixture.context, fixture.leaving(1, 1, 1), fixture.leaving(0.7, 0.7, 0.7), "x", 100)
          .accepted());
}

TEST(AcceptanceTest, RefusesATrainingGainWithAHeldOutLoss) {
  const AcceptanceFixture fixture;
  const AcceptanceResult j =
      test_acceptance(fixture.context, fixture.leaving(1, 1, 1), fixture.leaving(0.9, 1.1, 1), "x", 100);
  EXPECT_FALSE(j.accepted());
  EXPECT_NE(j.why.find("raises the held-out"), std::string::npos) << j.why;
}

// Energies: 100 of the base model's over a noise of 0.01, 1 and 0.64 with what was found: the second removes 0.36 %.
TEST(AcceptanceTest, RefusesWhatTheFormOfAnEffectFoundMayLeave) {
  AcceptanceFixture fixture;
  for (auto& level : fixture.null.mean_square) level = Eigen::MatrixXd::Constant(2, 1, 0.01);
  const Fitted base = fixture.leaving(10, 10, 10), found = fixture.leaving(1, 1, 1);
  EXPECT_TRUE(test_acceptance(fixture.context, found, fixture.leaving(0.8, 0.8, 0.8), "x", 100).accepted());
  fixture.context.base = &base.residual;
  const AcceptanceResult small =
      test_acceptance(fixture.context, found, fixture.leaving(0.8, 0.8, 0.8), "x", 100);
  EXPECT_FALSE(small.accepted());
  EXPECT_NE(small.why.find("0.36 % of what the base model left"), std::string::npos) << small.why;
}

// 4 - 2.56 = 1.44 % of the base model's; and 1 - 0.04 = 96 % of what was left.
TEST(AcceptanceTest, TakesASecondEffectThatIsMoreThanTheFormOfTheFirst) {
  AcceptanceFixture fixture;
  for (auto& level : fixture.null.mean_square) level = Eigen::MatrixXd::Constant(2, 1, 0.01);
  const Fitted base = fixture.leaving(10, 10, 10);
  fixture.context.base = &base.residual;
  EXPECT_TRUE(
      test_acceptance(fixture.context, fixture.leaving(2, 2, 2), fixture.leaving(1.6, 1.6, 1.6), "x", 100)
          .accepted());
  EXPECT_TRUE(
      test_acceptance(fixture.context, fixture.leaving(1, 1, 1), fixture.leaving(0.2, 0.2, 0.2), "x", 100)
          .accepted());
}

Candidate with_effect(std::string_view id, double strength) {
  Candidate model;
  model.effects.push_back(neutral_use(*find_effect(id)));
  model.effects.back().values[0] = strength;
  return model;
}

// Of 1, a hundredth of what the base model left: a drag with another power of the speed than the square leaves as much, and a second
// drag takes nearly all of it. An effect elsewhere, or beside one that the user declared, is no correction of that form.
TEST(AcceptanceTest, RefusesASecondLawOfTheSameQuantityThatTakesWhatTheFormOfTheFirstLeft) {
  AcceptanceFixture fixture;
  for (auto& level : fixture.null.mean_square) level = Eigen::MatrixXd::Constant(2, 1, 0.01);
  const Fitted base = fixture.leaving(10, 10, 10);
  const Candidate declared = with_effect("quadratic_drag", 1e-8);
  FitResult without, with;
  with.model = declared;
  fixture.context.base = &base.residual;
  fixture.context.base_fit = &without;
  Fitted found = fixture.leaving(0.9, 0.9, 0.9);
  found.fit.model = declared;
  const auto second = [&](const std::string& name) {
    return test_acceptance(fixture.context, found, fixture.leaving(0.2, 0.2, 0.2), name, 100);
  };
  const AcceptanceResult kin = second("grease_drag");
  EXPECT_FALSE(kin.accepted());
  EXPECT_NE(kin.why.find("the form of an effect already found"), std::string::npos) << kin.why;
  EXPECT_TRUE(second("encoder_eccentricity").accepted());
  EXPECT_TRUE(second("cogging").accepted()) << "a torque of the angle is no form of one of the speed";
  fixture.context.base_fit = &with;
  EXPECT_TRUE(second("grease_drag").accepted());
}

// Half of the whitened energy, which is that of a position, and next to nothing of a speed.
TEST(AcceptanceTest, RefusesWhatMovesASignalByLessThanItsScaleIsKnown) {
  AcceptanceFixture fixture;
  const auto with = [&](double fall) {  // of the unweighted energy
    Fitted child = fixture.leaving(0.7, 0.7, 0.7);
    for (std::size_t u = 0; u < kSplits; ++u)
      child.unweighted[u] = fixture.leaving(1, 1, 1).unweighted[u] * (1.0 - fall);
    return test_acceptance(fixture.context, fixture.leaving(1, 1, 1), child, "x", 100);
  };
  EXPECT_TRUE(with(0.01).accepted()) << "a deviation that is not known";
  fixture.context.signal_variance.fill(Eigen::VectorXd::Constant(1, 1e5));  // 0.03 % of the deviation
  const AcceptanceResult little = with(0.01);
  EXPECT_FALSE(little.accepted());
  EXPECT_NE(little.why.find("of its standard deviation"), std::string::npos) << little.why;
  EXPECT_TRUE(with(0.02).accepted()) << "the plain error falls";
  fixture.context.signal_variance.fill(Eigen::VectorXd::Constant(1, 1e3));  // 0.3 %
  EXPECT_TRUE(with(0.01).accepted());
  // A drive that friction nearly holds: its position is right at last, and its speed starts and stops at other instants.
  fixture.context.signal_variance.fill(Eigen::VectorXd::Constant(1, 2.0));
  EXPECT_TRUE(with(-0.06).accepted()) << with(-0.06).why;
}

TEST(AcceptanceTest, RefusesALossOnAnotherKindOfMotion) {
  const AcceptanceFixture fixture;
  const AcceptanceResult j =
      test_acceptance(fixture.context, fixture.leaving(1, 1, 1), fixture.leaving(0.8, 0.8, 1.2), "x", 100);
  EXPECT_FALSE(j.accepted());
  EXPECT_NE(j.why.find("extrapolation"), std::string::npos) << j.why;
}

// Below what the simulated null leaves there, a rise is chance.
TEST(AcceptanceTest, AllowsARiseOnAnotherKindOfMotionThatTheNullLeavesAsWell) {
  AcceptanceFixture fixture;
  fixture.null.mean_square[kExtrapolation] = Eigen::MatrixXd::Constant(2, 1, 2.0);
  EXPECT_TRUE(
      test_acceptance(fixture.context, fixture.leaving(1, 1, 1), fixture.leaving(0.8, 0.8, 1.2), "x", 100)
          .accepted());
  EXPECT_FALSE(
      test_acceptance(fixture.context, fixture.leaving(1, 1, 1), fixture.leaving(0.8, 0.8, 1.6), "x", 100)
          .accepted());
}

// Noise of 1, and a tenth of its energy above it: what takes most of that away is what was missing, though it is little of the
// whole. Half of it is not enough, nor is all of what is no structure.
TEST(AcceptanceTest, TakesWhatExplainsNearlyAllStructureHoweverNoisyTheRestIs) {
  AcceptanceFixture fixture;
  for (auto& level : fixture.null.mean_square) level = Eigen::MatrixXd::Constant(2, 1, 1.0);
  const double of_noise = fixture.leaving(1.0, 1.0, 1.0).unweighted[kValidation][0];
  const auto by_energy = [&](double fit, double held_out) {
    return fixture.leaving(std::sqrt(fit / of_noise), std::sqrt(held_out / of_noise), 1.0);
  };
  const Fitted parent = by_energy(1.105, 1.105);
  EXPECT_FALSE(test_acceptance(fixture.context, parent, by_energy(1.094, 1.03), "x", 100).accepted());
  fixture.context.structure_remains = true;
  const AcceptanceResult all = test_acceptance(fixture.context, parent, by_energy(1.094, 1.03), "x", 100);
  EXPECT_TRUE(all.accepted()) << all.why;
  const AcceptanceResult half = test_acceptance(fixture.context, parent, by_energy(1.05, 1.05), "x", 100);
  EXPECT_FALSE(half.accepted());
  EXPECT_NE(half.why.find("is required"), std::string::npos) << half.why;
  EXPECT_FALSE(test_acceptance(fixture.context, by_energy(1.045, 1.045), by_energy(1.001, 1.001), "x", 100)
                   .accepted());
}

// The first of two effects that made up for each other raises the error of the motion in which they did so.
TEST(AcceptanceTest, AllowsARiseOnAnotherKindOfMotionThatIsSmallBesideTheHeldOutFall) {
  const AcceptanceFixture fixture;
  // energies: 0.16 * 1.44 = 0.23 of both kinds of motion left; 0.16 * 3.61 = 0.58
  EXPECT_TRUE(
      test_acceptance(fixture.context, fixture.leaving(1, 1, 1), fixture.leaving(0.4, 0.4, 1.2), "x", 100)
          .accepted());
  EXPECT_FALSE(
      test_acceptance(fixture.context, fixture.leaving(1, 1, 1), fixture.leaving(0.4, 0.4, 1.9), "x", 100)
          .accepted());
}

// Whitening weighs the slowest part of a residual most; its unweighted energy may yet be halved.
TEST(AcceptanceTest, AllowsARiseOnAnotherKindOfMotionThatIsAFallUnweighted) {
  const AcceptanceFixture fixture;
  Fitted child = fixture.leaving(0.8, 0.8, 1.2);
  child.unweighted[kExtrapolation] *= 0.5;
  EXPECT_TRUE(test_acceptance(fixture.context, fixture.leaving(1, 1, 1), child, "x", 100).accepted());
}

// A gain that whitening alone shows is held against the rise that whitening shows.
TEST(AcceptanceTest, RefusesARiseOnAnotherKindOfMotionBesideAGainOfTheWhitenedAlone) {
  const AcceptanceFixture fixture;
  const Fitted parent = fixture.leaving(1, 1, 1);
  Fitted child = fixture.leaving(0.75, 0.75, 1.25);
  child.unweighted[kExtrapolation] = parent.unweighted[kExtrapolation];
  EXPECT_TRUE(test_acceptance(fixture.context, parent, child, "x", 100).accepted());
  child.unweighted[kValidation] = parent.unweighted[kValidation];
  const AcceptanceResult j = test_acceptance(fixture.context, parent, child, "x", 100);
  EXPECT_FALSE(j.accepted());
  EXPECT_NE(j.why.find("extrapolation"), std::string::npos) << j.why;
}

TEST(AcceptanceTest, AllowsARiseOnAnotherKindOfMotionThatIsSmallUnweighted) {
  const AcceptanceFixture fixture;
  const Fitted parent = fixture.leaving(1, 1, 1);
  Fitted child = fixture.leaving(0.8, 0.8, 1.2);
  child.unweighted[kExtrapolation] = 1.01 * parent.unweighted[kExtrapolation];
  EXPECT_TRUE(test_acceptance(fixture.context, parent, child, "x", 100).accepted());
  child.unweighted[kExtrapolation] = 1.03 * parent.unweighted[kExtrapolation];
  EXPECT_FALSE(test_acceptance(fixture.context, parent, child, "x", 100).accepted());
}

// An inductance that has absorbed a delay: with the delay it is what the data sheet says.
TEST(AcceptanceTest, AcceptsWhatRestoresAnImplausibleBaseParameterToItsPrior) {
  const AcceptanceFixture fixture;
  ParameterEstimate inductance;
  inductance.path = "motor.inductance_H";
  inductance.prior_sigma = 1e-4;
  const auto with_drift = [&](Fitted fitted, double sigmas) {
    inductance.prior_deviation_sigmas = sigmas;
    inductance.value = sigmas * inductance.prior_sigma;
    fitted.fit.parameters = {inductance};
    return fitted;
  };
  const Fitted bent = with_drift(fixture.leaving(1, 1, 1), 9.0);
  const AcceptanceResult j =
      test_acceptance(fixture.context, bent, with_drift(fixture.leaving(1, 1, 1), 0.5), "x", 0.0);
  EXPECT_TRUE(j.accepted()) << j.why;
  EXPECT_NE(j.why.find("motor.inductance_H returns to its prior"), std::string::npos) << j.why;
  // not at the price of more error, not half way, and not where nobody was surprised
  EXPECT_FALSE(test_acceptance(fixture.context, bent, with_drift(fixture.leaving(1, 1.02, 1), 0.5), "x", 0.0)
                   .accepted());
  EXPECT_FALSE(test_acceptance(fixture.context, bent, with_drift(fixture.leaving(1, 1, 1.1), 0.5), "x", 0.0)
                   .accepted());
  EXPECT_FALSE(
      test_acceptance(fixture.context, bent, with_drift(fixture.leaving(1, 1, 1), 3.0), "x", 0.0).accepted());
  const Fitted straight = with_drift(fixture.leaving(1, 1, 1), 3.0);
  EXPECT_FALSE(test_acceptance(fixture.context, straight, with_drift(fixture.leaving(1, 1, 1), 0.5), "x", 0.0)
                   .accepted());
}

// A payload is aliased with the mass in these data: the mass's prior decides, and for such an effect alone.
TEST(AcceptanceTest, AcceptsAnAliasedEffectWhereThePriorRejectsTheBaseParameter) {
  const AcceptanceFixture fixture;
  const auto with_mass = [&](Fitted fitted, double sigmas) {
    ParameterEstimate mass;
    mass.path = "robot.mass_kg";
    mass.prior_mean = 2.4;
    mass.prior_sigma = 0.05;
    mass.value = mass.prior_mean + sigmas * mass.prior_sigma;
    mass.prior_deviation_sigmas = sigmas;
    fitted.fit.parameters = {mass};
    return fitted;
  };
  const auto of_mass = [&](double before, double after, std::string_view aliased_parameter) {
    return test_acceptance(fixture.context, with_mass(fixture.leaving(1, 1, 1), before),
                           with_mass(fixture.leaving(1, 1, 1), after), "x", 0.0, aliased_parameter);
  };
  const AcceptanceResult j = of_mass(2.6, 0.1, "robot.mass_kg");
  EXPECT_TRUE(j.accepted_by == AcceptedBy::kPrior) << j.why;
  EXPECT_NE(j.why.find("cannot separate the two"), std::string::npos) << j.why;
  EXPECT_FALSE(of_mass(2.2, 0.1, "robot.mass_kg").accepted())
      << "a normal error is that large once in seventy times";
  EXPECT_FALSE(of_mass(2.6, 1.5, "robot.mass_kg").accepted()) << "half of it stays";
  EXPECT_FALSE(of_mass(2.6, 0.1, "").accepted()) << "they are not listed as confusable";
  EXPECT_FALSE(of_mass(2.6, 0.1, "motor.resistance_ohm").accepted());
}

TEST(AcceptanceTest, RefusesAGainThatTheSimulatedNullHasAsWell) {
  const AcceptanceFixture fixture;
  const AcceptanceResult j =
      test_acceptance(fixture.context, fixture.leaving(1, 1, 1), fixture.leaving(0.8, 0.8, 0.8), "x", 1.1);
  EXPECT_FALSE(j.accepted());
  EXPECT_NE(j.why.find("simulated null"), std::string::npos) << j.why;
}

TEST(AcceptanceTest, RefusesWhatDoesNotMatter) {
  const AcceptanceFixture fixture;
  // energy falls by 1 - 0.99^2 = 2 %
  EXPECT_FALSE(
      test_acceptance(fixture.context, fixture.leaving(1, 1, 1), fixture.leaving(0.99, 0.99, 1), "x", 100)
          .accepted());
}

// A measured bus drives the model: what its supply does beside, no friction explains and none is judged by.
TEST(AcceptanceTest, ASignalThatTheAdditionLeavesAsItWasDoesNotWaterItDown) {
  FakePredictor fake;
  for (const Split split : {Split::kTraining, Split::kValidation, Split::kExtrapolation}) {
    fake.add(split, noise_of(1.0, 5), std::vector<double>(kSamples, 0.0));
    fake.add(split, noise_of(1.0, 6), std::vector<double>(kSamples, 0.0), 1.0, "bus_voltage");
  }
  const FakeResiduals residuals(fake);
  const Splits& splits = *residuals.splits;
  const auto leaving = [&](double velocity, double bus) {
    Fitted out;
    out.finite = true;
    for (std::size_t u = 0; u < kSplits; ++u) {
      std::vector<double> r = noise_of(velocity, 7);
      for (const double v : noise_of(bus, 8)) r.push_back(v);
      out.residual[u] = Eigen::Map<const Eigen::VectorXd>(r.data(), 2 * kSamples);
      out.unweighted[u] = splits[u].mean_square(out.residual[u]);
    }
    return out;
  };
  const AcceptanceContext& context = residuals.context;
  const AcceptanceResult j = test_acceptance(context, leaving(1, 3), leaving(0.95, 3), "x", 100);
  EXPECT_NEAR(j.holdout.ratio, 0.95 * 0.95, 1e-9);
  EXPECT_NEAR(j.holdout.floor, 0.01, 1e-3);
  // one that moves both is judged by both
  EXPECT_GT(test_acceptance(context, leaving(1, 3), leaving(0.95, 3.1), "x", 100).holdout.ratio, 0.95);
}

// A residual that swings once in 2000 of 4000 samples holds a handful of independent ones: six numbers for 36 % of
// its energy are too many (4 log 0.64 + 6 log 4 > 0), for noise that is new at every sample they are not.
TEST(AcceptanceTest, AGainHasToPayForItsNumbers) {
  const AcceptanceFixture fixture;
  const auto accepted = [&](bool slow) {
    Fitted parent = fixture.leaving(1, 1, 1), child = fixture.leaving(0.8, 0.8, 0.8);
    if (slow) {
      for (std::size_t u = 0; u < kSplits; ++u) {
        for (Eigen::Index i = 0; i < kSamples; ++i)
          parent.residual[u][i] = 1.5 * std::sin(2.0 * std::numbers::pi * static_cast<double>(i) / 2000.0);
        child.residual[u] = 0.8 * parent.residual[u];
      }
    }
    child.fit.unknowns.resize(6);
    return test_acceptance(fixture.context, parent, child, "x", 100);
  };
  EXPECT_TRUE(accepted(false).accepted());
  EXPECT_FALSE(accepted(true).accepted());
  EXPECT_NE(accepted(true).why.find("does not pay for its numbers"), std::string::npos) << accepted(true).why;
}

TEST(BlockBootstrapTest, AGainInOneMomentAloneIsUncertain) {
  const AcceptanceFixture fixture;
  const Fitted parent = fixture.leaving(1, 1, 1);
  Eigen::VectorXd everywhere = 0.9 * parent.residual[kValidation], once = parent.residual[kValidation];
  once.head(500) *= 0.1;  // one block of eight loses nearly all
  once.tail(kSamples - 500) *= 1.01;
  const Eigen::VectorXd weights = Eigen::VectorXd::Ones(1);
  const SplitGain sure =
      fixture.bootstrap[kValidation].gain(parent.residual[kValidation], everywhere, weights);
  const SplitGain unsure = fixture.bootstrap[kValidation].gain(parent.residual[kValidation], once, weights);
  EXPECT_LT(sure.worst, 1.0);
  EXPECT_GT(unsure.worst, 1.0);
}

TEST(BoundedGainTest, AOneSidedStrengthIsNotTakenBelowZero) {
  const Eigen::MatrixXd gram = Eigen::MatrixXd::Identity(1, 1);
  const Eigen::VectorXd against = Eigen::VectorXd::Constant(1, -2.0);
  EXPECT_EQ(bounded_gain(gram, against, {false}).first, 0.0);
  EXPECT_NEAR(bounded_gain(gram, against, {true}).first, 4.0,
              1e-6);  // b' G^-1 b; copies of columns are damped
}

// A dead band under full steps: the held-out runs hardly show it, a ramp does, and neither was fitted to.
TEST(AcceptanceTest, AnotherKindOfMotionDecidesWhereTheHeldOutRunsHardlyShowTheEffect) {
  const AcceptanceFixture fixture;
  const auto with = [&](double holdout, double extrapolation) {
    return test_acceptance(fixture.context, fixture.leaving(2, 2, 2),
                           fixture.leaving(1.8, 2 * holdout, 2 * extrapolation), "x", 100);
  };
  EXPECT_TRUE(with(0.995, 0.6).accepted());
  EXPECT_NE(with(0.995, 0.6).why.find("extrapolation error energy falls by 64"), std::string::npos);
  EXPECT_TRUE(with(1.005, 0.6).accepted())
      << "1 %: as another motion's error may rise where the held-out runs decide";
  EXPECT_FALSE(with(1.02, 0.6).accepted()) << "4 % is a loss";
  EXPECT_FALSE(with(0.995, 0.9).accepted()) << "19 % of the energy may be the base parameters' last digits";
  Fitted whitened_only = fixture.leaving(1.8, 2 * 0.995, 2 * 0.6);
  whitened_only.unweighted[kExtrapolation] = fixture.leaving(2, 2, 2).unweighted[kExtrapolation] * 0.99;
  EXPECT_FALSE(test_acceptance(fixture.context, fixture.leaving(2, 2, 2), whitened_only, "x", 100).accepted())
      << "what only the slowest part of the residual shows is the base parameters' last digits";
}

// A law's form is wrong by more where nothing was fitted: what a second law of the same quantity takes there alone has to be a tenth
// of what the base model left there. An effect elsewhere takes what it takes.
TEST(AcceptanceTest, AnotherKindOfMotionAloneProvesNoSecondLawOfTheSameQuantity) {
  AcceptanceFixture fixture;
  for (auto& level : fixture.null.mean_square) level = Eigen::MatrixXd::Constant(2, 1, 0.01);
  FitResult without;
  fixture.context.base_fit = &without;
  const auto accepted = [&](const std::string& name, const std::string& strength, double base_extrapolation) {
    const Fitted base = fixture.leaving(10, 10, base_extrapolation);
    fixture.context.base = &base.residual;
    Fitted found = fixture.leaving(2, 2, 2), child = fixture.leaving(1.8, 2 * 0.995, 2 * 0.6);
    found.fit.model = with_effect("stribeck_friction", 0.01);
    ParameterEstimate significant;
    significant.path = name + "." + strength;
    significant.value = 0.01;
    significant.sigma = 1e-3;
    child.fit.parameters = {significant};
    return test_acceptance(fixture.context, found, child, name, 100).accepted();
  };
  EXPECT_FALSE(accepted("lugre_friction", "coulomb_torque_Nm", 10)) << "2.6 % of the base model's energy";
  EXPECT_TRUE(accepted("lugre_friction", "coulomb_torque_Nm", 4)) << "16 %";
  EXPECT_TRUE(accepted("encoder_eccentricity", "amplitude_rad", 10));
}

}  // namespace
}  // namespace omnihil
