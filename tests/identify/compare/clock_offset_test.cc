// The lag that was put in comes out, in seconds, with its sign; without one nothing is claimed.
#include "identify/compare/clock_offset.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sim/law/random.h"
#include "tests/identify/fake_predictor.h"

namespace omnihil {
namespace {

constexpr int kSamples = 4000;  // 1 kHz

double motion(double t_s) {
  return std::sin(2 * M_PI * 3.1 * t_s) + 0.4 * std::sin(2 * M_PI * 7.7 * t_s + 0.5);
}

// Measured is the model's motion, later by this much, with noise.
std::optional<ClockOffset> offset_of(double late_s, double sigma, int samples = kSamples) {
  std::vector<double> model, measured;
  for (int i = 0; i < samples; ++i) {
    model.push_back(motion(1e-3 * i));
    measured.push_back(motion(1e-3 * i - late_s) + sigma * gaussian(1, 2, static_cast<std::uint64_t>(i)));
  }
  FakePredictor fake;
  fake.add(Split::kTraining, measured, model);
  const std::vector<Prediction> predictions{fake.predict({}, 0)};
  return clock_offset(fake, predictions, "velocity");
}

TEST(ClockOffset, FindsALagBetweenTwoSamples) {
  for (const double late_s : {0.0034, -0.0057, 0.020}) {
    const auto o = offset_of(late_s, 0.01);
    ASSERT_TRUE(o) << late_s;
    EXPECT_NEAR(o->seconds, late_s, 3e-5) << late_s;
    EXPECT_TRUE(o->significant) << late_s;
    EXPECT_GT(o->error_share, 0.9) << late_s;  // noise of 0.01 beside errors of up to 0.5
  }
}

TEST(ClockOffset, ClaimsNothingWhereThereIsNone) {
  const auto o = offset_of(0.0, 0.05);
  ASSERT_TRUE(o);
  EXPECT_FALSE(o->significant);
  EXPECT_LT(o->error_share, 0.05);
}

TEST(ClockOffset, SaysNothingOfTooShortARecord) { EXPECT_FALSE(offset_of(0.003, 0.01, 300)); }

TEST(ClockOffset, SaysNothingOfASignalThatIsNotCompared) {
  FakePredictor fake;
  fake.add(Split::kTraining, std::vector<double>(2000, 1.0), std::vector<double>(2000, 0.0));
  const std::vector<Prediction> predictions{fake.predict({}, 0)};
  EXPECT_FALSE(clock_offset(fake, predictions, "motor_current"));
}

}  // namespace
}  // namespace omnihil
