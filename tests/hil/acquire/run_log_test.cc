// What passed becomes rows: times on one clock, commands as the robot took them, noise of its sensors.
#include "hil/acquire/run_log.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "hil/acquire/acquire_folder.h"
#include "hil/acquire/acquired_dataset.h"
#include "hil/text/dataset_files.h"
#include "tests/hil/recording/fake_run.h"

namespace omnihil {
namespace {

constexpr std::int64_t kMs = 1'000'000;

TEST(RunLog, AFrameStandsAtItsCaptureOnOurClock) {
  RunLog log;
  log.driving_from_ns = 0;
  log.end_ns = 10'000 * kMs;
  log.sent = {{0, {1, 0, 0}, false}};
  for (int k = 0; k < 300; ++k) {  // captured 5 ms before it is sent; the way takes 2 ms, then more
    const double captured = 1000.0 + k / 60.0;
    log.cameras[0].add(captured + 0.005, captured + 0.005 - 1000.0 + (k % 7 == 0 ? 0.002 : 0.006));
    log.seen.push_back({0, captured, 0.1 * k, 0.0, 0.0});
  }
  const RunRows rows = run_rows(log, PlanDrive::kBodyVelocity);
  const std::vector<double>& x = *rows.column("vision_x");
  int frames = 0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    if (!std::isfinite(x[k])) continue;
    // The first row is the command at 0 (a frame of the same 2 ms is 0.002 later); the least way is in the offset.
    EXPECT_NEAR(rows.time_s[k] - 0.002, x[k] / 0.1 / 60.0, 1e-6);
    ++frames;
  }
  EXPECT_EQ(frames, 300);
}

TEST(RunLog, CommandsInTheFieldsFrameAreTurnedBackByTheRobotsHeading) {
  RunLog log;
  log.end_ns = 5'000 * kMs;
  for (int k = 0; k < 100; ++k) {  // the robot turns at 2 rad/s; asked for 1 m/s along the field's x
    HeardTelemetry h;
    h.now_ns = k * 16 * kMs;
    h.told.yaw_rad = std::remainder(2.0 * 0.016 * k, 2.0 * 3.14159265358979);
    log.told.push_back(h);
  }
  log.sent = {{0, {1.0, 0.0, 2.0}, true}};
  const RunRows rows = run_rows(log, PlanDrive::kBodyVelocity);
  const auto &vx = *rows.column("cmd_vx"), &vy = *rows.column("cmd_vy"), &w = *rows.column("cmd_w");
  ASSERT_EQ(vx.size(), 100u);
  for (std::size_t k = 0; k < vx.size(); ++k) {
    EXPECT_NEAR(vx[k], std::cos(2.0 * rows.time_s[k]), 1e-6);
    EXPECT_NEAR(vy[k], -std::sin(2.0 * rows.time_s[k]), 1e-6);
    EXPECT_EQ(w[k], 2.0);
  }
}

TEST(RunLog, RowsBeginALittleBeforeItDrives) {
  RunLog log;
  log.driving_from_ns = 1000 * kMs;
  log.end_ns = 2000 * kMs;
  for (int k = 0; k < 200; ++k) log.sent.push_back({k * 20 * kMs, {k < 50 ? 0.0 : 1.0, 0, 0}, false});
  const RunRows rows = run_rows(log, PlanDrive::kBodyVelocity);
  EXPECT_EQ(rows.time_s.size(), 61u);  // 0.8 to 2.0 s at 50 Hz
  EXPECT_EQ((*rows.column("cmd_vx"))[9], 0.0);
  EXPECT_EQ((*rows.column("cmd_vx"))[10], 1.0);
}

TEST(RunLog, WhatIsWrittenIsReadBack) {
  RunLog log;
  log.end_ns = 100 * kMs;
  log.sent = {{0, {0.5, -0.25, 1.5}, false}};
  HeardTelemetry h;
  h.now_ns = 10 * kMs;
  h.told.omega_wheel_rad_s = {1, 2, 3, 4};
  h.told.battery_V = 22.5;
  log.told = {h};
  const RunRows rows = run_rows(log, PlanDrive::kBodyVelocity);
  const RunRows again = rows_from_csv(rows_csv(rows), "r.csv");
  EXPECT_EQ(again.columns, rows.columns);
  EXPECT_EQ(rows_csv(again), rows_csv(rows));
  EXPECT_EQ(rows.column("gyro_z"), nullptr);  // never told
}

TEST(AcquiredDataset, NoiseIsThatOfSteadyDriving) {
  AcquirePlan plan;
  plan.runs = {{"r", Split::kTraining, "", 20.0, {}}};
  std::mt19937_64 random(1);
  std::normal_distribution<double> noise(0.0, 0.2);
  RunRows rows;
  rows.columns = {"cmd_vx", "cmd_vy", "cmd_w", "wheel_1"};
  rows.values.resize(4);
  double speed = 0.0;
  for (int k = 0; k < 1200; ++k) {  // steps of 40 rad/s each second, followed within 30 ms
    const double wanted = (k / 60) % 2 == 0 ? 40.0 : 80.0;
    speed += 0.5 * (wanted - speed);
    rows.time_s.push_back(k / 60.0);
    rows.values[0].push_back(wanted / 40.0);
    rows.values[1].push_back(0.0);
    rows.values[2].push_back(0.0);
    rows.values[3].push_back(speed + noise(random));
  }
  const std::vector<AcquiredRun> runs{{&plan.runs[0], rows}};
  EXPECT_NEAR(steady_noise(plan, runs, 0.0).at("wheel_1"), 0.2, 0.02);  // 840 differences: 4 %
  EXPECT_NEAR(steady_noise(plan, runs, 3.0).at("wheel_1"), 3.0 / std::sqrt(12.0), 1e-12);
  const std::string text = acquired_dataset_text(plan, runs, {{"wheel_1", 0.2}}, "ulaval-hermes");
  EXPECT_NE(text.find("wheel_speed_1 = { column = \"wheel_1\", sigma = 0.2 }"), std::string::npos) << text;
  EXPECT_EQ(text.find("vision"), std::string::npos);
}

TEST(AcquireFolder, AFinishedRunStaysAndTheNameComesLast) {
  fake::TempFolder folder;
  const std::filesystem::path out = folder / "bench";
  {
    AcquireFolder f(out, "plan", "model", false);
    f.add_run("a", "time_s\n", "bytes", "note a");
  }
  EXPECT_FALSE(std::filesystem::exists(out));
  EXPECT_THROW(AcquireFolder(out, "plan", "model", false), FileExists);
  EXPECT_THROW(AcquireFolder(out, "another plan", "model", true), std::invalid_argument);
  AcquireFolder f(out, "plan", "model", true);
  EXPECT_TRUE(f.has("a"));
  EXPECT_FALSE(f.has("b"));
  EXPECT_EQ(f.note("a"), "note a");
  f.describe("dataset", "readme");
  f.finish();
  EXPECT_TRUE(std::filesystem::exists(out / "dataset.toml"));
  EXPECT_TRUE(std::filesystem::exists(out / "packets" / "a.txt"));
  EXPECT_FALSE(std::filesystem::exists(f.making()));
  EXPECT_THROW(AcquireFolder(out, "plan", "model", false), FileExists);
}

}  // namespace
}  // namespace omnihil
