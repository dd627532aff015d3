// Experiments for a robot that radio commands drive: what is planned are commands, and the model with its controller answers them.
#include <cmath>

#include "identify/design/experiment_menu.h"
#include "identify/design/experiment_truth.h"
#include "identify/record/rig.h"
#include "tests/identify/simulated_radio.h"

namespace omnihil::test {
namespace {

// Two seconds at 60 Hz of 0.8 m/s ahead; or of 20 rad/s of each wheel.
Dataset given(bool wheels) {
  Dataset d;
  d.rig = &rig_robot();
  Run run;
  run.file = "drive.csv";
  for (int k = 0; k < 120; ++k) run.time_s.push_back(k / 60.0);
  const auto add = [&](const std::string& signal, double value, double sigma) {
    d.channels.push_back({.signal = signal, .column = signal, .unit = "", .sigma = sigma});
    run.signals[signal].assign(run.time_s.size(), value);
  };
  if (wheels) {
    for (const char* w : {"1", "2", "3", "4"}) add(std::string("command_wheel_") + w, 20.0, 0.0);
  } else {
    add("command_vx", 0.8, 0.0);
    add("command_vy", 0.0, 0.0);
    add("command_w", 1.0, 0.0);
  }
  for (const char* w : {"1", "2", "3", "4"}) add(std::string("wheel_speed_") + w, 0.0, 0.3);
  add("vision_x", 0.0, 0.001);
  add("vision_y", 0.0, 0.001);
  d.runs = {run};
  return d;
}

PlannedInputs ahead(double speed_m_s) {
  PlannedInputs in;
  in.drive.resize(3);
  for (int k = 0; k < 120; ++k) {
    in.time_s.push_back(k / 60.0);
    in.drive[0].push_back(speed_m_s);
    in.drive[1].push_back(0.0);
    in.drive[2].push_back(0.0);
  }
  return in;
}

TEST(RadioExperiment, WhatIsPlannedAreCommandsAsLargeAsTheGivenOnes) {
  const Dataset d = given(false);
  const auto predictor = make_predictor(d, radio_candidate(), {});
  const PlannedBench bench = planned_bench(d, radio_candidate(), *predictor);
  EXPECT_EQ(bench.problem, "");
  EXPECT_EQ(bench.inputs, (std::vector<std::string>{"command_vx", "command_vy", "command_w"}));
  EXPECT_DOUBLE_EQ(bench.full_input, 0.8);
  ASSERT_EQ(bench.input_scale.size(), 3u);
  EXPECT_NEAR(bench.input_scale[2], 1.0 / 0.0805, 1e-9);  // a rim as fast as the body
  const Dataset w = given(true);
  const PlannedBench wheels = planned_bench(w, radio_candidate(), *make_predictor(w, radio_candidate(), {}));
  EXPECT_EQ(wheels.inputs.front(), "command_wheel_1");
  EXPECT_DOUBLE_EQ(wheels.full_input, 20.0);
}

TEST(RadioExperiment, TheModelAnswersPlannedCommands) {
  const Dataset d = given(false);
  const Candidate model = radio_candidate();
  const PlannedBench bench = planned_bench(d, model, *make_predictor(d, model, {}));
  const MotionExtremes m = planned_extremes(bench, ahead(0.5), model);
  EXPECT_TRUE(m.finite);
  // 0.5 m/s for 119 / 60 s, less the latency of 20 ms and the way lost while it accelerates (0.5 / 6 / 2 = 42 ms)
  EXPECT_NEAR(m.travel, 0.5 * (119.0 / 60.0 - 0.02 - 0.042), 0.02);
  EXPECT_GT(m.current_A, 0.1);
  const auto truth = simulated_truth(bench, ahead(0.5), model, 1);
  const Prediction y = truth->predict(model, 0);
  double farthest = 0.0;
  for (std::size_t s = 0; s < truth->compared(0).size(); ++s) {
    if (truth->compared(0)[s].name != "vision_x") continue;
    for (const double v : y.values[s]) farthest = std::isfinite(v) ? std::max(farthest, v) : farthest;
  }
  EXPECT_NEAR(farthest, m.travel, 0.02);
}

TEST(RadioExperiment, TheBodysMenuIsTheWheelsBeforeTheyAreMixed) {
  std::vector<double> time_s;
  for (int k = 0; k < 600; ++k) time_s.push_back(k / 60.0);
  const auto body = body_menu(time_s, 1);
  const auto wheels = robot_menu(time_s, std::vector<double>{0.96, 2.36, 3.93, 5.32}, 1);
  ASSERT_EQ(wheels.size(), body.size() + 1);  // one wheel against all four has no twist
  for (std::size_t n = 0; n < body.size(); ++n) {
    EXPECT_EQ(body[n].excitation, wheels[n].excitation);
    ASSERT_EQ(body[n].drive.size(), 3u);
    double largest = 0.0;
    for (const auto& drive : body[n].drive) {
      for (const double v : drive) largest = std::max(largest, std::abs(v));
    }
    EXPECT_NEAR(largest, 1.0, 1e-12) << body[n].excitation;
  }
}

}  // namespace
}  // namespace omnihil::test
