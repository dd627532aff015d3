// Two causes at once: planted in the recorded robot, both named with their sizes; and none where there is but one.
#include "hil/check/explain_pair.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "hil/loop/effect_overrides.h"
#include "tests/hil/check/driven_robots.h"

namespace omnihil {
namespace {

// Torque constant and supply, both off.
SessionSetup worn(double torque_factor, double supply_ohm) {
  SessionSetup setup = driven::with_torque_constant(torque_factor);
  std::vector<std::string> faults;
  add_effects(setup.model, {"battery_sag.resistance_ohm=" + std::to_string(supply_ohm)}, faults);
  EXPECT_TRUE(faults.empty());
  return setup;
}

const ExplainedBy* named(const DifferenceExplained& all, const std::string& name) {
  for (const auto* by : {&all.found, &all.second}) {
    if (!by->empty() && by->front().name == name) return &by->front();
  }
  return nullptr;
}

TEST(ExplainPair, FindsBothOfTwoPlantedCausesAndTheirSizes) {
  Recording recording = driven::drive(worn(1.06, 0.15), 4000);
  driven::add_noise(recording, 3);
  const DifferenceExplained all = driven::explained(recording);
  const ExplainedBy* torque = named(all, "motor.torque_constant_Nm_per_A");
  const ExplainedBy* supply = named(all, "battery_sag.resistance_ohm");
  ASSERT_TRUE(torque != nullptr && supply != nullptr) << explained_text(all);
  EXPECT_TRUE(all.second_certain) << explained_text(all);
  EXPECT_TRUE(all.headline.starts_with("found: ")) << all.headline;
  EXPECT_NEAR(torque->is / torque->was, 1.06, 0.015) << explained_text(all);
  EXPECT_NEAR(supply->is, 0.15, 0.03) << explained_text(all);
  EXPECT_LT(all.left_over_noise, 1.5);
}

// One cause, and something that no model has: a gyro that hears a motor. It gets no second name.
TEST(ExplainPair, WhatNoCandidateMakesGetsNoName) {
  Recording recording = driven::drive(driven::with_torque_constant(1.05), 4000);
  driven::add_noise(recording, 4);
  const auto& columns = recording.header.columns;
  for (RecordedChunk& chunk : recording.chunks) {
    for (std::size_t i = 0; i < chunk.sample.size(); ++i) {
      if (columns[i] == "gyro_z_rad_s")
        chunk.sample[i] +=
            0.06 * std::sin(2.0 * std::numbers::pi * 3.7 * 1e-9 * static_cast<double>(chunk.now_ns));
    }
  }
  const DifferenceExplained all = driven::explained(recording);
  ASSERT_FALSE(all.found.empty()) << all.headline;
  EXPECT_EQ(all.found.front().name, "motor.torque_constant_Nm_per_A") << explained_text(all);
  EXPECT_TRUE(all.second.empty()) << explained_text(all);
  EXPECT_FALSE(all.second_certain) << explained_text(all);
}

}  // namespace
}  // namespace omnihil
