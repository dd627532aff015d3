// What `omnihil compare` adds to the errors: clock offset, tolerance tubes, relative force error.
#include <gtest/gtest.h>

#include <cmath>

#include "identify/compare/clock_offset.h"
#include "identify/compare/force_error.h"
#include "identify/compare/tube.h"
#include "sim/law/random.h"
#include "tests/identify/fake_predictor.h"

namespace omnihil {
namespace {

std::vector<Prediction> predictions_of(const Predictor& predictor) {
  std::vector<Prediction> out;
  for (int r = 0; r < predictor.run_count(); ++r) out.push_back(predictor.predict({}, r));
  return out;
}

double motion(double t) { return 30.0 * std::sin(9.0 * t) + 10.0 * std::sin(31.0 * t + 1.0); }

FakePredictor late_by(double late_s) {
  FakePredictor fake;
  std::vector<double> measured, model;
  for (int i = 0; i < 6000; ++i) {
    const double t = i * 1e-3;
    measured.push_back(motion(t - late_s) + 0.3 * gaussian(1, 0, static_cast<std::uint64_t>(i)));
    model.push_back(motion(t));
  }
  fake.add(Split::kTraining, measured, model);
  return fake;
}

TEST(ClockOffset, IsFoundToAFractionOfAPeriod) {
  for (const double late_s : {0.0031, -0.0074, 0.0004}) {
    const FakePredictor fake = late_by(late_s);
    const auto offset = clock_offset(fake, predictions_of(fake), "velocity");
    ASSERT_TRUE(offset);
    EXPECT_NEAR(offset->seconds, late_s, 1e-4);
    EXPECT_TRUE(offset->significant) << late_s;
  }
}

// A camera's frames: one row in twelve.
TEST(ClockOffset, IsFoundInSparseSignalsToo) {
  FakePredictor fake;
  std::vector<double> measured, model;
  for (int i = 0; i < 12000; ++i) {
    const double t = i * 1e-3;
    measured.push_back(i % 12 == 0 ? motion(t - 0.02) : NAN);
    model.push_back(i % 12 == 0 ? motion(t) : NAN);
  }
  fake.add(Split::kTraining, measured, model);
  const auto offset = clock_offset(fake, predictions_of(fake), "velocity");
  ASSERT_TRUE(offset);
  EXPECT_NEAR(offset->seconds, 0.02, 1e-3);
}

TEST(ClockOffset, IsNotClaimedWhereThereIsNone) {
  const FakePredictor fake = late_by(0.0);
  const auto offset = clock_offset(fake, predictions_of(fake), "velocity");
  ASSERT_TRUE(offset);
  EXPECT_FALSE(offset->significant);
}

TEST(Tube, IsReadFromItsText) {
  std::string fault;
  const auto tube = parse_tube("velocity=5%/0.01", fault);
  ASSERT_TRUE(tube) << fault;
  EXPECT_EQ(tube->signal, "velocity");
  EXPECT_EQ(tube->tolerance, 5.0);
  EXPECT_TRUE(tube->relative);
  EXPECT_EQ(tube->time_s, 0.01);
  for (const char* bad :
       {"velocity", "=3", "velocity=", "velocity=-1", "velocity=x", "velocity=1/-2", "velocity=nan"}) {
    EXPECT_FALSE(parse_tube(bad, fault)) << bad;
    EXPECT_FALSE(fault.empty());
  }
}

TEST(Tube, CountsWhatLiesOutsideAndNamesTheWorst) {
  FakePredictor fake;
  fake.add(Split::kTraining, {0.0, 1.0, 2.5, -4.0}, {0.0, 0.0, 0.0, 0.0});
  const TubeResult r = hold_in_tube(fake, predictions_of(fake), {.signal = "velocity", .tolerance = 1.0});
  EXPECT_EQ(r.samples, 4u);
  EXPECT_EQ(r.outside, 2u);
  EXPECT_DOUBLE_EQ(r.worst, 3.0);
  EXPECT_DOUBLE_EQ(r.worst_s, 0.003);
  EXPECT_DOUBLE_EQ(r.first_s, 0.002);
}

TEST(Tube, WidthInTimeForgivesAStepThatIsOneSampleLate) {
  FakePredictor fake;
  fake.add(Split::kTraining, {0.0, 0.0, 0.0, 10.0}, {0.0, 0.0, 10.0, 10.0});
  const auto predictions = predictions_of(fake);
  EXPECT_EQ(hold_in_tube(fake, predictions, {.signal = "velocity", .tolerance = 1.0}).outside, 1u);
  EXPECT_EQ(
      hold_in_tube(fake, predictions, {.signal = "velocity", .tolerance = 1.0, .time_s = 1.1e-3}).outside,
      0u);
}

TEST(ForceError, IsTheRatioOfNorms) {
  FakePredictor fake;
  std::vector<double> force, model;
  for (int i = 0; i < 5000; ++i) {
    force.push_back(100.0 * std::sin(6.0 * i * 1e-3));
    model.push_back(0.97 * force.back());
  }
  for (std::size_t i = 0; i < 50; ++i) force[i] = force[4999 - i] = NAN;
  fake.add(Split::kTraining, force, model, 1.0, "motor_torque");
  const auto predictions = predictions_of(fake);
  EXPECT_NEAR(*force_error(fake, predictions, Split::kTraining), 0.03, 1e-9);
  EXPECT_FALSE(force_error(fake, predictions, Split::kValidation));
}

}  // namespace
}  // namespace omnihil
