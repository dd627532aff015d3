// Structure is what stands above the simulated null by more than chance and by a size that matters.
#include "identify/select/verdict.h"

#include <gtest/gtest.h>

#include "tests/identify/fake_residuals.h"

namespace omnihil {
namespace {

ResidualExcess excess(double now, double before, double spread, double unexplained) {
  return {.excess = now,
          .excess_before = before,
          .spread = spread,
          .unexplained = unexplained,
          .signal = "velocity",
          .rms = 2.0,
          .unit = "rad/s",
          .split = kValidation};
}

TEST(Verdict, StructureIsATenthAboveTheNull) {
  EXPECT_FALSE(structure_remains(excess(0.09, 0.09, 0.001, 1.0), false));
  EXPECT_TRUE(structure_remains(excess(0.11, 0.11, 0.001, 1.0), false));
}

TEST(Verdict, StructureIsMoreThanFiveTimesTheScatterOfTheReplicates) {
  EXPECT_FALSE(structure_remains(excess(0.5, 0.5, 0.11, 1.0), false));
  EXPECT_TRUE(structure_remains(excess(0.5, 0.5, 0.09, 1.0), false));
}

TEST(Verdict, WhatIsLeftBesideAnEffectCountsAsAShareOfWhatWasThere) {
  EXPECT_FALSE(structure_remains(excess(0.5, 10.0, 0.01, 0.09), true));
  EXPECT_TRUE(structure_remains(excess(0.5, 10.0, 0.01, 0.11), true));
  EXPECT_TRUE(structure_remains(excess(0.5, 10.0, 0.01, 0.09), false));  // nothing was added
}

// A counted speed's rounding, drawn at random, that the record does not have.
TEST(Verdict, AnEffectWhoseNoiseIsNotInTheRecordIsRefuted) {
  EXPECT_EQ(too_noisy(excess(-0.3, 4.0, 0.01, 0.0)), "");
  EXPECT_EQ(too_noisy(excess(8.0, 24.0, 0.01, 0.35)), "") << "structure hides it";
  const std::string why = too_noisy(excess(-0.75, 4.0, 0.01, 0.0));
  EXPECT_NE(why.find("velocity would be 2 times as noisy as it is"), std::string::npos) << why;
}

TEST(Verdict, TheSentenceSaysSizeSignalAndShare) {
  const std::string remains = residual_sentence(excess(0.25, 0.25, 0.01, 1.0), false);
  // sqrt(1.25) = 1.118 times the noise
  EXPECT_NE(remains.find("2 rad/s RMS of velocity on held-out runs, 1.12 times"), std::string::npos)
      << remains;
  EXPECT_NE(remains.find("no known effect explains"), std::string::npos) << remains;
  const std::string done = residual_sentence(excess(0.02, 4.0, 0.01, 0.03), true);
  EXPECT_NE(done.find("97 % of what the base model left is explained"), std::string::npos) << done;
  const std::string more = residual_sentence(excess(8.0, 24.0, 0.01, 0.35), true);
  EXPECT_NE(more.find("More remains"), std::string::npos) << more;
  EXPECT_NE(more.find("3 times the sensors' noise; 35 % of what the base model left"), std::string::npos)
      << more;
  // chance takes the energy below the null's: at the noise, nothing negative
  const std::string below = residual_sentence(excess(-0.03, 0.5, 0.05, 0.0), true);
  EXPECT_NE(below.find("as the sensors' noise alone would leave"), std::string::npos) << below;
  EXPECT_EQ(below.find("-"), below.find("-out")) << below;
  // far below it: the noise was no noise
  const std::string wrong = residual_sentence(excess(-0.75, 0.5, 0.05, 0.0), true);
  EXPECT_NE(wrong.find("0.5 times the noise that the sensors were taken to have: too much"),
            std::string::npos)
      << wrong;
  const std::string nothing = residual_sentence(excess(0.02, 0.02, 0.01, 1.0), false);
  EXPECT_NE(nothing.find("Nothing that matters is missing"), std::string::npos) << nothing;
}

// A null of a hundredth of energy, without scatter: a tenth more is structure.
TEST(Verdict, AWhitenedResidualIsHeldAgainstTheNullsMeanSquare) {
  FakePredictor fake;
  for (const Split split : {Split::kTraining, Split::kValidation, Split::kExtrapolation})
    fake.add(split, std::vector<double>(1000, 0.0), std::vector<double>(1000, 0.0));
  const FakeResiduals scene(fake);
  const WhitenedResiduals& training = (*scene.splits)[kTraining];
  const auto level = [&](double mean_square) -> Eigen::VectorXd {
    return Eigen::VectorXd::Constant(training.size(), std::sqrt(mean_square));
  };
  EXPECT_FALSE(structure_in(training, scene.null, scene.channels, level(0.0109)));
  EXPECT_TRUE(structure_in(training, scene.null, scene.channels, level(0.0111)));
}

TEST(Verdict, AMeasuredBusVoltageIsGivenToTheModelAndNoStructureOfTheDrive) {
  FakePredictor fake;
  for (const Split split : {Split::kTraining, Split::kValidation, Split::kExtrapolation})
    fake.add(split, std::vector<double>(1000, 0.0), std::vector<double>(1000, 0.0), 1.0, "bus_voltage");
  const FakeResiduals scene(fake);
  const WhitenedResiduals& training = (*scene.splits)[kTraining];
  const Eigen::VectorXd residual = Eigen::VectorXd::Ones(training.size());
  EXPECT_FALSE(structure_in(training, scene.null, scene.channels, residual));
  // Nor is it what a verdict tells of where every other channel is below what chance leaves.
  EXPECT_EQ(excess_of(training, scene.null, scene.channels, residual)[0], -1.0);
}

}  // namespace
}  // namespace omnihil
