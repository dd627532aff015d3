#include <gtest/gtest.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <sstream>

#include "hil/dataset/dataset_export.h"
#include "hil/dataset/dataset_model.h"
#include "hil/loop/effect_overrides.h"
#include "hil/text/dataset_files.h"
#include "tests/hil/recording/real_run.h"

namespace omnihil {
namespace {

const Recording& recorded() {
  static const Recording recording = real::record(real::setup(real::kHermes), 200, 1);
  return recording;
}

ModelFile model() { return *read_bundle(real::setup(real::kHermes).model).model; }

using Table = std::map<std::string, std::vector<std::string>>;  // column -> cells

Table read_csv(const std::string& text) {
  std::istringstream lines(text);
  std::string line;
  std::vector<std::string> names;
  Table table;
  while (std::getline(lines, line)) {
    std::vector<std::string> cells(1);
    for (const char c : line) {
      if (c == ',') {
        cells.emplace_back();
      } else {
        cells.back() += c;
      }
    }
    if (names.empty()) {
      names = cells;
      continue;
    }
    EXPECT_EQ(cells.size(), names.size()) << line;
    for (std::size_t i = 0; i < names.size() && i < cells.size(); ++i) table[names[i]].push_back(cells[i]);
  }
  return table;
}

std::string file(const DatasetExport& made, const std::string& name) {
  for (const DatasetFile& each : made.files) {
    if (each.name == name) return each.text;
  }
  ADD_FAILURE() << "no file " << name;
  return "";
}

double number(const std::string& cell) {
  double value = NAN;
  EXPECT_TRUE(parse_number(cell, value)) << cell;
  return value;
}

TEST(Dataset, ChannelsNameColumnsThatAreThere) {
  const DatasetExport made = make_dataset(recorded(), model(), {});
  const toml::table dataset = toml::parse(file(made, "dataset.toml"));
  EXPECT_EQ(dataset["format"].value<std::string>(), "omnihil-dataset/1");
  EXPECT_EQ(dataset["rig"].value<std::string>(), "robot");
  EXPECT_EQ(dataset["model"].value<std::string>(), "model.toml");
  ASSERT_TRUE(dataset["runs"].is_array());
  const toml::table& channels = *dataset["channels"].as_table();
  for (const toml::node& run : *dataset["runs"].as_array()) {
    const Table table = read_csv(file(made, *(*run.as_table())["file"].value<std::string>()));
    for (const auto& [signal, channel] : channels) {
      const std::string column = *(*channel.as_table())["column"].value<std::string>();
      EXPECT_TRUE(table.contains(column)) << signal.str() << " in column " << column;
    }
  }
  for (const char* signal :
       {"time", "duty_1", "duty_4", "encoder_1", "encoder_4", "motor_current_1", "bus_voltage", "gyro_z",
        "accel_x", "accel_y", "vision_x", "vision_y", "vision_theta"}) {
    EXPECT_TRUE(channels.contains(signal)) << signal;
  }
  EXPECT_EQ(channels["encoder_2"]["counts_per_rev"].value<std::int64_t>(),
            model().robot->encoder.counts_per_turn);
  EXPECT_EQ(channels["encoder_2"]["shaft"].value<std::string>(), "rotor");
}

TEST(Dataset, ValuesAreThoseOfTheSamples) {
  const DatasetExport made = make_dataset(recorded(), model(), {});
  const auto& columns = recorded().header.columns;
  const auto of = [&](const RecordedChunk& chunk, const std::string& name) {
    return chunk
        .sample[static_cast<std::size_t>(std::find(columns.begin(), columns.end(), name) - columns.begin())];
  };
  for (const int id : {0, 3}) {
    const Table table = read_csv(file(made, "robot_" + std::to_string(id) + ".csv"));
    std::size_t row = 0;
    for (const RecordedChunk& chunk : recorded().chunks) {
      if (chunk.kind != RecordedChunk::Kind::kSample || chunk.robot_id != id) continue;
      ASSERT_LT(row, table.at("time_s").size());
      EXPECT_DOUBLE_EQ(number(table.at("time_s")[row]), static_cast<double>(chunk.now_ns) / 1e9);
      EXPECT_EQ(number(table.at("bus_V")[row]), of(chunk, "bus_voltage_V"));
      EXPECT_EQ(number(table.at("ticks_3")[row]), of(chunk, "encoder_counts_3"));
      EXPECT_EQ(number(table.at("current_4")[row]), of(chunk, "motor_current_A_4"));
      EXPECT_EQ(number(table.at("accel_y")[row]), of(chunk, "accel_y_m_s2"));
      if (of(chunk, "drive_mode_2") == double(OMNIHIL_DRIVE_DUTY)) {
        EXPECT_EQ(number(table.at("duty_2")[row]), of(chunk, "duty_ratio_2"));
      } else {
        EXPECT_EQ(table.at("duty_2")[row], "");
      }
      if (!table.at("vision_theta")[row].empty()) {
        EXPECT_EQ(number(table.at("vision_theta")[row]), of(chunk, "vision_yaw_rad"));
      }
      ++row;
    }
    EXPECT_EQ(row, table.at("time_s").size());
    EXPECT_EQ(row, 200U);
  }
}

// A camera that is 40 ms late shows in the dataset where the robot was 40 ms before.
TEST(Dataset, CameraFramesAreAsLateAsTheModelSays) {
  SessionSetup late = real::setup(real::kHermes, {0});
  std::vector<std::string> faults;
  add_effects(late.model, {"vision_delay.delay_s=0.04"}, faults);
  ASSERT_TRUE(faults.empty()) << faults.front();
  const Recording recording = real::record(late, 400, 1);
  const DatasetExport made = make_dataset(recording, *read_bundle(late.model).model, {});
  const Table fit = read_csv(file(made, "robot_0_fit.csv"));
  const auto& columns = recording.header.columns;
  const auto true_x =
      static_cast<std::size_t>(std::find(columns.begin(), columns.end(), "true_x_m") - columns.begin());
  std::vector<double> way;
  for (const RecordedChunk& chunk : recording.chunks) {
    if (chunk.kind == RecordedChunk::Kind::kSample) way.push_back(chunk.sample[true_x]);
  }
  int frames = 0;
  double moved_m = 0.0;
  for (std::size_t row = 40; row < fit.at("vision_x").size(); ++row) {
    if (fit.at("vision_x")[row].empty()) continue;
    EXPECT_NEAR(number(fit.at("vision_x")[row]), way[row - 40], 1e-9) << row << " ms";
    moved_m = std::max(moved_m, std::abs(way[row] - way[row - 40]));
    ++frames;
  }
  EXPECT_GT(frames, 5);
  EXPECT_GT(moved_m, 1e-3);  // it did move meanwhile
}

TEST(Dataset, TimeIncreasesAndCameraFramesComeAtTheirRate) {
  const DatasetExport made = make_dataset(recorded(), model(), {.robot = std::nullopt, .camera_Hz = 50.0});
  const Table table = read_csv(file(made, "robot_0.csv"));
  double last_s = -1.0;
  std::vector<int> frames_ms;
  for (std::size_t row = 0; row < table.at("time_s").size(); ++row) {
    const double time_s = number(table.at("time_s")[row]);
    EXPECT_GT(time_s, last_s);
    last_s = time_s;
    if (!table.at("vision_x")[row].empty()) frames_ms.push_back(static_cast<int>(std::lround(time_s * 1e3)));
  }
  EXPECT_EQ(frames_ms, (std::vector<int>{0, 20, 40, 60, 80, 100, 120, 140, 160, 180}));
}

TEST(Dataset, EncoderCountsFollowTheDrivesDirection) {
  ModelFile reversed = model();
  reversed.robot->encoder.direction = -1;
  const toml::table dataset = toml::parse(file(make_dataset(recorded(), reversed, {}), "dataset.toml"));
  EXPECT_EQ(dataset["channels"]["encoder_1"]["scale"].value<double>(), -1.0);
}

TEST(Dataset, ModelReadsBackWithTheSameNumbers) {
  const ModelFile wrote = model();
  const std::string text = dataset_model_text(wrote);
  const ModelReading read = read_model(text, "model.toml", [](const std::string&) {
    ADD_FAILURE() << "asks for another file";
    return MotorFileText{};
  });
  for (const ModelProblem& problem : read.problems) ADD_FAILURE() << problem.text();
  ASSERT_TRUE(read.model && read.model->robot);
  EXPECT_EQ(read.model->robot->mass_kg, wrote.robot->mass_kg);
  EXPECT_EQ(read.model->robot->wheel_angle_rad, wrote.robot->wheel_angle_rad);
  EXPECT_EQ(read.model->robot->gear_ratio, wrote.robot->gear_ratio);
  EXPECT_EQ(read.model->robot->bus_voltage_V, wrote.robot->bus_voltage_V);
  EXPECT_EQ(read.model->robot->encoder.counts_per_turn, wrote.robot->encoder.counts_per_turn);
  EXPECT_EQ(read.model->motor.torque_constant_Nm_per_A, wrote.motor.torque_constant_Nm_per_A);
  EXPECT_EQ(read.model->motor.coulomb_friction_Nm, wrote.motor.coulomb_friction_Nm);
  EXPECT_EQ(read.model->parameters.find("robot.mass_kg")->tolerance,
            wrote.parameters.find("robot.mass_kg")->tolerance);
  EXPECT_EQ(read.model->parameters.find("robot.mass_kg")->source,
            wrote.parameters.find("robot.mass_kg")->source);
}

// A firmware in the predictor counts them.
TEST(Dataset, ModelSaysWhatItsEncodersCount) {
  ModelFile coarse = model();
  coarse.parameters.find("encoder.counts_per_turn")->values = {1024.0};
  EXPECT_NE(dataset_model_text(coarse).find("\n[encoder]\ncounts_per_turn = 1024\n"), std::string::npos);
}

TEST(Dataset, ModelLeavesOutCountsThatAreNotKnown) {
  ModelFile unknown = model();
  unknown.parameters.find("robot.rollers_per_wheel")->values = {0.0};
  EXPECT_EQ(dataset_model_text(unknown).find("rollers_per_wheel"), std::string::npos);
  unknown.parameters.find("robot.rollers_per_wheel")->values = {15.0};
  EXPECT_NE(dataset_model_text(unknown).find("rollers_per_wheel = 15\n"), std::string::npos);
}

TEST(Dataset, HoldsOutTheLastRobotOrTheLastThird) {
  const toml::table many = toml::parse(file(make_dataset(recorded(), model(), {}), "dataset.toml"));
  EXPECT_EQ(many["runs"][0]["use"].value<std::string>(), "fit");
  EXPECT_EQ(many["runs"][1]["use"].value<std::string>(), "holdout");
  EXPECT_EQ(many["runs"][1]["file"].value<std::string>(), "robot_3.csv");
  const DatasetExport one = make_dataset(recorded(), model(), {.robot = 3});
  const Table fit = read_csv(file(one, "robot_3_fit.csv"));
  const Table held = read_csv(file(one, "robot_3_holdout.csv"));
  EXPECT_EQ(fit.at("time_s").size(), 134U);
  EXPECT_EQ(held.at("time_s").size(), 66U);
  EXPECT_GT(number(held.at("time_s").front()), number(fit.at("time_s").back()));
}

TEST(Dataset, SaysThatTicksWereLeftOut) {
  const Recording sparse = real::record(real::setup(real::kHermes), 100, 10);
  const DatasetExport made = make_dataset(sparse, model(), {});
  ASSERT_FALSE(made.notes.empty());
  EXPECT_NE(made.notes[0].find("every 10th tick"), std::string::npos) << made.notes[0];
}

TEST(Dataset, RefusesARobotWithoutSamples) {
  EXPECT_THROW(make_dataset(recorded(), model(), {.robot = 7}), std::invalid_argument);
}

TEST(Dataset, HasEveryChannelOfTheFormatsExample) {
  const char* shared = std::getenv("OMNIHIL_SHARED");
  if (shared == nullptr) GTEST_SKIP() << "OMNIHIL_SHARED is not set: no example dataset to compare with";
  const auto path = std::filesystem::path(shared) / "data/robot_sample/dataset.toml";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "no example dataset in OMNIHIL_SHARED";
  const toml::table example = toml::parse_file(path.string());
  const toml::table ours = toml::parse(file(make_dataset(recorded(), model(), {}), "dataset.toml"));
  for (const auto& [signal, channel] : *example["channels"].as_table()) {
    EXPECT_TRUE(ours["channels"].as_table()->contains(signal.str())) << signal.str();
    EXPECT_EQ(ours["channels"][signal.str()]["column"].value<std::string>(),
              (*channel.as_table())["column"].value<std::string>());
  }
}

TEST(WideCsv, HasEveryColumnOfEveryChosenSample) {
  const Table all = read_csv(wide_csv(recorded(), std::nullopt));
  EXPECT_EQ(all.size(), recorded().header.columns.size() + 2U);
  EXPECT_EQ(all.at("robot_id").size(), 400U);
  EXPECT_EQ(read_csv(wide_csv(recorded(), 3)).at("true_x_m").size(), 200U);
}

TEST(NewFolder, AppearsWholeOrNotAtAll) {
  const fake::TempFolder temp;
  {
    NewFolder folder(temp / "out");
    folder.write("a.txt", "hello");
    EXPECT_FALSE(std::filesystem::exists(temp / "out"));
  }
  EXPECT_TRUE(std::filesystem::is_empty(temp.path())) << "an unfinished folder is left behind";
  NewFolder folder(temp / "out");
  folder.write("a.txt", "hello");
  folder.finish();
  EXPECT_EQ(fake::read_text(temp / "out" / "a.txt"), "hello");
}

TEST(NewFolder, RefusesWhatIsThere) {
  const fake::TempFolder temp;
  std::filesystem::create_directory(temp / "full");
  fake::write_text(temp / "full/precious.txt", "keep");
  EXPECT_THROW(NewFolder(temp / "full"), FileExists);
  fake::write_text(temp / "file", "keep");
  EXPECT_THROW(NewFolder(temp / "file"), FileExists);
  EXPECT_THROW(write_new_file(temp / "file", "lose"), FileExists);
  EXPECT_EQ(fake::read_text(temp / "full/precious.txt"), "keep");
  EXPECT_EQ(fake::read_text(temp / "file"), "keep");
  std::filesystem::create_directory(temp / "empty");
  NewFolder folder(temp / "empty/");  // an empty one is taken, with or without a slash
  folder.write("a.txt", "hello");
  folder.finish();
  EXPECT_EQ(fake::read_text(temp / "empty/a.txt"), "hello");
}

}  // namespace
}  // namespace omnihil
