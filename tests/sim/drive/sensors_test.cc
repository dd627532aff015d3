#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "sim/drive/absolute_encoder.h"
#include "sim/drive/current_sensor.h"
#include "tests/sim/drive/phase_bench.h"

namespace omnihil {
namespace {

TEST(HallSensors, CodesFollowTheOrderOfForwardRotation) {
  const int order[] = {3, 2, 6, 4, 5, 1};
  for (int n = -12; n < 12; ++n) {
    EXPECT_EQ(hall_code({}, (60.0 * n - 29.9) * kDegree), order[(n + 12) % 6]);
    EXPECT_EQ(hall_code({}, (60.0 * n + 29.9) * kDegree), order[(n + 12) % 6]);
    EXPECT_EQ(hall_sector(order[(n + 12) % 6]), (n + 12) % 6);
  }
  EXPECT_EQ(hall_sector(0), -1);
  EXPECT_EQ(hall_sector(7), -1);
}

TEST(HallSensors, SectorIsTheBlockWhereTheDrivenPairsBackEmfIsLargest) {
  for (double deg = -179.7; deg < 180.0; deg += 1.0) {
    const auto f = back_emf_shape(kSine, deg * kDegree);
    const BlockLegs legs = block_legs(hall_sector(hall_code({}, deg * kDegree)));
    const std::size_t high = static_cast<std::size_t>(legs.high), low = static_cast<std::size_t>(legs.low);
    for (std::size_t x = 0; x < 3; ++x)
      for (std::size_t y = 0; y < 3; ++y) EXPECT_GE(f[high] - f[low], f[x] - f[y] - 1e-12) << deg;
  }
}

// Forward edge of one sensor: where its level rises, by bisection around 210 degrees + 120 x.
double rising_edge_deg(const HallParams& p, int sensor) {
  double low = 210.0 + 120.0 * sensor - 60.0, high = low + 120.0;
  for (int k = 0; k < 60; ++k) {
    const double mid = 0.5 * (low + high);
    (hall_code(p, mid * kDegree) >> sensor & 1 ? high : low) = mid;
  }
  return low;
}

TEST(HallSensors, OffsetsMoveEachEdgeAndTheMountingErrorAll) {
  const HallParams p{.mounting_error_rad = 3 * kDegree,
                     .sensor_offset_rad = {5 * kDegree, -2 * kDegree, 0.0}};
  EXPECT_NEAR(rising_edge_deg(p, 0), 210.0 + 3.0 + 5.0, 1e-9);
  EXPECT_NEAR(rising_edge_deg(p, 1), 330.0 + 3.0 - 2.0, 1e-9);
  EXPECT_NEAR(rising_edge_deg(p, 2), 450.0 + 3.0, 1e-9);
}

TEST(HallSensors, GlitchesInvertOneLevelAsOftenAsAskedAndTheSameWayAgain) {
  const HallParams p{.glitch_probability = 0.01};
  int glitches = 0;
  for (std::uint64_t k = 0; k < 100000; ++k) {
    const int read = hall_with_glitches(p, 3, {42, 5, k});
    EXPECT_EQ(read, hall_with_glitches(p, 3, {42, 5, k}));
    const int changed = read ^ 3;
    EXPECT_TRUE(changed == 0 || changed == 1 || changed == 2 || changed == 4);
    glitches += changed != 0;
  }
  EXPECT_NEAR(glitches, 1000, 5 * std::sqrt(1000.0));
  EXPECT_EQ(hall_with_glitches({}, 3, {42, 5, 1}), 3);
}

TEST(AbsoluteEncoder, PerfectOneReadsTheFloorOfTheAngle) {
  const AbsoluteEncoderParams p{.bits = 12};
  for (int code = 0; code < 4096; code += 37) {
    const double middle = (code + 0.5) * 2.0 * std::numbers::pi / 4096;
    EXPECT_EQ(absolute_encoder_code(p, middle, 0.0), static_cast<std::uint32_t>(code));
    EXPECT_EQ(absolute_encoder_code(p, middle - 6.0 * std::numbers::pi, 0.0),
              static_cast<std::uint32_t>(code));
    EXPECT_NEAR(absolute_encoder_rad(p, static_cast<std::uint32_t>(code)), middle,
                2.0 * std::numbers::pi / 4096);
  }
}

TEST(AbsoluteEncoder, EccentricityIsOrderOneAndOnlyThat) {
  const AbsoluteEncoderParams p{.eccentricity_rad = 0.01, .eccentricity_phase_rad = 0.7};
  const int n = 360;
  std::array<double, 4> c{}, s{};
  for (int k = 0; k < n; ++k) {
    const double theta = 2.0 * std::numbers::pi * k / n,
                 error = absolute_encoder_angle_rad(p, theta, 0.0) - theta;
    for (std::size_t order = 0; order < 4; ++order) {
      c[order] += 2.0 / n * error * std::cos(static_cast<double>(order) * theta);
      s[order] += 2.0 / n * error * std::sin(static_cast<double>(order) * theta);
    }
  }
  EXPECT_NEAR(std::hypot(c[1], s[1]), 0.01, 1e-12);
  EXPECT_NEAR(std::atan2(c[1], s[1]), 0.7, 1e-9);
  EXPECT_NEAR(std::hypot(c[2], s[2]) + std::hypot(c[3], s[3]) + std::abs(c[0]), 0.0, 1e-12);
}

TEST(AbsoluteEncoder, LatencyLagsInProportionToSpeedAndDirectionTurnsTheSign) {
  const AbsoluteEncoderParams late{.latency_s = 100e-6}, reversed{.direction = -1, .zero_rad = 0.5};
  EXPECT_NEAR(absolute_encoder_angle_rad(late, 1.0, 400.0), 1.0 - 0.04, 1e-15);
  EXPECT_NEAR(absolute_encoder_angle_rad(reversed, 1.0, 400.0), -0.5, 1e-15);
}

TEST(CurrentSensor, CountsAreTheFormulaAndHeldToTheRange) {
  const CurrentSensor s{.shunt_ohm = 2e-3, .amplifier_gain = 20, .reference_V = 3.3, .bits = 12};
  EXPECT_EQ(adc_counts(s, 0.0, {}), 2048);
  EXPECT_EQ(adc_counts(s, 3.0, {}), 2048 + static_cast<int>(3.0 * 0.04 / 3.3 * 4096));
  EXPECT_EQ(adc_counts(s, 1000.0, {}), 4095);
  EXPECT_EQ(adc_counts(s, -1000.0, {}), 0);
  for (double i = -30.0; i < 30.0; i += 0.37)
    EXPECT_NEAR(current_of_counts(s, adc_counts(s, i, {})), i, 0.5001 * current_per_count_A(s));
}

TEST(CurrentSensor, GainErrorAndOffsetComeThroughUnseenByTheFirmware) {
  CurrentSensor s{.shunt_ohm = 2e-3, .bits = 16};
  s.gain_error_ratio = 0.02;
  s.offset_V = 0.01;
  EXPECT_NEAR(current_of_counts(s, adc_counts(s, 10.0, {})), 10.0 * 1.02 + 0.01 / 0.04,
              2 * current_per_count_A(s));
}

TEST(CurrentSensor, NoiseHasItsSizeAndIsAFunctionOfTheKey) {
  const CurrentSensor s{.shunt_ohm = 2e-3, .bits = 16, .noise_sigma_V = 4e-3};
  double sum = 0.0, square = 0.0;
  const int n = 20000;
  for (std::uint64_t k = 0; k < n; ++k) {
    const double i = current_of_counts(s, adc_counts(s, 1.0, {3, 4, k}));
    EXPECT_EQ(adc_counts(s, 1.0, {3, 4, k}), adc_counts(s, 1.0, {3, 4, k}));
    sum += i - 1.0;
    square += (i - 1.0) * (i - 1.0);
  }
  EXPECT_NEAR(std::sqrt(square / n), 4e-3 / 0.04, 0.03 * 0.1);
  EXPECT_NEAR(sum / n, 0.0, 5 * 0.1 / std::sqrt(static_cast<double>(n)));
}

TEST(CurrentSensor, LowSideShuntSeesOnlyWhatFlowsThroughTheLowerSwitch) {
  const SwitchedDrive d =
      make_switched_drive(trapezoid_motor(), {.pwm_frequency_Hz = 20e3}, {.extra_inertia_kg_m2 = 1e3});
  const BridgeCommand c = block_command(0, 1, 0.5, PwmMode::kComplementary);
  SwitchedState x;
  PhaseFlow flow;
  for (int k = 0; k < 100; ++k) advance_period(d, x, c, {.bus_voltage_V = 24.0}, 0.5, flow);
  SwitchedState y = x;
  const PeriodSample on = advance_period(d, x, c, {.bus_voltage_V = 24.0}, 0.5, flow);
  const PeriodSample off = advance_period(d, y, c, {.bus_voltage_V = 24.0}, 0.0, flow);
  const CurrentSensor low{.place = ShuntPlace::kLowSide}, bus{.place = ShuntPlace::kBus}, phase{};
  EXPECT_EQ(shunt_current_A(low, on, 0), 0.0);  // leg 0 is high at mid on-time
  EXPECT_EQ(shunt_current_A(low, off, 0), off.current_A[0]);
  EXPECT_EQ(shunt_current_A(phase, on, 0), on.current_A[0]);
  EXPECT_EQ(shunt_current_A(bus, on, 0), on.current_A[0]);
  EXPECT_EQ(shunt_current_A(bus, off, 0), 0.0);
}

}  // namespace
}  // namespace omnihil
