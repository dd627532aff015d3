#include "identify/select/confidence.h"

#include <gtest/gtest.h>

namespace omnihil {
namespace {

RankedEffect row(const std::string& effect, double frequency, double share) {
  RankedEffect r;
  r.effect = effect;
  r.selection_frequency = frequency;
  r.share_of_base = share;
  return r;
}

// Of a signal of noise 0.02: its error in multiples of that.
SignalError error(double over_noise, Split split = Split::kValidation,
                  const std::string& signal = "velocity") {
  SignalError e;
  e.signal = signal;
  e.split = split;
  e.noise_sigma = 0.02;
  e.rmse = 0.02 * over_noise;
  return e;
}

// Two found one after the other, the first replaced by a simpler law afterwards.
Diagnosis two_names() {
  Diagnosis d;
  d.outcome = Outcome::kFound;
  d.effects = {"coulomb_friction", "duty_limit"};
  d.ladder.resize(4);
  d.ladder[0].ranking = {row("lugre_friction", 0.9, 0.8), row("duty_limit", 0.1, 0.3)};
  d.ladder[1].added = "lugre_friction";
  d.ladder[1].ranking = {row("duty_limit", 0.7, 0.02)};
  d.ladder[2].added = "duty_limit";
  d.ladder[3].added = "coulomb_friction in place of lugre_friction";
  return d;
}

TEST(ConfidenceTest, TakesItsEvidenceFromTheRoundThatTookTheName) {
  const auto c = confidences(two_names());
  ASSERT_EQ(c.size(), 2u);
  EXPECT_EQ(c[0].effect, "coulomb_friction");
  EXPECT_DOUBLE_EQ(c[0].probability, probability_right({.share_of_base = 0.8, .selection_frequency = 0.9}));
  EXPECT_DOUBLE_EQ(c[1].probability,
                   probability_right({.later = true, .share_of_base = 0.02, .selection_frequency = 0.7}));
}

TEST(ConfidenceTest, APairHasTheEvidenceOfBoth) {
  Diagnosis d = two_names();
  d.effects = {"lugre_friction", "duty_limit"};
  d.ladder.resize(2);
  d.ladder[1].added = "lugre_friction and duty_limit";
  const auto c = confidences(d);
  EXPECT_DOUBLE_EQ(c[1].probability,
                   probability_right({.later = true, .share_of_base = 0.3, .selection_frequency = 0.1}));
  // neither gains alone what both do: energies above the noise of 24, 24 and 0
  d.baseline_comparison.errors = d.ladder[0].comparison.errors = {error(5.0)};
  d.ladder[1].comparison.errors = d.final_comparison.errors = {error(1.0)};
  EXPECT_DOUBLE_EQ(confidences(d)[1].probability,
                   probability_right({.later = true, .share_of_base = 1.0, .selection_frequency = 0.1}));
}

TEST(ConfidenceTest, TakesTheWorseOfFitAndHeldOutErrorOfTheLastModelWithoutTheBus) {
  Diagnosis d = two_names();
  for (const bool fit_is_worse : {false, true}) {
    d.final_comparison.errors = {error(fit_is_worse ? 1.3 : 1.1, Split::kTraining, "velocity"),
                                 error(fit_is_worse ? 1.1 : 1.3, Split::kValidation, "velocity"),
                                 error(40.0, Split::kValidation, "bus_voltage")};
    EXPECT_DOUBLE_EQ(
        confidences(d)[1].probability,
        probability_right(
            {.later = true, .share_of_base = 0.02, .selection_frequency = 0.7, .error_over_noise = 1.3}));
  }
}

TEST(ConfidenceTest, WhatRemainsIsTheEnergyAboveTheNoiseOverTheBaseModels) {
  Diagnosis d = two_names();
  d.outcome = Outcome::kMoreRemains;
  d.baseline_comparison.errors = {error(3.0)};
  d.final_comparison.errors = {error(2.0)};
  EXPECT_DOUBLE_EQ(confidences(d)[0].probability, probability_right({.more_remains = true,
                                                                     .share_of_base = 0.8,
                                                                     .selection_frequency = 0.9,
                                                                     .error_over_noise = 2.0,
                                                                     .remaining_share = 3.0 / 8.0}));
}

TEST(ConfidenceTest, IsLowerWhereStructureRemainsAndForLaterNames) {
  const NameEvidence first{.selection_frequency = 0.3}, later{.later = true, .selection_frequency = 0.3},
      remains{.more_remains = true, .selection_frequency = 0.3, .remaining_share = 0.5};
  EXPECT_LT(probability_right(later), probability_right(first));
  EXPECT_LT(probability_right(remains), probability_right(first));
}

// What a law's form leaves to a second one of the same quantity: up to a fiftieth of the base model's energy both are as likely,
// with a third of it there is no such form. Of another quantity there is no such doubt.
TEST(ConfidenceTest, ASecondLawOfTheSameQuantityMayBeTheFormOfTheFirst) {
  const auto of_second = [](const std::string& name, double share) {
    Diagnosis d;
    d.outcome = Outcome::kFound;
    d.effects = {"quadratic_drag", name};
    d.ladder.resize(3);
    d.ladder[0].ranking = {row("quadratic_drag", 1.0, 0.98)};
    d.ladder[1].added = "quadratic_drag";
    d.ladder[1].ranking = {row(name, 1.0, share)};
    d.ladder[2].added = name;
    return confidences(d)[1].probability;
  };
  for (const double share : {0.01, 0.02})
    EXPECT_NEAR(of_second("stribeck_friction", share), 0.5 * of_second("saturation", share), 0.01) << share;
  EXPECT_GT(of_second("stribeck_friction", 0.33), 0.98 * of_second("saturation", 0.33));
}

TEST(ConfidenceTest, ANameThatExplainsMuchMoreThanWhatRemainsIsLikelier) {
  const auto beside = [](double remaining) {
    return probability_right({.more_remains = true,
                              .share_of_base = 0.5,
                              .selection_frequency = 0.8,
                              .remaining_share = remaining});
  };
  EXPECT_GT(beside(0.02), beside(0.2));
  EXPECT_GT(beside(0.2), beside(0.5));
}

TEST(ConfidenceTest, SaysItInPerCent) {
  Diagnosis d;
  EXPECT_EQ(confidence_sentence(d), "");
  d.confidence = {{.effect = "cogging", .probability = 0.954}};
  EXPECT_NE(confidence_sentence(d).find("the name was right: cogging in 95 %"), std::string::npos);
  d.confounded = {{.members = {"cogging", "motor.resistance_ohm"}, .sentence = {}}};
  EXPECT_NE(confidence_sentence(d).find("the name was right"), std::string::npos)
      << "a base parameter is no name";
  d.confounded.push_back({.members = {"cogging", "torque_ripple"}, .sentence = {}});
  EXPECT_NE(confidence_sentence(d).find("or one that it cannot be told from, was right"), std::string::npos);
}

TEST(ConfidenceTest, ANameIsUnlikelyBelowOneHalf) {
  Diagnosis d;
  d.effects = {"cogging", "grease_drag", "backlash"};  // nothing is said of the last
  d.confidence = {{.effect = "cogging", .probability = 0.51}, {.effect = "grease_drag", .probability = 0.49}};
  EXPECT_EQ(names_by_likelihood(d).likely, (std::vector<std::string>{"cogging", "backlash"}));
  EXPECT_EQ(names_by_likelihood(d).unlikely, (std::vector<std::string>{"grease_drag"}));
}

}  // namespace
}  // namespace omnihil
