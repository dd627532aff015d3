// Counts to speed: exact at constant speed, right across wraps, deaf to jumps.
#include "firmware_iface/reference/wheel_encoder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "firmware_iface/reference/wheel_tuning.h"
#include "tests/firmware_iface/reference/bench_robot.h"

namespace omnihil::test {
namespace {

constexpr float kDt_s = 1e-3f;
constexpr std::int64_t kMax = std::numeric_limits<std::int64_t>::max();

encoder_setup setup_of(const RobotConfig& config) {
  wheel_tuning tuning{};
  wheel_tuning_init(&tuning, &config, kDt_s);
  return tuning.encoder;
}

std::int64_t wrapped(std::int64_t first, std::int64_t step) {
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(first) + static_cast<std::uint64_t>(step));
}

TEST(WheelEncoder, SpeedIsCountsPerSecondOverCountsPerTurn) {
  const RobotConfig config = geared_robot().config;
  const encoder_setup setup = setup_of(config);
  wheel_encoder encoder{};
  for (int n = 0; n < 100; ++n) wheel_encoder_update(&encoder, &setup, 40 * n, kDt_s);
  const double expected = 2 * std::numbers::pi * 40 / config.encoder_counts_per_rotor_turn / 1e-3;
  EXPECT_NEAR(encoder.omega_rotor_rad_s, expected, 1e-5 * expected);
  EXPECT_NEAR(encoder.omega_rotor_reported_rad_s, expected, 1e-5 * expected);
  EXPECT_NEAR(encoder.accel_rotor_rad_s2, 0.0, 1.0);
}

TEST(WheelEncoder, FirstSampleIsNoMotionWhateverTheCount) {
  const encoder_setup setup = setup_of(geared_robot().config);
  wheel_encoder encoder{};
  wheel_encoder_update(&encoder, &setup, kMax, kDt_s);
  EXPECT_EQ(encoder.omega_rotor_rad_s, 0.0f);
  EXPECT_EQ(encoder.jumps, 0u);
}

TEST(WheelEncoder, WrapOfTheCounterIsNoEventInEitherDirection) {
  const encoder_setup setup = setup_of(geared_robot().config);
  for (const int step : {30, -30}) {
    wheel_encoder plain{}, wrapping{};
    const std::int64_t first = step > 0 ? kMax - 1000 : std::numeric_limits<std::int64_t>::min() + 1000;
    for (int n = 0; n < 100; ++n) {
      wheel_encoder_update(&plain, &setup, step * n, kDt_s);
      wheel_encoder_update(&wrapping, &setup, wrapped(first, step * n), kDt_s);
      ASSERT_EQ(plain.omega_rotor_rad_s, wrapping.omega_rotor_rad_s) << n;
    }
    EXPECT_EQ(wrapping.jumps, 0u);
  }
}

TEST(WheelEncoder, LargeCountsLoseNoResolution) {
  const encoder_setup setup = setup_of(geared_robot().config);
  wheel_encoder small{}, large{};
  const std::int64_t first = std::int64_t{1} << 60;  // beyond what a double holds exactly
  for (int n = 0; n < 50; ++n) {
    wheel_encoder_update(&small, &setup, n, kDt_s);
    wheel_encoder_update(&large, &setup, first + n, kDt_s);
  }
  EXPECT_EQ(small.omega_rotor_rad_s, large.omega_rotor_rad_s);
  EXPECT_GT(large.omega_rotor_rad_s, 0.0f);
}

TEST(WheelEncoder, OneImpossibleJumpIsLeftOutAndCounted) {
  const encoder_setup setup = setup_of(geared_robot().config);
  wheel_encoder encoder{};
  for (int n = 0; n < 20; ++n) wheel_encoder_update(&encoder, &setup, 40 * n, kDt_s);
  const float before = encoder.omega_rotor_rad_s;
  wheel_encoder_update(&encoder, &setup, 0x40000000, kDt_s);  // bit 30 flipped on
  EXPECT_EQ(encoder.omega_rotor_rad_s, before);
  EXPECT_EQ(encoder.jumps, 1u);
  EXPECT_FALSE(wheel_encoder_faulty(&encoder));
  wheel_encoder_update(&encoder, &setup, 40 * 21, kDt_s);  // the way back is a jump, too
  wheel_encoder_update(&encoder, &setup, 40 * 22, kDt_s);
  EXPECT_EQ(encoder.jumps, 2u);
  EXPECT_NEAR(encoder.omega_rotor_rad_s, before, 1e-3);
}

TEST(WheelEncoder, FiveJumpsInARowAreAFaultAndAGoodSampleEndsIt) {
  const encoder_setup setup = setup_of(geared_robot().config);
  wheel_encoder encoder{};
  wheel_encoder_update(&encoder, &setup, 0, kDt_s);
  for (int n = 1; n <= 5; ++n) {
    EXPECT_FALSE(wheel_encoder_faulty(&encoder)) << n;
    wheel_encoder_update(&encoder, &setup, n % 2 * 1'000'000, kDt_s);
  }
  EXPECT_TRUE(wheel_encoder_faulty(&encoder));
  wheel_encoder_update(&encoder, &setup, 1'000'000, kDt_s);
  EXPECT_FALSE(wheel_encoder_faulty(&encoder));
}

TEST(WheelEncoder, FilterGrowsOnlyWhereTheResolutionNeedsIt) {
  RobotConfig config = geared_robot().config;
  EXPECT_EQ(setup_of(config).filter_s, 0.0f);
  config.encoder_counts_per_rotor_turn = 48;  // Hall sensors of eight pole pairs
  const double step = 2 * std::numbers::pi / 48 / 1e-3;
  const double wanted = 0.02 * config.gear_ratio / config.wheel_radius_m;
  EXPECT_NEAR(setup_of(config).filter_s, 1e-3 * (step / wanted - 1), 1e-6);
}

}  // namespace
}  // namespace omnihil::test
