#include "identify/record/held_readings.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace omnihil {
namespace {

constexpr double kRow_s = 0.005;

// A position that turns at 3 to 9 rad/s, both ways.
double angle_at(double t) { return 4.0 * std::sin(1.5 * t) + 3.0 * std::sin(0.6 * t); }

// Read every `period_s`, rounded to `step`, and repeated in the rows between.
std::vector<double> held_angle(double period_s, double step, std::size_t rows) {
  std::vector<double> out;
  for (std::size_t k = 0; k < rows; ++k) {
    const double read_s = std::floor(static_cast<double>(k) * kRow_s / period_s + 1e-9) * period_s;
    out.push_back(std::round(angle_at(read_s) / step) * step);
  }
  return out;
}

TEST(HeldReadings, RowsFromReadingToReadingAreThoseOfTheSensorsPeriod) {
  for (const double rows : {2.0, 3.0, 10.0, 40.0}) {
    const std::vector<double> angle = held_angle(rows * kRow_s, 1e-3, 4000);
    EXPECT_EQ(rows_held({&angle}), rows) << rows;
  }
}

// A period of 9.6 rows is one of nine or ten.
TEST(HeldReadings, ClocksSideBySideMayBeOffByARow) {
  const std::vector<double> angle = held_angle(9.6 * kRow_s, 1e-3, 4000);
  EXPECT_NEAR(rows_held({&angle}), 9.6, 0.6);
}

TEST(HeldReadings, ACoarseSensorIsNotHeld) {
  const std::vector<double> angle = held_angle(kRow_s, 0.2, 4000);
  EXPECT_EQ(rows_held({&angle}), 0.0);
  std::vector<double> even;  // at one speed the steps come as evenly as readings would
  for (std::size_t k = 0; k < 4000; ++k) even.push_back(std::floor(0.1 * static_cast<double>(k) + 1e-9));
  EXPECT_EQ(rows_held({&even}), 0.0);
}

TEST(HeldReadings, NoiseOfAFewStepsIsNotHeld) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal(0.0, 1.0);
  for (const double sigma_steps : {0.3, 0.6, 2.0}) {
    std::vector<double> current;
    for (std::size_t k = 0; k < 4000; ++k) current.push_back(std::round(sigma_steps * normal(random)));
    EXPECT_EQ(rows_held({&current}), 0.0) << sigma_steps;
  }
}

TEST(HeldReadings, TooFewChangesSayNothing) {
  const std::vector<double> angle = held_angle(10.0 * kRow_s, 1e-3, 150);
  EXPECT_EQ(rows_held({&angle}), 0.0);
  EXPECT_EQ(rows_held({&angle, &angle}), 10.0);  // runs of one signal count together
}

TEST(HeldReadings, EmptyRowsRepeatNothing) {
  std::vector<double> angle = held_angle(10.0 * kRow_s, 1e-3, 4000);
  empty_repeats(angle);
  EXPECT_EQ(rows_held({&angle}), 0.0);
}

TEST(HeldReadings, WhatIsLeftAreTheReadings) {
  std::vector<double> x = {1.0, 1.0, NAN, 1.0, 2.0, 2.0, 1.0};
  empty_repeats(x);
  std::vector<double> left;
  for (std::size_t k : {0u, 4u, 6u}) left.push_back(x[k]);
  EXPECT_EQ(left, (std::vector<double>{1.0, 2.0, 1.0}));
  for (std::size_t k : {1u, 2u, 3u, 5u}) EXPECT_TRUE(std::isnan(x[k])) << k;
}

}  // namespace
}  // namespace omnihil
