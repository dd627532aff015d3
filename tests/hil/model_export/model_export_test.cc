// Exports read by programs that are not ours: MuJoCo, Python's XML reader, check_urdf, a C compiler.
#include "hil/model_export/model_export.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "hil/loop/model_store.h"
#include "sim/robot/geometry.h"

namespace omnihil {
namespace {

namespace fs = std::filesystem;
using Words = std::map<std::string, std::vector<std::string>>;  // first word of a line -> the others

const ModelFile& model(const std::string& name = "omni_default") {
  static std::map<std::string, StoredModel> all;
  auto [it, is_new] = all.try_emplace(name);
  if (is_new) it->second = load_robot_model(name, {OMNIHIL_SOURCE_DIR "/models"});
  return *it->second.model;
}

fs::path file(const std::string& name) {
  return fs::temp_directory_path() / ("omnihil-export-" + std::to_string(::getpid()) + "-" + name);
}

fs::path written(const std::string& name, const std::string& text) {
  std::ofstream(file(name), std::ios::binary) << text;
  return file(name);
}

std::string output_of(const std::string& command, int* status = nullptr) {
  std::string text;
  FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  char buffer[4096];
  for (std::size_t n; (n = fread(buffer, 1, sizeof buffer, pipe)) > 0;) text.append(buffer, n);
  const int code = pclose(pipe);
  if (status != nullptr) *status = code;
  return text;
}

Words words_of(const std::string& text) {
  Words out;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string first, word;
    words >> first;
    std::vector<std::string>& rest = out[first];
    while (words >> word) rest.push_back(word);
  }
  return out;
}

double number(const Words& words, const std::string& key, std::size_t i = 0) {
  const auto it = words.find(key);
  return it == words.end() || i >= it->second.size() ? NAN : std::stod(it->second[i]);
}

class Mujoco : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!fs::exists(client_)) GTEST_SKIP() << "MuJoCo is not installed: " << client_;
  }
  Words run(const std::string& name, double seconds, const std::array<double, 4>& duty) const {
    const ModelExport made = export_robot(model(name), ExportFormat::kMjcf, name);
    EXPECT_EQ(made.problem, "");
    std::ostringstream command;
    command << client_ << ' ' << written(name + ".xml", made.text).string() << ' ' << seconds;
    for (const double d : duty) command << ' ' << d;
    const std::string text = output_of(command.str());
    EXPECT_EQ(text.find("error"), std::string::npos) << text;
    return words_of(text);
  }
  std::string client_ = OMNIHIL_BUILD_DIR "/tests/hil/model_export/mujoco/mujoco_client";
};

TEST_F(Mujoco, EveryShippedRobotHasItsMassAndInertiaThere) {
  for (const char* name : {"omni_default", "roboteam_2024", "ulaval_delta", "ibis_orion", "ateam_2025"}) {
    const RobotModel& m = *model(name).robot;
    const Words found = run(name, 0.001, {});
    EXPECT_NEAR(number(found, "mass"), m.mass_kg, 1e-9) << name;
    EXPECT_NEAR(number(found, "com", 0), m.center_of_mass_x_m, 1e-9) << name;
    EXPECT_NEAR(number(found, "com", 1), m.center_of_mass_y_m, 1e-9) << name;
    EXPECT_NEAR(number(found, "com", 2), m.center_of_mass_height_m, 1e-9) << name;
    EXPECT_NEAR(number(found, "yaw"), m.yaw_inertia_kg_m2, 0.01 * m.yaw_inertia_kg_m2) << name;
    EXPECT_EQ(number(found, "actuators"), 4) << name;
  }
}

// All wheels at one duty turn the robot on the spot: with W the wheels' speed and Omega = W r / R_b,
//   J_total dW/dt = 4 (N k U d / R - N c - (N^2 k^2 / R + N^2 b) W),
//   J_total = I_yaw (r / R_b)^2 + 4 (J + N^2 J_rotor): an exponential towards its end.
// At this duty no wheel slips.
TEST_F(Mujoco, TurnsOnTheSpotAsTheMotorEquationsSay) {
  const RobotModel& m = *model().robot;
  const double n = m.gear_ratio, k = m.motor.torque_constant_Nm_per_A, ohm = m.motor.resistance_ohm,
               duty = 0.05;
  const double turn = m.wheel_radius_m / m.wheel_center_radius_m;
  const double inertia =
      m.yaw_inertia_kg_m2 * turn * turn + 4 * (m.wheel_inertia_kg_m2 + n * n * m.motor.rotor_inertia_kg_m2);
  const double torque = 4 * (n * k * m.bus_voltage_V * duty / ohm - n * m.motor.coulomb_friction_Nm);
  const double drag = 4 * n * n * (k * k / ohm + m.motor.viscous_friction_Nm_s_per_rad);
  for (const double seconds : {0.05, 0.5}) {
    const double expected = torque / drag * (1.0 - std::exp(-drag / inertia * seconds));
    const Words found = run("omni_default", seconds, {duty, duty, duty, duty});
    for (std::size_t i = 0; i < 4; ++i)
      EXPECT_NEAR(number(found, "wheels", i), expected, 0.06 * expected) << seconds;
    EXPECT_NEAR(number(found, "speed", 2), expected * turn, 0.08 * expected * turn) << seconds;
  }
}

TEST_F(Mujoco, DrivesForwardAndSidewaysOnItsRollers) {
  const RobotModel& m = *model().robot;
  const WheelGeometry<double> g = wheel_geometry(m);
  for (const bool forward : {true, false}) {
    std::array<double, 4> duty{};
    for (std::size_t i = 0; i < 4; ++i) duty[i] = 0.1 * (forward ? -g.sin_angle[i] : g.cos_angle[i]);
    const Words found = run("omni_default", 0.6, duty);
    const double along = number(found, "moved", forward ? 0 : 1),
                 across = number(found, "moved", forward ? 1 : 0);
    EXPECT_GT(along, 0.1);
    EXPECT_LT(std::abs(across), 0.1 * along);
    EXPECT_LT(std::abs(number(found, "height")), 0.001);  // neither sinks nor jumps
  }
}

TEST(Urdf, AnotherXmlReaderFindsMassCentreInertiaAndJoints) {
  for (const char* name : {"omni_default", "roboteam_2024", "ulaval_delta"}) {
    const RobotModel& m = *model(name).robot;
    const ModelExport made = export_robot(model(name), ExportFormat::kUrdf, name);
    const fs::path path = written(std::string(name) + ".urdf", made.text);
    const Words found = words_of(
        output_of("python3 " OMNIHIL_SOURCE_DIR "/tests/hil/model_export/read_urdf.py " + path.string()));
    EXPECT_NEAR(number(found, "mass"), m.mass_kg, 1e-9) << name;
    EXPECT_NEAR(number(found, "com", 2), m.center_of_mass_height_m, 1e-9) << name;
    // The rotors stand in the wheels' inertia: across the axle that is at least half of what turns about it.
    const double axle = m.wheel_inertia_kg_m2 + m.gear_ratio * m.gear_ratio * m.motor.rotor_inertia_kg_m2;
    const double across =
        0.5 * m.wheel_inertia_kg_m2 + m.wheel_mass_kg * 0.25 * m.wheel_radius_m * m.wheel_radius_m / 12;
    const double more = 4 * (std::max(across, 0.5 * axle) - across);
    EXPECT_NEAR(number(found, "yaw"), m.yaw_inertia_kg_m2 + more, 1e-9) << name;
    for (int i = 1; i <= 4; ++i) {
      const std::string joint = "wheel_" + std::to_string(i) + "_joint";
      const double a = m.wheel_angle_rad[static_cast<std::size_t>(i - 1)];
      EXPECT_NEAR(number(found, joint, 0), -std::cos(a), 1e-12) << name;
      EXPECT_NEAR(number(found, joint, 1), -std::sin(a), 1e-12) << name;
      EXPECT_NEAR(number(found, joint, 4), m.gear_ratio * m.motor.coulomb_friction_Nm, 1e-12) << name;
    }
  }
}

TEST(Urdf, CheckUrdfTakesIt) {
  if (std::system("command -v check_urdf >/dev/null 2>&1") != 0)
    GTEST_SKIP() << "check_urdf is not installed (liburdfdom-tools)";
  const ModelExport made = export_robot(model(), ExportFormat::kUrdf, "omni_default");
  int status = -1;
  const std::string said = output_of("check_urdf " + written("check.urdf", made.text).string(), &status);
  EXPECT_EQ(status, 0) << said;
  EXPECT_NE(said.find("Successfully Parsed XML"), std::string::npos) << said;
  EXPECT_NE(said.find("root Link: base_link has 4 child(ren)"), std::string::npos) << said;
}

TEST(CHeader, CompilesWithoutAWarningAndHoldsEveryNumberToTheBit) {
  for (const char* name : {"omni_default", "roboteam_2024", "omni_foc"}) {
    const ModelExport made = export_robot(model(name), ExportFormat::kC, name);
    const fs::path header = written(std::string(name) + ".h", made.text);
    std::string code = "#include <stdio.h>\n#include \"" + header.string() + "\"\nint main(void) {\n";
    std::vector<double> expected;
    for (const Parameter& p : model(name).parameters.parameters) {
      if (p.row->section.empty() || is_text(*p.row) || p.values.empty() || !std::isfinite(p.value()))
        continue;
      std::string macro = "OMNIHIL_" + parameter_path(*p.row);
      for (char& c : macro)
        c = std::isalnum(static_cast<unsigned char>(c)) ? static_cast<char>(std::toupper(c)) : '_';
      code +=
          p.values.size() == 1
              ? "  printf(\"%.17g\\n\", (double)(" + macro + "));\n"
              : "  { const double v[] = " + macro +
                    "; for (unsigned i = 0; i < sizeof v / sizeof *v; ++i) printf(\"%.17g\\n\", v[i]); }\n";
      expected.insert(expected.end(), p.values.begin(), p.values.end());
    }
    const WheelGeometry<double> g = wheel_geometry(*model(name).robot);
    code +=
        "  { const double m[4][3] = OMNIHIL_WHEEL_SPEEDS_OF_BODY; for (int i = 0; i < 4; ++i) "
        "printf(\"%.17g\\n\", m[i][0]); }\n";
    for (std::size_t i = 0; i < kWheels; ++i) expected.push_back(-g.sin_angle[i] / g.wheel_radius_m);
    const fs::path source = written(std::string(name) + ".c", code + "  return 0;\n}\n");
    const std::string program = file(std::string(name) + "-numbers").string();
    int status = -1;
    const std::string said = output_of(
        "gcc -std=c99 -Wall -Wextra -pedantic -Werror " + source.string() + " -o " + program, &status);
    ASSERT_EQ(status, 0) << said;
    std::istringstream printed(output_of(program));
    ASSERT_GT(expected.size(), 20u);
    for (const double value : expected) {
      std::string word;
      ASSERT_TRUE(printed >> word);
      EXPECT_EQ(std::stod(word), value) << name;
    }
  }
}

TEST(ExportLists, EveryNumberOfTheFileSurvivesOrIsListed) {
  for (const ExportFormat format : {ExportFormat::kMjcf, ExportFormat::kUrdf}) {
    const ModelExport made = export_robot(model("roboteam_2024"), format, "r");
    for (const Parameter& p : model("roboteam_2024").parameters.parameters) {
      if (p.row->section.empty() || p.origin == Origin::kDefault) continue;
      const std::string path = parameter_path(*p.row);
      const bool lost = std::any_of(made.lost.begin(), made.lost.end(),
                                    [&](const std::string& l) { return l.starts_with(path + " = "); });
      const bool named = made.text.find("  " + path + " = ") !=
                         std::string::npos;  // in the comment of numbers, or of losses
      EXPECT_TRUE(lost || named) << path;
    }
    for (const std::string& line : made.lost) EXPECT_NE(line.find_first_not_of(' '), std::string::npos);
    EXPECT_NE(made.text.find("What does not survive:"), std::string::npos);
  }
}

TEST(ExportLists, TextOfTheFileCannotBreakOutOfAComment) {
  ModelFile odd = model();
  odd.parameters.find("robot.mass_kg")->source = "a */ b --> c <x> \\";
  for (const ExportFormat format : {ExportFormat::kMjcf, ExportFormat::kUrdf}) {
    const ModelExport made = export_robot(odd, format, "r");
    const fs::path path = written("odd.xml", made.text);
    int status = -1;
    const std::string said = output_of(
        "python3 -c 'import sys, xml.etree.ElementTree as t; t.parse(sys.argv[1])' " + path.string(),
        &status);
    EXPECT_EQ(status, 0) << said;
  }
  const std::string header = export_robot(odd, ExportFormat::kC, "r").text;
  EXPECT_EQ(header.find("a */ b"), std::string::npos);
}

TEST(ExportLists, AMotorIsNoRobot) {
  const StoredModel motor = load_model("maxon_ec45_flat_30w", {OMNIHIL_SOURCE_DIR "/models"});
  ASSERT_TRUE(motor.model);
  const ModelExport made = export_robot(*motor.model, ExportFormat::kMjcf, "m");
  EXPECT_NE(made.problem.find("only a robot"), std::string::npos);
  EXPECT_TRUE(made.text.empty());
}

TEST(ExportLists, WheelsHeavierThanTheRobotAreRefused) {
  ModelFile odd = model();
  odd.robot->wheel_mass_kg = odd.robot->mass_kg;
  EXPECT_NE(export_robot(odd, ExportFormat::kUrdf, "m").problem.find("allowed: less than robot.mass_kg"),
            std::string::npos);
}

}  // namespace
}  // namespace omnihil
