// Smoother, points' curve, grip without sliding: closed forms. Whole recordings of an independent plant:
// tests/hidden_plant/test_tyre.py.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "identify/tyre/motion_smoother.h"
#include "identify/tyre/tyre_curve_fit.h"

namespace omnihil {
namespace {

TEST(MotionSmoother, AConstantAccelerationComesBackExactly) {
  std::vector<MotionSample> in(2000);
  for (std::size_t k = 0; k < in.size(); ++k) {
    const double t = 1e-3 * static_cast<double>(k);
    in[k].time_s = t;
    in[k].place = 1.0 + 2.0 * t - 1.5 * t * t;
    in[k].place_sigma = 1e-4;
  }
  const SmoothedMotion out = smooth_motion(in);
  for (const std::size_t k : {100u, 1000u, 1900u}) {
    const double t = 1e-3 * static_cast<double>(k);
    EXPECT_NEAR(out.at[k].speed, 2.0 - 3.0 * t, 1e-4);
    EXPECT_NEAR(out.at[k].acceleration, -3.0, 1e-2);
  }
}

// Frames 60 times a second and an accelerometer between them, with a bias: the speed's error is what the smoother says.
TEST(MotionSmoother, SaysHowWrongItsSpeedIs) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  std::vector<MotionSample> in(8000);
  std::vector<double> true_speed(in.size());
  for (std::size_t k = 0; k < in.size(); ++k) {
    const double t = 1e-3 * static_cast<double>(k);
    in[k].time_s = t;
    in[k].place_sigma = 8e-4;
    in[k].acceleration_sigma = 0.15;
    if (k % 16 == 0) in[k].place = 0.5 * (1.0 - std::cos(3.0 * t)) + 8e-4 * normal(random);
    in[k].acceleration = 4.5 * std::cos(3.0 * t) + 0.1 + 0.15 * normal(random);
    true_speed[k] = 1.5 * std::sin(3.0 * t);
  }
  const SmoothedMotion out = smooth_motion(in);
  double error2 = 0.0, said2 = 0.0;
  for (std::size_t k = 500; k < 7500; ++k) {
    error2 += std::pow(out.at[k].speed - true_speed[k], 2);
    said2 += std::pow(out.at[k].speed_sigma, 2);
  }
  EXPECT_LT(std::sqrt(error2 / 7000.0), 0.004);
  EXPECT_NEAR(std::sqrt(error2 / said2), 1.0, 0.5);
}

std::vector<TyrePoint> points_of(const TyreCurve& curve, double noise) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  std::vector<TyrePoint> points;
  for (int k = -300; k <= 300; ++k) {
    TyrePoint p;
    p.slip = 2.0 * curve.asymptote_slip * k / 300.0;
    p.ratio = grip<double>(curve, p.slip) + noise * normal(random);
    p.slip += 0.1 * noise * normal(random);
    p.slip_sigma = 0.1 * noise + 1e-6;
    p.ratio_sigma = noise + 1e-4;
    points.push_back(p);
  }
  return points;
}

TEST(TyreCurveFit, PointsOfACurveGiveTheCurve) {
  for (const TyreCurve& curve :
       {TyreCurve{0.1, 0.75, 0.4, 0.6}, TyreCurve{0.02, 1.2, 0.1, 0.3}, TyreCurve{0.3, 0.4, 0.8, 0.35}}) {
    const TyreCurveFit f = fit_tyre_curve(points_of(curve, 0.0));
    EXPECT_NEAR(f.curve.extremum_slip / curve.extremum_slip, 1.0, 0.01);
    EXPECT_NEAR(f.curve.extremum_value / curve.extremum_value, 1.0, 0.005);
    EXPECT_NEAR(f.curve.asymptote_slip / curve.asymptote_slip, 1.0, 0.02);
    EXPECT_NEAR(f.curve.asymptote_value / curve.asymptote_value, 1.0, 0.01);
  }
}

TEST(TyreCurveFit, NoiseInBothAndWildPointsDoNotMoveItFar) {
  const TyreCurve curve{0.1, 0.75, 0.4, 0.6};
  std::vector<TyrePoint> points = points_of(curve, 0.03);
  for (std::size_t i = 0; i < points.size(); i += 29) points[i].ratio = 2.0;
  const TyreCurveFit f = fit_tyre_curve(points);
  EXPECT_NEAR(f.curve.extremum_slip, 0.1, 0.02);
  EXPECT_NEAR(f.curve.extremum_value, 0.75, 0.04);
}

TEST(StickingGrip, IsWhatRollingWheelsCarryAndItsSlipIsBounded) {
  TyrePoints points;
  points.radius_m = 0.027;
  points.radius_sigma_m = 0.027e-2;
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  for (int k = 0; k < 4000; ++k) {
    TyrePoint p;
    p.ratio = 1.6 * std::sin(0.01 * k);
    p.slip = 0.004 * normal(random);
    p.slip_sigma = 0.004;
    points.all.push_back(p);
    p.ratio = 0.02;  // and a wheel that slides on ice
    p.slip = 0.7;
    points.all.push_back(p);
  }
  const StickingGrip grip = sticking_grip(points);
  EXPECT_NEAR(grip.most_ratio, 1.6, 0.01);
  EXPECT_GT(grip.slip_bound_95, 0.01);  // R alone is known to 0.01
  EXPECT_LT(grip.slip_bound_95, 0.03);
}

TEST(TyreBins, HoldAllPointsAndTheirMean) {
  const TyreCurve curve{0.1, 0.75, 0.4, 0.6};
  const std::vector<TyreBin> bins = tyre_bins(points_of(curve, 0.0), 10);
  ASSERT_GE(bins.size(), 20u);
  for (const TyreBin& bin : bins) EXPECT_NEAR(bin.ratio, grip<double>(curve, bin.slip), 0.05);
}

}  // namespace
}  // namespace omnihil
