#include "hil/dataset/dataset_reader.h"

#include <gtest/gtest.h>

#include <cmath>

#include "hil/text/csv_table.h"
#include "identify/record/rig.h"
#include "tests/identify/dataset_folder.h"

namespace omnihil {
namespace {

using testing::Test;

class DatasetReaderTest : public Test {
 protected:
  Dataset good() {
    DatasetReading r = read_dataset(folder.path());
    EXPECT_TRUE(r.dataset) << all_text(r.problems);
    return r.dataset.value_or(Dataset{});
  }
  // Everything the reader says; fails where it takes the dataset.
  std::string refused() {
    const DatasetReading r = read_dataset(folder.path());
    EXPECT_FALSE(r.dataset);
    EXPECT_FALSE(r.nominal);
    return all_text(r.problems);
  }
  static bool says(const std::string& text, const std::string& what) {
    return text.find(what) != std::string::npos;
  }
  static std::string notes(const Dataset& d) {
    std::string text;
    for (const std::string& note : d.notes) text += note + "\n";
    return text;
  }
  DatasetFolder folder;
};

TEST_F(DatasetReaderTest, ReadsChannelsRunsAndModel) {
  const DatasetReading r = read_dataset(folder.path());
  ASSERT_TRUE(r.dataset) << all_text(r.problems);
  EXPECT_EQ(r.dataset->rig, &rig_axis());
  EXPECT_EQ(r.dataset->name, folder.path());
  ASSERT_EQ(r.dataset->runs.size(), 2u);
  EXPECT_EQ(r.dataset->runs[0].split, Split::kTraining);
  EXPECT_EQ(r.dataset->runs[1].split, Split::kValidation);
  EXPECT_EQ(r.dataset->runs[0].time_s, (std::vector<double>{0.0, 0.001, 0.002}));
  EXPECT_EQ(*r.dataset->runs[0].signal("velocity"), (std::vector<double>{0.0, 1.0, 2.0}));
  EXPECT_EQ(r.dataset->channel("velocity")->unit, "rad/s");
  EXPECT_DOUBLE_EQ(r.nominal->file.parameters.find("motor.resistance_ohm")->value(), 1.0);
  EXPECT_TRUE(r.dataset->notes.empty());
}

TEST_F(DatasetReaderTest, ScaleAndOffsetMakeTheSignal) {
  folder.change("velocity = { column = \"speed\" }",
                "velocity = { column = \"speed\", scale = 0.5, offset = 3 }");
  const Dataset d = good();
  EXPECT_EQ(*d.runs[0].signal("velocity"), (std::vector<double>{3.0, 3.5, 4.0}));  // 0.5 * column + 3
}

TEST_F(DatasetReaderTest, AnEmptyCellIsMissingAndNotZero) {
  folder.write("fit.csv", "time_s,duty,speed\n0,0,\n0.001,0.5,1\n0.002,0.5,\n");
  const Dataset d = good();
  const std::vector<double>& w = *d.runs[0].signal("velocity");
  EXPECT_TRUE(std::isnan(w[0]));
  EXPECT_EQ(w[1], 1.0);
  EXPECT_TRUE(std::isnan(w[2]));
}

TEST_F(DatasetReaderTest, ByteOrderMarkCarriageReturnsQuotesAndBlanksAreFine) {
  folder.write("fit.csv", "\xEF\xBB\xBFtime_s , \"duty\",speed\r\n0, +0.25 ,\"1\"\r\n0.001,\t0.5,2\r\n\r\n");
  const Dataset d = good();
  EXPECT_EQ(*d.runs[0].signal("duty"), (std::vector<double>{0.25, 0.5}));
  EXPECT_EQ(*d.runs[0].signal("velocity"), (std::vector<double>{1.0, 2.0}));
}

TEST_F(DatasetReaderTest, ColumnsNobodyNamesMayHoldAnything) {
  folder.write("fit.csv", "time_s,remark,duty,speed\n0,start,0,0\n0.001,\"a, b\",0.5,1\n");
  EXPECT_EQ(*good().runs[0].signal("velocity"), (std::vector<double>{0.0, 1.0}));
}

TEST_F(DatasetReaderTest, ASignalThatOneRunLacksIsNotMeasuredThere) {
  folder.change("velocity = { column = \"speed\" }",
                "velocity = { column = \"speed\" }\nbus_voltage = { column = \"bus\" }");
  folder.write("fit.csv", "time_s,duty,speed,bus\n0,0,0,12\n0.001,0.5,1,11.9\n");
  folder.write("held.csv", "time_s,duty,speed,bus\n0,0,0,\n0.001,0.5,1,\n");
  const Dataset d = good();
  EXPECT_NE(d.runs[0].signal("bus_voltage"), nullptr);
  EXPECT_EQ(d.runs[1].signal("bus_voltage"), nullptr);
  EXPECT_TRUE(says(notes(d), "bus_voltage: column \"bus\" is empty throughout")) << notes(d);
  folder.write("held.csv", "time_s,duty,speed,Bus\n0,0,0,12\n0.001,0.5,1,12\n");
  const Dataset e = good();
  EXPECT_EQ(e.runs[1].signal("bus_voltage"), nullptr);
  EXPECT_TRUE(
      says(notes(e), "no column \"bus\" (but \"Bus\"): taken as not measured in 1 of 2 runs (held.csv)"))
      << notes(e);
}

TEST_F(DatasetReaderTest, DutyBeyondFullIsTakenAndSaid) {
  folder.write("fit.csv", "time_s,duty,speed\n0,0,0\n0.001,1.8,1\n0.002,-1.2,1\n");
  const Dataset d = good();
  EXPECT_EQ((*d.runs[0].signal("duty"))[1], 1.8);
  EXPECT_TRUE(says(notes(d), "2 of 3 values ask for more than full duty, up to 1.8")) << notes(d);
}

TEST_F(DatasetReaderTest, WithoutHoldoutItWarns) {
  folder.change("use = \"holdout\"", "use = \"extrapolation\"");
  EXPECT_TRUE(says(notes(good()), "no run has use \"holdout\""));
}

TEST_F(DatasetReaderTest, KnownNumbersOfARunAreHeldAgainstTheModel) {
  folder.change("use = \"holdout\"",
                "use = \"holdout\"\nknown = { \"load.inertia_kg_m2\" = 6.1e-5, gear.ratio = 3 }");
  const Dataset d = good();
  ASSERT_EQ(d.runs[1].known.size(), 2u);
  EXPECT_EQ(d.runs[1].known[0], (std::pair<std::string, double>("gear.ratio", 3.0)));
  EXPECT_EQ(d.runs[1].known[1], (std::pair<std::string, double>("load.inertia_kg_m2", 6.1e-5)));
  folder.change("gear.ratio = 3", "gear.ration = -3");
  EXPECT_TRUE(says(refused(),
                   "dataset.toml:15:56: runs[2].known.gear.ration = -3: the model has no such "
                   "parameter; did you mean \"gear.ratio\"?"))
      << refused();
}

TEST_F(DatasetReaderTest, AllProblemsComeAtOnceEachWithItsPlace) {
  folder.change("velocity = { column", "velocty = { column");
  folder.change("use = \"fit\"", "use = \"fitt\"");
  folder.write("model.toml", std::string(kAxisModel) + "voltag_V = 3\n");
  folder.write("held.csv", "time_s,duty,speed\n0,0,0\n0.001,x,1\n0.001,0.5,nan\n");
  const std::string text = refused();
  EXPECT_TRUE(says(text,
                   "dataset.toml:8:1: channels.velocty: there is no such signal on rig \"axis\"; did you "
                   "mean \"velocity\"?"))
      << text;
  EXPECT_TRUE(says(text, "dataset.toml:11:7: runs[1].use = \"fitt\": is not allowed here; allowed: \"fit\""))
      << text;
  EXPECT_TRUE(says(text, "model.toml:9:1: supply.voltag_V: unknown key; did you mean \"voltage_V\"?"))
      << text;
  EXPECT_TRUE(says(text, "held.csv:3:7: duty = 'x': is no number")) << text;
}

TEST_F(DatasetReaderTest, TimeMustIncrease) {
  folder.write("fit.csv", "time_s,duty,speed\n0,0,0\n0.002,0,0\n0.001,0,0\n0.003,0,0\n0.003,0,0\n,0,0\n");
  const std::string text = refused();
  EXPECT_TRUE(says(text, "fit.csv:4:1: time_s = 0.001: time goes backwards, from 0.002")) << text;
  EXPECT_TRUE(says(text, "fit.csv:6:1: time_s = 0.003: time stands still")) << text;
  EXPECT_TRUE(says(text, "fit.csv:7:1: time_s: the time is empty")) << text;
}

TEST_F(DatasetReaderTest, ARunIsNeverBothEstimatedAndHeldOut) {
  folder.change("held.csv", "fit.csv");
  EXPECT_TRUE(says(refused(), "is listed twice"));
}

TEST_F(DatasetReaderTest, FilesOutsideTheFolderAreRefused) {
  folder.change("held.csv", "../held.csv");
  EXPECT_TRUE(says(refused(), "runs[2].file = \"../held.csv\": lies outside the dataset's folder"));
}

TEST_F(DatasetReaderTest, TheFirstOfTwoDriveInputsDrives) {
  folder.change("duty = { column = \"duty\" }",
                "motor_voltage = { column = \"u\" }\nduty = { column = \"duty\" }");
  for (const char* name : {"fit.csv", "held.csv"})
    folder.write(name, "time_s,duty,speed,u\n0,0,0,0\n0.001,0.5,1,6\n");
  const Dataset d = good();
  EXPECT_NE(d.runs[0].signal("motor_voltage"), nullptr);
  EXPECT_EQ(d.runs[0].signal("duty"), nullptr);
  EXPECT_TRUE(says(notes(d), "duty is a second drive input and is left out; motor_voltage")) << notes(d);
}

TEST_F(DatasetReaderTest, ADriveNeedsWhatTheModelLacks) {
  folder.write("model.toml",
               "format = \"omnihil-model/1\"\nrig = \"axis\"\n[motor]\nrotor_inertia_kg_m2 = 1e-5\n");
  const std::string text = refused();
  EXPECT_TRUE(says(text, "motor.resistance_ohm: is missing")) << text;
  EXPECT_TRUE(says(text, "motor.torque_constant_Nm_per_A: is missing")) << text;
  EXPECT_TRUE(says(text, "supply.voltage_V: is missing")) << text;
}

TEST_F(DatasetReaderTest, AnImposedSpeedLeavesTheLoadTorqueToCompare) {
  folder.change("velocity = { column = \"speed\" }", "velocity = { column = \"speed\", role = \"imposed\" }");
  EXPECT_TRUE(says(refused(), "leaves nothing to compare"));
  folder.change("duty = {", "load_torque = { column = \"load\" }\nduty = {");
  for (const char* name : {"fit.csv", "held.csv"})
    folder.write(name, "time_s,duty,speed,load\n0,0,0,0\n0.001,0.5,1,0.1\n");
  EXPECT_TRUE(good().channel("velocity")->imposed);
}

TEST_F(DatasetReaderTest, AnImposedCurrentIsADriveInput) {
  folder.change("duty = { column = \"duty\" }", "motor_current = { column = \"duty\", role = \"imposed\" }");
  EXPECT_NE(good().runs[0].signal("motor_current"), nullptr);
}

TEST_F(DatasetReaderTest, AnotherModelCanTakeThePlaceOfTheDatasetsOwn) {
  std::string other = kAxisModel;
  other.replace(other.find("= 1.0"), 5, "= 2.5");
  folder.write("other.toml", other);
  const DatasetReading r = read_dataset(folder.path(), folder.path() + "/other.toml");
  ASSERT_TRUE(r.nominal) << all_text(r.problems);
  EXPECT_EQ(r.nominal->file.parameters.find("motor.resistance_ohm")->value(), 2.5);
  EXPECT_EQ(r.model_text, other);
}

TEST(CsvTable, CountsWhatItDoesNotShow) {
  std::string text = "a\n";
  for (int i = 0; i < 30; ++i) text += "x\n";
  std::vector<ModelProblem> problems;
  EXPECT_FALSE(parse_csv(text, "t.csv", {"a"}, problems).readable);
  ASSERT_EQ(problems.size(), 11u);  // ten, and the count of the other twenty
  EXPECT_NE(problems.back().text().find("20 more"), std::string::npos);
}

TEST(SharedData, EveryFolderReads) {
  const auto data = shared_data();
  if (!data) GTEST_SKIP() << "OMNIHIL_SHARED names no folder of measurements";
  int folders = 0;
  for (const auto& entry : std::filesystem::directory_iterator(*data)) {
    if (!std::filesystem::exists(entry.path() / "dataset.toml")) continue;  // raw recordings
    const DatasetReading r = read_dataset(entry.path().string());
    EXPECT_TRUE(r.dataset) << all_text(r.problems);
    ++folders;
    if (!r.dataset) continue;
    for (const omnihil::Run& run : r.dataset->runs) {
      EXPECT_GT(run.time_s.size(), 10u) << run.file;
    }
    if (std::getenv("OMNIHIL_SHOW") != nullptr) {
      std::printf("%s: %zu runs\n", entry.path().filename().c_str(), r.dataset->runs.size());
      for (const std::string& note : r.dataset->notes) std::printf("  %s\n", note.c_str());
    }
  }
  EXPECT_GT(folders, 0);
}

}  // namespace
}  // namespace omnihil
