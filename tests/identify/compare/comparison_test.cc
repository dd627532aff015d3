#include "identify/compare/comparison.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sim/law/random.h"
#include "tests/identify/fake_predictor.h"

namespace omnihil {
namespace {

TEST(Comparison, ErrorsOfTwoSamplesByHand) {
  FakePredictor fake;
  fake.add(Split::kTraining, {1.0, 5.0}, {4.0, 1.0}, 2.0);  // model minus measurement: 3, -4
  const Comparison c = compare(fake, {});
  const SignalError& e = *c.error(Split::kTraining, "velocity");
  EXPECT_EQ(e.samples, 2u);
  EXPECT_DOUBLE_EQ(e.rmse, std::sqrt((9.0 + 16.0) / 2.0));
  EXPECT_DOUBLE_EQ(e.mean_absolute, 3.5);
  EXPECT_DOUBLE_EQ(e.bias, -0.5);
  EXPECT_DOUBLE_EQ(e.nrmse_percent, 100.0 * e.rmse / 2.0);  // 1 and 5 deviate by 2 from 3
  EXPECT_DOUBLE_EQ(e.in_sigmas, e.rmse / 2.0);
  EXPECT_DOUBLE_EQ(e.relative, std::sqrt(25.0) / std::sqrt(26.0));
  EXPECT_DOUBLE_EQ(c.pooled(Split::kTraining), e.in_sigmas);
  EXPECT_EQ(c.error(Split::kValidation, "velocity"), nullptr);
}

TEST(Comparison, MissingSamplesCountNothing) {
  FakePredictor fake;
  fake.add(Split::kTraining, {1.0, kMissing, 5.0, 7.0}, {1.0, 100.0, 5.0, kMissing});
  const SignalError e = *compare(fake, {}).error(Split::kTraining, "velocity");
  EXPECT_EQ(e.samples, 2u);
  EXPECT_EQ(e.rmse, 0.0);
}

TEST(Comparison, RunsOfOneUseArePooledAndUsesKeptApart) {
  FakePredictor fake;
  fake.add(Split::kTraining, {0.0, 0.0}, {1.0, 1.0});
  fake.add(Split::kTraining, {0.0, 0.0}, {3.0, 3.0});
  fake.add(Split::kValidation, {0.0, 0.0}, {7.0, 7.0});
  const Comparison c = compare(fake, {});
  EXPECT_DOUBLE_EQ(c.error(Split::kTraining, "velocity")->rmse, std::sqrt((1.0 + 1.0 + 9.0 + 9.0) / 4.0));
  EXPECT_DOUBLE_EQ(c.error(Split::kValidation, "velocity")->rmse, 7.0);
  ASSERT_EQ(c.runs.size(), 3u);
  EXPECT_DOUBLE_EQ(c.runs[1].rmse, 3.0);
}

TEST(Comparison, ARunThatDivergesNeverLooksGood) {
  FakePredictor fake;
  fake.add(Split::kTraining, {0.0, 0.0, 0.0}, {0.0, kMissing, kMissing}).prediction.finite = false;
  const Comparison c = compare(fake, {});
  EXPECT_EQ(c.diverged, std::vector<std::string>{"run_0.csv"});
  EXPECT_TRUE(std::isinf(c.pooled(Split::kTraining)));
}

TEST(Comparison, PoolsSignalsEachInItsNoise) {
  FakePredictor fake;
  FakePredictor::FakeRun& run = fake.add(Split::kTraining, {0.0, 0.0}, {2.0, 2.0}, 1.0);
  ComparedSignal current = run.compared[0];
  current.name = "motor_current";
  current.noise_sigma = 0.1;
  run.compared.push_back(current);
  run.prediction.values.push_back({0.4, 0.4});
  const Comparison c = compare(fake, {});
  EXPECT_NEAR(c.pooled(Split::kTraining), std::sqrt((2.0 * 2.0 + 4.0 * 4.0) / 2.0), 1e-12);
}

// 1000 samples of noise 1; below 10 rad/s, a tenth of the time, an error of 5 on top.
FakePredictor wrong_when_slow() {
  FakePredictor fake;
  std::vector<double> measured, model(1000, 0.0), speed, angle;
  for (std::size_t i = 0; i < 1000; ++i) {
    const double w = 2.0 * static_cast<double>(i % 50);  // twenty sweeps
    speed.push_back(w);
    angle.push_back(0.37 * static_cast<double>(i));
    measured.push_back(gaussian(1, stream_of("noise"), i) + (w < 10.0 ? 5.0 : 0.0));
  }
  fake.add(Split::kTraining, measured, model)
      .track("speed", "rad/s", speed)
      .track("rotor_angle", "rad", angle);
  return fake;
}

TEST(Comparison, NamesTheRegimeWhereTheErrorIs) {
  const Comparison c = compare(wrong_when_slow(), {});
  ASSERT_FALSE(c.worst.empty());
  EXPECT_EQ(c.worst[0].axis, "speed");
  // energy: 100 samples of 25 + 1 against 900 of 1
  EXPECT_NEAR(c.worst[0].share, 2600.0 / 3500.0, 0.03);
  EXPECT_NEAR(c.worst[0].time_share, 0.1, 0.03);
  EXPECT_NE(c.worst[0].sentence.find("% of the error energy of velocity is below"), std::string::npos);
}

TEST(Comparison, ExplainedFractionIsWhatAMeanPerRangeExplains) {
  const Comparison c = compare(wrong_when_slow(), {});
  for (const RegimeError& regime : c.regimes) {
    // about the mean of 0.5: a tenth lies 4.5 above, the rest 0.5 below; the noise's variance is 1
    const double between = 0.1 * 4.5 * 4.5 + 0.9 * 0.5 * 0.5;
    const double expected = regime.axis == "speed" ? between / (between + 1.0) : 0.0;
    EXPECT_NEAR(regime.explained_fraction, expected, 0.08) << regime.axis;
  }
}

TEST(Comparison, ErrorSpreadEvenlyHasNoWorstRegime) {
  FakePredictor fake;
  std::vector<double> measured, speed;
  for (std::size_t i = 0; i < 2000; ++i) {
    measured.push_back(gaussian(2, stream_of("noise"), i));
    speed.push_back(uniform(3, 0, i));
  }
  fake.add(Split::kTraining, measured, std::vector<double>(2000, 0.0)).track("speed", "rad/s", speed);
  EXPECT_TRUE(compare(fake, {}).worst.empty());
}

TEST(Comparison, RangesPartAllSamples) {
  const Comparison c = compare(wrong_when_slow(), {});
  for (const RegimeError& regime : c.regimes) {
    double energy = 0.0, time = 0.0;
    for (const RegimeBin& bin : regime.bins) energy += bin.energy_share, time += bin.time_share;
    EXPECT_NEAR(energy, 1.0, 1e-12) << regime.axis;
    EXPECT_NEAR(time, 1.0, 1e-12) << regime.axis;
  }
}

TEST(Comparison, ARepeatedInputShowsWhatNoModelCanReach) {
  FakePredictor fake;
  std::vector<double> duty, a, b;
  for (std::size_t i = 0; i < 4000; ++i) {
    duty.push_back(i % 100 < 50 ? 0.5 : -0.5);
    a.push_back(2.0 * gaussian(4, 1, i));
    b.push_back(2.0 * gaussian(4, 2, i));
  }
  fake.add(Split::kTraining, a, a).run.signals["duty"] = duty;
  fake.add(Split::kValidation, b, b).run.signals["duty"] = duty;
  EXPECT_NEAR(compare(fake, {}).error(Split::kTraining, "velocity")->repeat_sigma, 2.0, 0.1);
  fake.last().run.signals["duty"][100] = 0.4;
  EXPECT_EQ(compare(fake, {}).error(Split::kTraining, "velocity")->repeat_sigma, 0.0);
}

}  // namespace
}  // namespace omnihil
