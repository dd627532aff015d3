#include "sim/drive/motion_record.h"

#include <gtest/gtest.h>

namespace omnihil {
namespace {

// A motion that the interpolation follows exactly: angle cubic in time, speed its derivative at the points.
MotionPoint<double> cubic(double t) {
  MotionPoint<double> p;
  p.time_s = t;
  p.theta_rad = 3.0 * t * t * t - 2.0 * t;
  p.omega_rad_s = 9.0 * t * t - 2.0;
  p.charge_C = 5.0 * t;
  return p;
}

TEST(MotionRecord, GivesTheMotionOfItsWholeSpanHoweverManyPointsThatTakes) {
  const double span_s = 1.0, step_s = 1e-4;  // 10,000 points in the span
  MotionRecord<double> record(span_s);
  for (int k = 0; k <= 60'000; ++k) {
    const double now_s = k * step_s;
    record.push(cubic(now_s));
    if (k % 997 != 0) continue;
    for (const double age_s : {0.3e-4, 0.01, 0.5, 0.99}) {
      if (age_s > now_s) continue;
      const MotionPoint<double> p = record.at(now_s - age_s), want = cubic(now_s - age_s);
      ASSERT_NEAR(p.theta_rad, want.theta_rad, 1e-9) << now_s << " s, " << age_s << " s ago";
      ASSERT_NEAR(p.charge_C, want.charge_C, 1e-9);
    }
  }
}

TEST(MotionRecord, MovedOnAtItsFirstSpeedBeforeItsFirstPoint) {
  MotionRecord<double> record(1.0);
  for (int k = 0; k < 3; ++k) record.push({.time_s = 1.0 + k, .theta_rad = 7.0, .omega_rad_s = 2.0});
  EXPECT_DOUBLE_EQ(record.at(0.5).theta_rad, 6.0);
  EXPECT_DOUBLE_EQ(record.at(1.0).theta_rad, 7.0);
}

}  // namespace
}  // namespace omnihil
