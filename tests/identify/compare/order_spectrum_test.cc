// Orders that were put into a residual come out, strongest first, each with its share of the energy.
#include "identify/compare/order_spectrum.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sim/law/random.h"
#include "tests/identify/fake_residuals.h"

namespace omnihil {
namespace {

constexpr std::size_t kSamples = 6000;

// A rotor that speeds up and slows down; the drive input is compared (inverse method), so nothing lags.
struct Turning {
  std::vector<double> speed, angle;
  FakePredictor fake;
  std::unique_ptr<FakeResiduals> scene;

  Turning() {
    double theta = 0.0;
    for (std::size_t i = 0; i < kSamples; ++i) {
      speed.push_back(15.0 + 12.0 * std::sin(2e-3 * static_cast<double>(i)));
      angle.push_back(theta);
      theta += 1e-3 * speed.back();
    }
    fake.method_ = Method::kInverse;
    for (const Split split : {Split::kTraining, Split::kValidation, Split::kExtrapolation})
      fake.add(split, std::vector<double>(kSamples, 0.0), std::vector<double>(kSamples, 0.0), 1.0,
               "motor_torque")
          .track("rotor_angle", "rad", angle)
          .track("speed", "rad/s", speed);
    scene = std::make_unique<FakeResiduals>(fake);
  }
  const WhitenedResiduals& residuals() const { return (*scene->splits)[kTraining]; }
  std::vector<OrderPeak> orders_in(const std::vector<std::array<double, 3>>& waves, double sigma,
                                   int most) const {
    Eigen::VectorXd r(static_cast<Eigen::Index>(kSamples));
    for (std::size_t i = 0; i < kSamples; ++i) {
      double sum = sigma * gaussian(3, 1, i);
      for (const auto& [order, size, phase] : waves) sum += size * std::sin(order * angle[i] + phase);
      r[static_cast<Eigen::Index>(i)] = sum;
    }
    return strong_orders(fake, residuals(), Candidate{}, r, most);
  }
};

// Energies of sines of different orders add: 9 and 1 parts of ten, and the second is all of what the first left.
TEST(OrderSpectrum, FindsTwoOrdersWithTheirShares) {
  const Turning turning;
  const std::vector<OrderPeak> peaks = turning.orders_in({{31.0, 0.1, 1.0}, {12.0, 0.3, 0.4}}, 0.0, 2);
  ASSERT_EQ(peaks.size(), 2u);
  EXPECT_EQ(peaks[0].order, 12.0);
  EXPECT_NEAR(peaks[0].share, 0.9, 0.02);  // over a number of turns that is not whole
  EXPECT_EQ(peaks[1].order, 31.0);
  EXPECT_NEAR(peaks[1].share, 0.1, 0.02);
}

TEST(OrderSpectrum, FindsNothingInWhiteNoise) {
  const Turning turning;
  EXPECT_TRUE(turning.orders_in({}, 1.0, 4).empty());
}

TEST(OrderSpectrum, GivesNoMoreThanItIsAskedFor) {
  const Turning turning;
  EXPECT_EQ(turning.orders_in({{31.0, 0.1, 1.0}, {12.0, 0.3, 0.4}}, 0.0, 1).size(), 1u);
}

TEST(OrderSpectrum, SaysNothingWhereTheAngleIsNotKnown) {
  FakePredictor fake;
  for (const Split split : {Split::kTraining, Split::kValidation, Split::kExtrapolation})
    fake.add(split, std::vector<double>(500, 0.0), std::vector<double>(500, 0.0));
  const FakeResiduals scene(fake);
  EXPECT_TRUE(
      strong_orders(fake, (*scene.splits)[kTraining], Candidate{}, Eigen::VectorXd::Ones(500), 3).empty());
}

}  // namespace
}  // namespace omnihil
