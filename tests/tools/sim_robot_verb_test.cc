// `omnihil sim ROBOT --rig robot` and `--with` for robots, through the program.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "tests/tools/cli.h"

namespace omnihil {
namespace {

namespace fs = std::filesystem;

class SimRobotVerb : public CliTest {
 protected:
  void SetUp() override {
    CliTest::SetUp();
    fs::remove_all(out_);
  }
  void TearDown() override { fs::remove_all(out_); }
  fs::path out_ = fs::temp_directory_path() / ("omnihil_sim_robot_" + std::to_string(::getpid()));
};

TEST_F(SimRobotVerb, WritesADatasetOfTheRigRobotThatIsTheSameEveryTime) {
  const std::string how = "sim omni_default --rig robot --excite steps --duration 1 --with floor_tilt --out ";
  const Ran ran = run_omnihil(how + shell(out_ / "a"));
  ASSERT_EQ(ran.exit_code, 0) << ran.text;
  ASSERT_EQ(run_omnihil(how + shell(out_ / "b")).exit_code, 0);
  for (const char* file : {"dataset.toml", "model.toml", "steps.csv", "steps_holdout.csv"}) {
    EXPECT_FALSE(text_of(out_ / "a" / file).empty()) << file;
    EXPECT_EQ(text_of(out_ / "a" / file), text_of(out_ / "b" / file)) << file;
  }
  EXPECT_NE(text_of(out_ / "a" / "dataset.toml").find("rig = \"robot\""), std::string::npos);
  // the model is the nominal one: what was added is for the data to show
  EXPECT_EQ(text_of(out_ / "a" / "model.toml").find("floor_tilt"), std::string::npos);
}

TEST_F(SimRobotVerb, TakesARobotsModelAsTheWholeRobotAndSaysSo) {
  const Ran ran = run_omnihil("sim omni_default --excite steps --duration 0.2 --out " + shell(out_));
  ASSERT_EQ(ran.exit_code, 0) << ran.text;
  EXPECT_TRUE(ran.says("omni_default is a robot")) << ran.text;
  EXPECT_TRUE(ran.says("--rig axis")) << ran.text;
  EXPECT_NE(text_of(out_ / "dataset.toml").find("rig = \"robot\""), std::string::npos);
}

TEST_F(SimRobotVerb, NamesEveryFaultAtOnce) {
  const Ran ran = run_omnihil(
      "sim omni_default --rig robot --excite wobble --rate 333 --with floor_tlt --with backlash.gap_rad=9 "
      "--out " +
      shell(out_));
  EXPECT_EQ(ran.exit_code, 2);
  for (const char* word : {"wobble", "--rate", "did you mean \"floor_tilt\"", "gap_rad"}) {
    EXPECT_TRUE(ran.says(word)) << word << " in " << ran.text;
  }
  EXPECT_FALSE(fs::exists(out_));
}

// A skidding robot's speeds are off by tens of rad/s between two ways of solving its floor; one that grips is explained by
// the model that comes with the data, to a few counts.
TEST_F(SimRobotVerb, TheDefaultDriveGripsAndItsModelExplainsIt) {
  const Ran ran = run_omnihil("sim omni_default --excite steps prbs --duration 6 --out " + shell(out_));
  ASSERT_EQ(ran.exit_code, 0) << ran.text;
  const Ran compared =
      run_omnihil("compare " + shell(out_) +
                  " --tube velocity_1=4 --tube velocity_2=4 --tube velocity_3=4 --tube velocity_4=4");
  EXPECT_EQ(compared.exit_code, 0) << compared.text;
}

}  // namespace
}  // namespace omnihil
