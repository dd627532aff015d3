// `omnihil scenario` and `omnihil serve --firmware` as a user runs them: output, files, exit codes.
#include <unistd.h>

#include <fstream>
#include <sstream>

#include "tests/tools/cli.h"

namespace omnihil {
namespace {

namespace fs = std::filesystem;

std::string library(const std::string& name) {
  return " --firmware '" + std::string(OMNIHIL_BUILD_DIR) + "/tests/firmware/lib" + name + ".so' ";
}

class ScenarioProgram : public CliTest {
 protected:
  void SetUp() override {
    CliTest::SetUp();
    folder_ = fs::temp_directory_path() / ("omnihil_scenario_" + std::to_string(::getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  std::string text_of(const std::string& name) const {
    std::ifstream in(folder_ / name);
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
  }
  fs::path folder_;
};

TEST_F(ScenarioProgram, HealthyFirmwareEndsWithZeroAndDrawsNothing) {
  const Ran ran = run_omnihil("scenario run wheel/direction --plots" + shell(folder_ / "plots"));
  EXPECT_EQ(ran.exit_code, 0) << ran.text;
  EXPECT_TRUE(ran.says("1 scenarios, 0 failed")) << ran.text;
  EXPECT_FALSE(fs::exists(folder_ / "plots"));
}

TEST_F(ScenarioProgram, FailedCheckEndsWithOneAndLeavesPlotAndReport) {
  const Ran ran = run_omnihil("scenario run wheel/direction" + library("sign_error") + "--plots" +
                              shell(folder_ / "plots") + "--junit" + shell(folder_ / "out.xml"));
  EXPECT_EQ(ran.exit_code, 1) << ran.text;
  EXPECT_TRUE(ran.says("commanded_sign         wheel 2")) << ran.text;
  EXPECT_NE(text_of("plots/direction.svg").find("omega_wheel_commanded_rad_s"), std::string::npos);
  EXPECT_NE(text_of("out.xml").find("<failure message=\"commanded_sign wheel 2"), std::string::npos);
}

TEST_F(ScenarioProgram, CrashEndsWithSixAndTheNextScenarioRuns) {
  const Ran ran =
      run_omnihil("scenario run wheel/direction wheel/control_period --no-plots" + library("null_pointer"));
  EXPECT_EQ(ran.exit_code, 6) << ran.text;
  EXPECT_TRUE(ran.says("null pointer")) << ran.text;
  EXPECT_TRUE(ran.says("2 scenarios, 2 failed")) << ran.text;
}

TEST_F(ScenarioProgram, BadFileEndsWithTwoAndNamesEveryProblem) {
  const Ran ran = run_omnihil("scenario run '" OMNIHIL_SOURCE_DIR "/tests/hil/scenario/broken_files'");
  EXPECT_EQ(ran.exit_code, 2);
  for (const char* part : {"head.toml:6", "steps.toml:22", "checks.toml:30", "windows.toml:17"}) {
    EXPECT_TRUE(ran.says(part)) << part << "\n" << ran.text;
  }
  EXPECT_EQ(run_omnihil("scenario run no_such_file").exit_code, 2);
  EXPECT_EQ(run_omnihil("scenario run wheel/direction --firmware '" OMNIHIL_PROGRAM "x'").exit_code, 2);
  EXPECT_EQ(run_omnihil("scenario run wheel/direction --junit /nowhere/out.xml").exit_code, 3);
}

TEST_F(ScenarioProgram, ServeOutlivesACrashAndSaysWhatItWas) {
  const Ran ran = run_omnihil("serve --robots 0-2 --clock free --duration 0.5 --device" +
                              shell(folder_ / "dongle") + library("null_pointer"));
  EXPECT_EQ(ran.exit_code, 6) << ran.text;
  EXPECT_TRUE(ran.says("robot 2: firmware")) << ran.text;
  EXPECT_TRUE(ran.says("its wheels coast from here on")) << ran.text;
  EXPECT_TRUE(ran.says("device")) << ran.text;
}

TEST_F(ScenarioProgram, ServeRunsAHealthyLibrary) {
  const Ran ran = run_omnihil("serve --robots 0-1 --clock free --duration 0.5 --device" +
                              shell(folder_ / "dongle") + library("prints"));
  EXPECT_EQ(ran.exit_code, 0) << ran.text;
}

}  // namespace
}  // namespace omnihil
