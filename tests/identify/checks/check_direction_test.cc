// Signs of a drive by torque.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <random>

#include "tests/identify/checks/data_findings.h"
#include "tests/identify/simulated_bench.h"

namespace omnihil {
namespace {

// One run of these channels alone, whose signals the test makes.
void keep_one_run_of(std::initializer_list<const char*> channels, Bench& bench) {
  bench.dataset.channels.clear();
  for (const char* name : channels) {
    bench.dataset.channels.push_back({});
    bench.dataset.channels.back().signal = bench.dataset.channels.back().column = name;
  }
  bench.dataset.runs.resize(1);
}

Bench bench_by_torque() {
  Bench bench = simulated_bench({.drive = CommandKind::kMotorTorque,
                                 .drive_name = "motor_torque",
                                 .amplitude = 0.02,
                                 .with = {},
                                 .model = ""});
  keep_one_run_of({"motor_torque", "position"}, bench);
  return bench;
}

// An arm that a position loop lifts: its weight makes the torque rise while the start's acceleration is over.
TEST(CheckData, AnArmsWeightIsNoSwappedSign) {
  constexpr double kInertia = 2.0, kFriction = 12.0, kWeight = 38.0, kRow_s = 0.002;
  Bench bench = bench_by_torque();
  omnihil::Run& run = bench.dataset.runs[0];
  for (const double sign : {1.0, -1.0}) {
    run.signals.clear();
    run.time_s.clear();
    std::vector<double>&torque = run.signals["motor_torque"], &angle = run.signals["position"];
    std::mt19937 random(7);
    std::normal_distribution<double> noise(0.0, 0.5);
    for (int k = 0; k < 2500; ++k) {  // w = w0 (1 - (1 + t / T) exp(-t / T))
      const double t = kRow_s * k, w0 = 0.5, rise_s = 0.2, left = std::exp(-t / rise_s);
      run.time_s.push_back(t);
      angle.push_back(w0 * (t - 2.0 * rise_s + (t + 2.0 * rise_s) * left));
      torque.push_back(sign * (kInertia * w0 * t / rise_s / rise_s * left + kFriction +
                               kWeight * std::sin(angle.back()) + noise(random)));
    }
    EXPECT_EQ(find(check_data(bench.dataset, bench.nominal), "swapped_sign") != nullptr, sign < 0.0)
        << text_of(check_data(bench.dataset, bench.nominal));
  }
}

// One current per run, and a friction that falls in warming grease: the axis goes on accelerating while nothing of the torque does.
TEST(CheckDirection, ATorqueThatIsHeldHasNoSwappedSign) {
  Bench bench = bench_by_torque();
  omnihil::Run& run = bench.dataset.runs[0];
  run.signals.clear();
  run.time_s.clear();
  double angle = 0.0;
  for (int k = 0; k < 5000; ++k) {
    const double t = 0.002 * k, omega = 20.0 * (1.0 - std::exp(-t / 3.0)) + 2.0 * std::sin(7.0 * angle);
    angle += 0.002 * omega;
    run.time_s.push_back(t);
    run.signals["position"].push_back(angle);
    run.signals["motor_torque"].push_back(0.036);
  }
  EXPECT_EQ(find(check_data(bench.dataset, bench.nominal), "swapped_sign"), nullptr)
      << text_of(check_data(bench.dataset, bench.nominal));
}

// A servo at its speed limit under a square of 0.38 s half a period: it comes late by half of that and more, but it goes where it is
// asked to. One whose sensor counts backwards does not.
TEST(CheckDirection, AServoThatComesLateHasNoSwappedSign) {
  constexpr double kRow_s = 0.02, kHalf_s = 0.38, kTop_rad_s = 4.5, kAmplitude_rad = 0.6, kDelay_s = 0.16;
  Bench bench = simulated_bench(BenchRecipe{});
  keep_one_run_of({"position_target", "position"}, bench);
  omnihil::Run& run = bench.dataset.runs[0];
  const auto target_at = [&](double t) {
    return t < 0.0 ? 0.0 : (static_cast<int>(t / kHalf_s) % 2 == 0 ? kAmplitude_rad : -kAmplitude_rad);
  };
  for (const double sign : {1.0, -1.0}) {
    run.signals.clear();
    run.time_s.clear();
    std::vector<double>&target = run.signals["position_target"], &position = run.signals["position"];
    double at = 0.0;
    for (int k = 0; k < 300; ++k) {
      const double t = kRow_s * k;
      const double late_s = sign > 0.0 ? kDelay_s : 0.0, top = sign > 0.0 ? kTop_rad_s : 4.0 * kTop_rad_s;
      run.time_s.push_back(t);
      target.push_back(target_at(t));
      position.push_back(sign * at);
      at += std::clamp(target_at(t - late_s) - at, -top * kRow_s, top * kRow_s);
    }
    EXPECT_EQ(find(check_data(bench.dataset, bench.nominal), "swapped_sign") != nullptr, sign < 0.0)
        << text_of(check_data(bench.dataset, bench.nominal));
  }
}

}  // namespace
}  // namespace omnihil
