// Bytes of a host and of a dongle, and a table of the cameras, become the rows of a measurement.
#include "hil/acquire/tapped_dataset.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "hil/acquire/acquired_dataset.h"

namespace omnihil {
namespace {

constexpr std::int64_t kMs = 1'000'000;
constexpr int kRobot = 5;

// Three seconds: 0.5 m/s along the field's x at 50 Hz, a robot that stands at a heading of 90 degrees.
Recording tapped(const RadioFormat& format, std::uint32_t flags) {
  Recording r;
  r.header.radio_format = format.id;
  r.header.robot_ids = {kRobot};
  r.header.team = Team::kBlue;
  r.header.step_ns = kMs;
  const auto link = format.make_link({.robot_ids = {kRobot}, .team = Team::kBlue});
  struct : RadioSink {
    void deliver(const Delivery&, std::int64_t) override {}
  } nobody;
  RobotFeedback f{};
  f.battery_V = 22.0F;
  f.yaw_rad = 1.5707963F;
  f.omega_wheel_rad_s[2] = 30.0F;
  for (std::int64_t now = 0; now < 3000 * kMs; now += kMs) {
    if (now % (20 * kMs) == 0) {
      RobotCommand c{};
      c.mode = OMNIHIL_MODE_BODY_VELOCITY;
      c.flags = flags;
      c.v_forward_m_s = 0.5;
      RecordedChunk chunk{.kind = RecordedChunk::Kind::kHostBytes, .now_ns = now, .bytes = {}, .sample = {}};
      EXPECT_TRUE(
          format.encode_command(c, {.robot_id = kRobot, .team = Team::kBlue, .tell_all = true}, chunk.bytes));
      link->host_bytes(chunk.bytes, now);
      r.chunks.push_back(chunk);
    }
    link->poll(now, nobody);
    link->robot_feedback(kRobot, f, {}, now);
    RecordedChunk answer{.kind = RecordedChunk::Kind::kDongleBytes, .now_ns = now, .bytes = {}, .sample = {}};
    link->take_host_bytes(now, answer.bytes);
    if (!answer.bytes.empty()) r.chunks.push_back(answer);
  }
  r.end_ns = 3000 * kMs;
  return r;
}

std::string cameras() {
  std::string csv = "time_s,camera,team,robot,x_m,y_m,yaw_rad,arrived_s\n";
  for (int k = 0; k < 180; ++k) {
    csv += fmt::format("{:.6f},0,blue,5,{:.4f},0.0,1.57,0\n", k / 60.0, 0.5 * k / 60.0);
    csv += fmt::format("{:.6f},0,yellow,5,7.0,7.0,0.0,0\n", k / 60.0);
    csv += fmt::format("{:.6f},0,blue,4,8.0,8.0,0.0,0\n", k / 60.0);
  }
  return csv;
}

std::string file(const DatasetExport& made, const std::string& name) {
  for (const DatasetFile& f : made.files) {
    if (f.name == name) return f.text;
  }
  ADD_FAILURE() << name;
  return "";
}

TEST(TappedDataset, CommandsTelemetryAndCamerasAreOnOneClock) {
  const RadioFormat& format = *find_radio_format("roboteam-rem-v8");
  const Recording recording = tapped(format, OMNIHIL_COMMAND_FIELD_FRAME);
  EXPECT_TRUE(is_tapped(recording));
  const DatasetExport made = tapped_dataset(
      recording, format, {.robot = kRobot, .model_text = "the model", .vision_csv = cameras()});
  EXPECT_EQ(file(made, "model.toml"), "the model");
  const RunRows fit = rows_from_csv(file(made, "fit.csv"), "fit.csv");
  const RunRows holdout = rows_from_csv(file(made, "holdout.csv"), "holdout.csv");
  EXPECT_NEAR(fit.time_s.back(), 2.0, 0.1);
  EXPECT_NEAR(holdout.time_s.back(), 1.0, 0.1);
  int speeds = 0, frames = 0;
  for (std::size_t k = 0; k < fit.time_s.size(); ++k) {
    // The field's x is the robot's right: it looks along y.
    const double vx = (*fit.column("cmd_vx"))[k], vy = (*fit.column("cmd_vy"))[k];
    if (std::isfinite(vx)) {
      EXPECT_NEAR(vx, 0.0, 1e-3);
      EXPECT_NEAR(vy, -0.5, 1e-3);
    }
    const double w = (*fit.column("wheel_3"))[k], x = (*fit.column("vision_x"))[k];
    if (std::isfinite(w)) {
      EXPECT_NEAR(w, 30.0, 0.04);
      ++speeds;
    }
    if (std::isfinite(x)) {
      EXPECT_LT(x, 1.1);  // not the other team's, not another robot's
      ++frames;
    }
  }
  EXPECT_GT(speeds, 90);
  EXPECT_GT(frames, 110);
}

TEST(TappedDataset, CommandsThatNoDatasetTellsAreSaid) {
  const RadioFormat& format = *find_radio_format("roboteam-rem-v8");
  const Recording recording = tapped(format, OMNIHIL_COMMAND_FIELD_FRAME | OMNIHIL_COMMAND_YAW_TARGET);
  EXPECT_THROW(tapped_dataset(recording, format, {.robot = kRobot, .model_text = ""}), std::invalid_argument);
  EXPECT_THROW(tapped_dataset(recording, format, {.robot = 2, .model_text = ""}), std::invalid_argument);
}

}  // namespace
}  // namespace omnihil
