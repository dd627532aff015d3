// Model files that are read: values, tolerances, sources, merging with a motor file, the store.
#include "sim/model/model_file.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <numbers>
#include <set>

#include "hil/loop/model_store.h"
#include "sim/model/model_keys.h"
#include "sim/model/model_rows.h"

namespace omnihil {
namespace {

namespace fs = std::filesystem;

constexpr const char* kMotor = R"(format = "omnihil-model/1"
rig = "motor"
name = "a motor"
[motor]
resistance_ohm = { value = 1.2, tolerance = 0.1, source = "sheet" }
torque_constant_Nm_per_A = 0.0255
rotor_inertia_kg_m2 = 9e-6
[effects.coulomb_friction]
torque_Nm = 0.002
)";

constexpr const char* kRobot = R"(format = "omnihil-model/1"
rig = "robot"
name = "a robot"
[motor]
file = "m.toml"
rotor_inertia_kg_m2 = { value = 1e-5, tolerance = 0.5 }
[supply]
voltage_V = 24
[robot]
mass_kg = 2.5
yaw_inertia_kg_m2 = 0.012
center_of_mass_height_m = 0.045
wheel_center_radius_m = 0.08
wheel_radius_m = 0.027
wheel_inertia_kg_m2 = 2.2e-5
wheel_angle_deg = { value = [45, 135, 225, 315], tolerance = 0.01 }
[effects.cogging]
amplitude_Nm = 0.003
[firmware]
radio = "ulaval-hermes"
command_timeout_s = 0.25
)";

MotorFileText motor_text(const std::string& file) { return {file, kMotor, ""}; }

TEST(ModelFile, KeepsValueToleranceSourceUnitAndPlace) {
  const ModelReading read = read_model(kRobot, "r.toml", motor_text);
  ASSERT_TRUE(read.model.has_value()) << read.problems.at(0).text();
  const Parameter* r = read.model->parameters.find("motor.resistance_ohm");
  ASSERT_NE(r, nullptr);
  EXPECT_EQ(r->value(), 1.2);
  EXPECT_EQ(r->tolerance, 0.1);
  EXPECT_EQ(r->source, "sheet");
  EXPECT_EQ(r->row->unit, "ohm");
  EXPECT_EQ(r->origin, Origin::kMotorFile);
  EXPECT_EQ(r->line, 5);
}

TEST(ModelFile, BareNumberIsKnownExactly) {
  const ModelReading read = read_model(kRobot, "r.toml", motor_text);
  EXPECT_FALSE(read.model->parameters.find("robot.mass_kg")->tolerance.has_value());
}

TEST(ModelFile, RobotFileOverridesItsMotorFile) {
  const ModelReading read = read_model(kRobot, "r.toml", motor_text);
  const Parameter* j = read.model->parameters.find("motor.rotor_inertia_kg_m2");
  EXPECT_EQ(j->value(), 1e-5);
  EXPECT_EQ(j->tolerance, 0.5);
  EXPECT_EQ(j->origin, Origin::kRobotFile);
}

TEST(ModelFile, FillsTheRobotModel) {
  const ModelReading read = read_model(kRobot, "r.toml", motor_text);
  const RobotModel& robot = *read.model->robot;
  EXPECT_EQ(robot.name, "a robot");
  EXPECT_EQ(robot.motor.name, "a motor");
  EXPECT_EQ(robot.motor.resistance_ohm, 1.2);
  EXPECT_EQ(robot.motor.coulomb_friction_Nm, 0.002);
  EXPECT_EQ(robot.bus_voltage_V, 24.0);
  EXPECT_EQ(robot.mass_kg, 2.5);
  EXPECT_EQ(robot.control_timeout_s, 0.25);
  EXPECT_NEAR(robot.wheel_angle_rad[1], 0.75 * std::numbers::pi, 1e-15);
  EXPECT_EQ(read.model->radio, "ulaval-hermes");
}

TEST(ModelFile, DefaultsAreSaidToBeDefaults) {
  const ModelReading read = read_model(kRobot, "r.toml", motor_text);
  const Parameter* ratio = read.model->parameters.find("gear.ratio");
  EXPECT_EQ(ratio->value(), 1.0);
  EXPECT_EQ(ratio->origin, Origin::kDefault);
  EXPECT_EQ(read.model->robot->tyre_longitudinal.extremum_value, kDefaultTyreLongitudinal.extremum_value);
}

TEST(ModelFile, EffectsThatAreNotSimulatedAreKeptAndSaid) {
  const std::string with_play = std::string(kRobot) + "[effects.backlash]\ngap_rad = 0.003\n";
  EXPECT_TRUE(read_model(with_play, "r.toml", motor_text).notes.empty());  // all effects act in a robot
  const std::string motor = std::string(kMotor) + "[effects.backlash]\ngap_rad = 0.003\n";
  const ModelReading read = read_model(motor, "m.toml", motor_text);
  ASSERT_TRUE(read.model.has_value());
  ASSERT_EQ(read.notes.size(), 1u);
  EXPECT_NE(read.notes[0].find("effects.backlash"), std::string::npos);
}

TEST(ModelFile, NumbersCanBeSetByPathWithinTheirBounds) {
  ParameterTable table = read_model(kRobot, "r.toml", motor_text).model->parameters;
  EXPECT_EQ(table.set("motor.resistance_ohm", 2.0), "");
  EXPECT_EQ(robot_model_of(table).motor.resistance_ohm, 2.0);
  EXPECT_NE(table.set("motor.resistance_ohm", -2.0), "");
  EXPECT_NE(table.set("motor.resistence_ohm", 2.0), "");
  EXPECT_NE(table.set("encoder.counts_per_turn", 4000.5), "");
  EXPECT_EQ(robot_model_of(table).motor.resistance_ohm, 2.0);
}

TEST(ModelRows, EveryUnitIsTheSuffixOfItsKey) {
  const std::set<std::string_view> without = {"ratio", "direction", "pole_pairs", "slots",
                                              "rollers_per_wheel"};
  for (const ParameterRow& row : model_rows()) {
    if (row.kind == ParameterKind::kText || row.kind == ParameterKind::kTruth) continue;
    std::string unit(row.unit);  // "N m s/rad" is written "_Nm_s_per_rad", "kg m2" "_kg_m2", "m/s" "_m_s"
    if (unit == "1" || unit == "counts") continue;
    std::string suffix;
    for (const char c : unit) suffix += c == ' ' ? '_' : c;
    const auto replace = [&](const std::string& from, const std::string& to) {
      if (const auto at = suffix.find(from); at != std::string::npos) suffix.replace(at, from.size(), to);
    };
    replace("N_m", "Nm");
    if (unit == "m/s" || unit == "m/s2" || unit == "rad/s2") replace("/", "_");
    replace("/", "_per_");
    if (suffix.starts_with("1_")) suffix = suffix.substr(2);
    EXPECT_TRUE(row.key.ends_with(suffix)) << row.key << " in " << row.unit;
  }
}

TEST(ModelRows, EveryRowExplainsItselfAndItsDefaultIsAllowed) {
  for (const ParameterRow& row : model_rows()) {
    EXPECT_FALSE(row.what.empty()) << row.key;
    EXPECT_NE(row.rigs, 0u) << row.key;
    EXPECT_EQ(row.needed & ~row.rigs, 0u) << row.key;
    EXPECT_EQ(find_model_row(row.section, row.key), &row) << "named twice: " << row.key;
    if (row.kind == ParameterKind::kText) continue;
    EXPECT_LT(row.lower, row.upper) << row.key;
    if (row.otherwise) {
      EXPECT_TRUE(within_bounds(row, *row.otherwise)) << row.key;
    }
  }
}

TEST(ModelRows, DocumentationCarriesThemAll) {
  std::ifstream in(OMNIHIL_SOURCE_DIR "/docs/model-files.md");
  const std::string text((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  const std::string mark = "<!-- keys -->\n";
  const auto at = text.find(mark);
  ASSERT_NE(at, std::string::npos);
  EXPECT_EQ(text.substr(at + mark.size()), model_keys_markdown())
      << "put the output of `omnihil models --keys` under the mark in docs/model-files.md";
}

TEST(ModelFile, WithoutANameIsCalledAfterItsFile) {
  std::string text = kRobot;
  text.erase(text.find("name = \"a robot\"\n"), std::string("name = \"a robot\"\n").size());
  const ModelReading read = read_model(text, "somewhere/ours.toml", motor_text);
  ASSERT_TRUE(read.model.has_value());
  EXPECT_EQ(read.model->robot->name, "ours");
}

TEST(ModelStore, BundleReadsBackWithoutAnyFile) {
  for (const ModelListing& listed : list_models({OMNIHIL_SOURCE_DIR "/models"})) {
    const StoredModel stored = load_model(listed.path, {});
    ASSERT_TRUE(stored.model.has_value()) << stored.problems.at(0).text();
    const ModelReading again = read_bundle(stored.bundle);
    ASSERT_TRUE(again.model.has_value()) << again.problems.at(0).text();
    const auto& a = stored.model->parameters.parameters;
    const auto& b = again.model->parameters.parameters;
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t n = 0; n < a.size(); ++n) {
      EXPECT_EQ(a[n].values, b[n].values);
      EXPECT_EQ(a[n].source, b[n].source);
    }
  }
}

TEST(ModelStore, FolderOfTheEnvironmentComesFirst) {
  const fs::path folder = fs::temp_directory_path() / "omnihil_model_store_test";
  fs::create_directories(folder / "robots");
  std::ofstream(folder / "robots" / "m.toml") << kMotor;
  std::ofstream(folder / "robots" / "omni_default.toml") << kRobot;
  ::setenv("OMNIHIL_MODELS", folder.c_str(), 1);
  const StoredModel stored = load_robot_model("omni_default", {OMNIHIL_SOURCE_DIR "/models"});
  ::unsetenv("OMNIHIL_MODELS");
  ASSERT_TRUE(stored.model.has_value());
  EXPECT_EQ(stored.model->name, "a robot");
  EXPECT_EQ(load_robot_model("omni_default", {OMNIHIL_SOURCE_DIR "/models"}).bundle.name, "omni_default");
  fs::remove_all(folder);
}

TEST(ModelStore, MisspeltNameIsAnsweredWithTheNearest) {
  const StoredModel stored = load_robot_model("omni_defualt", {OMNIHIL_SOURCE_DIR "/models"});
  ASSERT_EQ(stored.problems.size(), 1u);
  EXPECT_NE(stored.problems[0].text().find("did you mean \"omni_default\"?"), std::string::npos);
}

TEST(ModelStore, MotorIsNoRobot) {
  const StoredModel stored = load_robot_model("maxon_ec45_flat_50w", {OMNIHIL_SOURCE_DIR "/models"});
  EXPECT_FALSE(stored.model.has_value());
  ASSERT_EQ(stored.problems.size(), 1u);
}

// Models that come with the bench recordings, made by others.
TEST(ModelFile, ReadsEveryModelOfTheSharedRecordings) {
  const char* shared = std::getenv("OMNIHIL_SHARED");
  if (shared == nullptr || !fs::exists(fs::path(shared) / "data")) {
    GTEST_SKIP() << "OMNIHIL_SHARED names no folder with recordings";
  }
  int count = 0;
  for (const auto& entry : fs::directory_iterator(fs::path(shared) / "data")) {
    const fs::path path = entry.path() / "model.toml";
    if (!fs::exists(path)) continue;
    const StoredModel stored = load_model(path.string(), {});
    for (const ModelProblem& p : stored.problems) ADD_FAILURE() << p.text();
    ASSERT_TRUE(stored.model.has_value());
    ++count;
    if (entry.path().filename() == "robot_sample") {
      EXPECT_EQ(stored.model->robot->gear_ratio, 3.0);
      EXPECT_NEAR(stored.model->robot->motor.coulomb_friction_Nm, 0.0027468018, 1e-15);
      EXPECT_EQ(stored.model->robot->rollers_per_wheel, 15);
    }
    if (entry.path().filename() == "emps") {
      EXPECT_TRUE(stored.model->linear);
      EXPECT_EQ(stored.model->parameters.find("load.mass_kg")->value(), 95.1);
    }
  }
  EXPECT_GE(count, 9);
}

}  // namespace
}  // namespace omnihil
