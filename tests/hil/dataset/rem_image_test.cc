// RoboTeam Twente's top board, unmodified, in the loop of a prediction: told a body's velocity in the field's frame, which is the
// one that REM has, by the heading that it reports; its wheel speeds are those of its own packets.
#include <cmath>

#include "hil/dataset/dataset_model.h"
#include "hil/loop/model_store.h"
#include "identify/predict/predictor.h"
#include "protocols/telemetry.h"
#include "tests/hil/firmware/third_party.h"
#include "tests/identify/dataset_folder.h"

namespace omnihil {
namespace {

constexpr double kRow_s = 0.016, kStill_s = 0.2, kTurned_s = 0.8, kSettled_s = 1.8,
                 kEnd_s = 2.4;  // a packet a row

// What each wheel's voltage is fed forward for (roboteam_top_test.cc).
constexpr const char* kFriction = "known = { \"effects.coulomb_friction.torque_Nm\" = 0.0377 }\n";

// Stands, turns by more than a right angle, drives ahead: along the field's y, about.
constexpr double kTurn_rad_s = 3.0, kAhead_m_s = 1.0;

std::string driven_rows() {
  std::string text = "t,vx,vy,w,w1,w2,w3,w4\n";
  for (double t = 0.0; t < kEnd_s; t += kRow_s) {
    const bool turns = t >= kStill_s && t < kTurned_s;
    text += std::to_string(t) + "," + std::to_string(t < kTurned_s ? 0.0 : kAhead_m_s) + ",0," +
            std::to_string(turns ? kTurn_rad_s : 0.0) + ",0,0,0,0\n";
  }
  return text;
}

std::string dataset_text() {
  std::string text =
      "format = \"omnihil-dataset/1\"\ntitle = \"made\"\nrig = \"robot\"\nmodel = \"model.toml\"\n"
      "radio = \"roboteam-rem-v8\"\nboot_s = 9.0\n[channels]\ntime = { column = \"t\" }\n";
  for (const char* axis : {"vx", "vy", "w"})
    text += std::string("command_") + axis + " = { column = \"" + axis + "\" }\n";
  for (const char w : std::string("1234"))
    text += std::string("wheel_speed_") + w + " = { column = \"w" + w + "\" }\n";
  return text + "[[runs]]\nfile = \"fit.csv\"\nuse = \"fit\"\n" + kFriction;
}

TEST(SlowDatasetRemImage, DrivesAsItIsToldAndItsOwnPacketsArePredicted) {
  const std::string image = third_party_image("roboteam-top-f767.elf");
  if (image.empty()) GTEST_SKIP() << "no OMNIHIL_IMAGES with roboteam-top-f767.elf";
  const StoredModel robot = load_robot_model("roboteam_2024", {OMNIHIL_SOURCE_DIR "/models"});
  DatasetFolder folder;
  folder.write("dataset.toml", dataset_text());
  folder.write("model.toml", dataset_model_text(*robot.model));
  folder.write("fit.csv", driven_rows());
  const DatasetReading reading = read_dataset(
      folder.path(), "", {.file = image, .board = OMNIHIL_SOURCE_DIR "/boards/roboteam_top_f767.toml"});
  ASSERT_TRUE(reading.dataset) << all_text(reading.problems);
  const auto predictor = make_predictor(*reading.dataset, *reading.nominal, {});
  const Prediction y = predictor->predict(*reading.nominal, 0);
  ASSERT_TRUE(y.finite);
  const RobotModel& model = *robot.model->robot;
  const double step = wheel_speed_step_rad_s(*find_radio_format("roboteam-rem-v8"));
  for (std::size_t w = 0; w < 4; ++w) {
    const double asked_rad_s = -std::sin(model.wheel_angle_rad[w]) * kAhead_m_s / model.wheel_radius_m;
    const std::vector<double>& v = y.values[w];
    double mean = 0.0, count = 0.0;
    for (std::size_t k = 0; k < v.size(); ++k) {
      if (static_cast<double>(k) * kRow_s < kSettled_s) continue;
      // its steps, by float32 between -1000 and 1000 rad/s
      EXPECT_NEAR(std::remainder(v[k] - v.back(), step), 0.0, 1e-2 * step);
      mean += v[k], count += 1.0;
    }
    std::printf("wheel %zu: told %.2f rad/s, asked for %.2f\n", w, mean / count, asked_rad_s);
    EXPECT_NEAR(mean / count, asked_rad_s, 0.15 * std::abs(asked_rad_s)) << w;
  }
}

}  // namespace
}  // namespace omnihil
