#include "identify/record/surface_noise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace omnihil {
namespace {

struct Table {
  std::vector<double> current_A, speed_rad_s, load_Nm;
};

// A dynamometer's: current of load, friction and drag, with that noise.
Table table(std::size_t rows, double sigma_A) {
  Table out;
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0.0, sigma_A);
  for (std::size_t k = 0; k < rows; ++k) {
    const double speed = 50.0 * static_cast<double>(1 + k % 5), load = 0.01 * static_cast<double>(k / 5);
    out.speed_rad_s.push_back(speed);
    out.load_Nm.push_back(load);
    out.current_A.push_back(0.2 + 0.001 * speed + 12.0 * load + noise(random));
  }
  return out;
}

TEST(SurfaceNoise, IsWhatTheSurfaceLeaves) {
  const Table t = table(400, 0.03);
  EXPECT_NEAR(surface_noise(t.current_A, {t.speed_rad_s, t.load_Nm}), 0.03, 0.003);
}

// Twenty-five rows: too few for a curved surface, enough for a plane. Rows before and after differ by 0.1 A and more.
TEST(SurfaceNoise, OfAFewDozenRowsIsWhatAPlaneLeaves) {
  const Table t = table(25, 0.03);
  EXPECT_NEAR(surface_noise(t.current_A, {t.speed_rad_s, t.load_Nm}), 0.03, 0.015);
  const Table few = table(10, 0.03);
  EXPECT_TRUE(std::isinf(surface_noise(few.current_A, {few.speed_rad_s, few.load_Nm})));
}

}  // namespace
}  // namespace omnihil
