#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/identify/checks/data_findings.h"
#include "tests/identify/simulated_bench.h"
#include "tests/identify/simulated_robot.h"

namespace omnihil {
namespace {

// A robot's record, once made by our own model and once measured (where that recording is at hand).
class SpoiltRobot : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    if (GetParam() == std::string("simulated")) {
      dataset = test::robot_record({}, 6.0);  // 375 camera frames
      nominal = test::robot_candidate();
      return;
    }
    const auto data = shared_data();
    if (!data || !std::filesystem::exists(*data / "robot_sample"))
      GTEST_SKIP() << "OMNIHIL_SHARED has no folder robot_sample";
    DatasetReading read = read_dataset((*data / "robot_sample").string());
    ASSERT_TRUE(read.dataset) << all_text(read.problems);
    dataset = std::move(*read.dataset);
    nominal = std::move(*read.nominal);
  }
  void expect(const char* kind, const char* signal) {
    const auto findings = check_data(dataset, nominal);
    const bool said = std::any_of(findings.begin(), findings.end(), [&](const DataFinding& f) {
      return f.kind == kind && f.signal == signal && f.grade == Grade::kFault;
    });
    EXPECT_TRUE(said) << text_of(findings);
  }
  Dataset dataset;
  Candidate nominal;
};

TEST_P(SpoiltRobot, OneEncoderThatCountsBackwards) {
  for (omnihil::Run& run : dataset.runs) {
    for (double& v : run.signals.find("encoder_3")->second) v = -v;
  }
  expect("swapped_sign", "encoder_3");
}

// A turn on the spot: all wheels have one duty, and its column is there once.
TEST_P(SpoiltRobot, WheelsThatAreDrivenAlike) {
  int wheels = 0;
  for (Channel& c : dataset.channels) {
    if (c.signal.starts_with("duty_")) c.column = "u", ++wheels;
  }
  ASSERT_GE(wheels, 3);
  const auto findings = check_data(dataset, nominal);
  const auto says = [&](const std::string& kind, const std::string& signal) {
    return std::ranges::any_of(
        findings, [&](const DataFinding& f) { return f.kind == kind && f.signal.starts_with(signal); });
  };
  EXPECT_FALSE(says("same_column", "duty_")) << text_of(findings);
  EXPECT_TRUE(says("driven_alike", "u")) << text_of(findings);
}

TEST_P(SpoiltRobot, AGyroUpsideDown) {
  for (omnihil::Run& run : dataset.runs) {
    for (double& v : run.signals.find("gyro_z")->second) v = -v;
  }
  expect("swapped_sign", "gyro_z");
}

// A straight drive along x leaves y as it is; a camera that sees no y in any run is not connected.
TEST_P(SpoiltRobot, ACoordinateThatNeverMoves) {
  ASSERT_GE(dataset.runs.size(), 2u);
  std::size_t left = dataset.runs.size();
  for (omnihil::Run& run : dataset.runs) {
    for (const char* signal : {"vision_y", "encoder_2"}) {
      for (double& v : run.signals.find(signal)->second) v = std::isfinite(v) ? 17.0 : v;
    }
    if (--left == 0) break;
    for (const DataFinding& f : check_data(dataset, nominal)) {
      if (f.kind != "constant") continue;
      EXPECT_EQ(f.grade, f.signal == "encoder_2" ? Grade::kDoubt : Grade::kNote) << f.sentence;
    }
  }
  expect("constant", "vision_y");
  expect("constant", "encoder_2");
}

TEST_P(SpoiltRobot, CountsPerTurnOfOneEncoderWrong) {
  for (Channel& channel : dataset.channels) {
    if (channel.signal == "encoder_2") channel.counts_per_rev /= 4.0;
  }
  expect("wrong_scale", "encoder_2");
}

TEST_P(SpoiltRobot, ACameraThatJumps) {
  std::vector<double>& x = dataset.runs[0].signals.find("vision_x")->second;
  int frame = 0;
  for (double& v : x) {
    if (std::isfinite(v) && ++frame % 100 == 0) v += 2.0;
  }
  expect("glitch", "vision_x");
}

TEST_P(SpoiltRobot, AsItIsHasNoFault) {
  const auto findings = check_data(dataset, nominal);
  EXPECT_EQ(count(findings, Grade::kFault), 0) << text_of(findings);
}

INSTANTIATE_TEST_SUITE_P(Records, SpoiltRobot, testing::Values("simulated", "recorded"),
                         [](const auto& test) { return std::string(test.param); });

// Telemetry every 16 ms and camera frames every 17 ms, each in rows of its own.
Dataset two_clocks(double telemetry_late_s) {
  Dataset d = test::blank_robot(12.0, false);
  for (omnihil::Run& run : d.runs) {
    const omnihil::Run full = run;
    run.time_s.clear();
    for (auto& [name, values] : run.signals) values.clear();
    for (std::size_t k = 0; k < full.time_s.size(); ++k) {
      const bool telemetry = k % 16 == 0, frame = k % 17 == 5;
      if (!telemetry && !frame) continue;
      const bool late = !frame && k % 480 == 0;
      run.time_s.push_back(full.time_s[k] + (late ? telemetry_late_s : 0.0));
      for (auto& [name, values] : run.signals) {
        const bool camera = name.starts_with("vision");
        const double v = full.signals.find(name)->second[k];
        values.push_back((camera ? frame : telemetry) ? (std::isfinite(v) ? v : 0.0) : std::nan(""));
      }
    }
  }
  return d;
}

TEST(CheckDataClock, RowsOfTwoClocksAreNoLateRows) {
  for (const auto& [late_s, faults] : {std::pair(0.0, false), std::pair(0.0105, true)}) {
    const auto findings = check_data(two_clocks(late_s), test::robot_candidate());
    const bool said = std::any_of(findings.begin(), findings.end(), [](const DataFinding& f) {
      return f.kind == "late_timestamps" && f.signal != "time";
    });
    EXPECT_EQ(said, faults) << text_of(findings);
  }
}

// The dribbler's speed that was asked for stands in the rows of both.
TEST(CheckDataClock, WhatIsAskedInEveryRowHasNoClock) {
  Dataset d = two_clocks(0.0);
  d.channels.push_back({.signal = "dribbler", .column = "dribbler", .unit = "rad/s"});
  for (omnihil::Run& run : d.runs) run.signals["dribbler"].assign(run.time_s.size(), 0.0);
  const auto findings = check_data(d, test::robot_candidate());
  EXPECT_TRUE(std::none_of(findings.begin(), findings.end(), [](const DataFinding& f) {
    return f.kind == "late_timestamps";
  })) << text_of(findings);
}

}  // namespace
}  // namespace omnihil
