// What an effect's file says of its parameters and of the rig that it needs is true of its law.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/law/drive_params.h"
#include "sim/rolling/rolling_params.h"
#include "tests/sim/effects/port_cases.h"

namespace omnihil::test {
namespace {

using EffectTraits = EveryEffect;

// Half a turn either way and the start itself, wherever that is: the law is the same after a whole turn.
TEST_P(EffectTraits, AnAngleThatGoesRoundGoesRound) {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  for (std::size_t i = 0; i < info().params.size(); ++i) {
    const EffectParam& row = info().params[i];
    if (row.trait != ParamTrait::kPeriodic) continue;
    EXPECT_EQ(row.role, ParamRole::kShape) << row.name;
    EXPECT_EQ(row.unit, "rad") << row.name;
    EXPECT_LE(row.lower, -std::numbers::pi) << row.name;
    EXPECT_GE(row.upper, std::numbers::pi) << row.name;
    std::vector<double> at = typical_use(entry()).values;
    if (i > 0 && info().params[i - 1].role == ParamRole::kDetail) at[i - 1] = info().params[i - 1].typical;
    std::vector<double> round = at;
    round[i] += kTurn;
    for_each_place<double>(entry(), [&](auto function, auto port) {
      for (std::uint64_t n = 0; n < 50; ++n) {
        const auto a = changes(applied<double>(entry(), function, port, at, n));
        const auto b = changes(applied<double>(entry(), function, port, round, n));
        for (std::size_t c = 0; c < a.size(); ++c) {
          EXPECT_NEAR(b[c].value, a[c].value, 1e-12 * (1.0 + std::abs(a[c].value))) << row.name;
        }
      }
    });
  }
}

TEST_P(EffectTraits, AngularShapesSayWhetherTheyGoRound) {
  for (const EffectParam& row : info().params) {
    if (row.role != ParamRole::kShape || row.unit != "rad") continue;
    EXPECT_EQ(row.trait, ParamTrait::kPeriodic) << row.name;
  }
}

// What has a phase and depends on the angle of a shaft says of which; sensors that need that angle need not.
TEST_P(EffectTraits, ALawOfTheAngleSaysSo) {
  const bool phase = std::any_of(info().params.begin(), info().params.end(),
                                 [](const EffectParam& row) { return row.trait == ParamTrait::kPeriodic; });
  if (!phase || (info().demands & kNeedsAngle) != 0) {
    EXPECT_EQ(info().of_angle, LawOfAngle::kNone);
    return;
  }
  const auto turned = [&](auto turn) {
    bool moved = false;
    for_each_place<double>(entry(), [&](auto function, auto port) {
      const std::vector<double> at = typical_use(entry()).values;
      const auto a = changes(applied<double>(entry(), function, port, at, 0));
      const auto after_turn = [&](const void* context, const double* p, double* x, decltype(port)& q) {
        turn(q);
        function(context, p, x, q);
      };
      const auto b = changes(applied<double>(entry(), after_turn, port, at, 0));
      for (std::size_t c = 0; c < a.size(); ++c) moved = moved || a[c].value != b[c].value;
    });
    return moved;
  };
  const bool of_rotor = turned([](auto& q) {
    if constexpr (requires { q.theta_rotor_rad; }) q.theta_rotor_rad += 0.1;
  });
  const bool of_output = turned([](auto& q) {
    if constexpr (requires { q.theta_output_rad; }) q.theta_output_rad += 0.1;
    if constexpr (requires { q.theta_wheel_rad; }) q.theta_wheel_rad += 0.1;
  });
  EXPECT_EQ(info().of_angle, of_rotor    ? LawOfAngle::kRotor
                             : of_output ? LawOfAngle::kOutput
                                         : LawOfAngle::kNone);
}

TEST_P(EffectTraits, WholeNumbersAndTimesHaveTheUnitsOfSuch) {
  for (const EffectParam& row : info().params) {
    if (is_whole(row)) {
      EXPECT_EQ(row.role, ParamRole::kShape) << row.name;
      EXPECT_EQ(row.unit, "1") << row.name;
      EXPECT_GE(row.lower, 1.0) << row.name;
    }
    // an inductance over a resistance is a time
    const bool time = row.unit == "s" || row.unit == "H";
    EXPECT_TRUE(row.trait != ParamTrait::kTime || time) << row.name;
    EXPECT_TRUE(row.trait != ParamTrait::kForm || row.role == ParamRole::kShape) << row.name;
  }
}

TEST_P(EffectTraits, GridsLieWithinTheBounds) {
  for (const EffectParam& row : info().params) {
    for (const double at : row.grid.at) {
      EXPECT_GE(at, 0.0) << row.name;
      if (row.grid.of == GridOf::kAbsolute && at != 0.0) {
        EXPECT_GE(at, row.lower) << row.name;
        EXPECT_LE(at, row.upper) << row.name;
      }
      // a share of the largest that the data hold
      const bool share = row.grid.of == GridOf::kTopSpeed || row.grid.of == GridOf::kTopCurrent;
      EXPECT_TRUE(!share || at <= 1.0) << row.name;
    }
    if (row.grid.of != GridOf::kStart) {
      EXPECT_EQ(row.role, ParamRole::kShape) << row.name << ": a strength is tried about its visible size";
      EXPECT_GT(row.grid.at[0], 0.0) << row.name << ": nothing to try";
    }
  }
}

TEST_P(EffectTraits, ASeriesIsOfDetailsWithAPhaseEach) {
  const HarmonicSeries series = series_of(info());
  for (int k = 2; k <= series.count + 1; ++k) {
    const std::size_t row = harmonic_row(series, k);
    ASSERT_LT(row + 1, info().params.size());
    EXPECT_EQ(harmonic_of(series, row), k);
    EXPECT_EQ(info().params[row].role, ParamRole::kDetail) << info().params[row].name;
    EXPECT_EQ(info().params[row + 1].trait, ParamTrait::kPeriodic) << info().params[row + 1].name;
  }
  EXPECT_TRUE(series.count == 0 || info().params[0].role == ParamRole::kStrength) << "of the order itself";
}

TEST_P(EffectTraits, WhatItExcludesIsABaseParameter) {
  if (info().excludes.path.empty()) return;
  const auto drive = drive_param_paths();
  const auto robot = rolling_paths();
  const bool known = std::any_of(drive.begin(), drive.end(),
                                 [&](const DriveParamPath& p) { return p.path == info().excludes.path; }) ||
                     std::find(robot.begin(), robot.end(), info().excludes.path) != robot.end();
  EXPECT_TRUE(known) << info().excludes.path;
}

INSTANTIATE_TEST_SUITE_P(Effects, EffectTraits,
                         ::testing::ValuesIn(all_effects().begin(), all_effects().end()),
                         [](const auto& given) { return std::string(given.param->info->id); });

}  // namespace
}  // namespace omnihil::test
