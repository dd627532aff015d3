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

// The same with other wheels: the bench's plant and the comparison's robot agree on them to a few counts.
TEST_F(SimRobotVerb, TwoThreeAndSixWheelsAreExplainedByTheirModels) {
  const std::string four = text_of(fs::path(OMNIHIL_SOURCE_DIR) / "models/robots/omni_default.toml");
  struct Wheels {
    std::string angles;
    std::size_t count;
    bool rollers;
  };
  for (const Wheels& w : {Wheels{"[90, 270]", 2, false},
                          {"[150, 270, 30]", 3, true},
                          {"[30, 90, 150, 210, 270, 330]", 6, true}}) {
    fs::remove_all(out_);
    fs::create_directories(out_);
    std::string model = four;
    const auto put = [&](const std::string& from, const std::string& to) {
      ASSERT_NE(model.find(from), std::string::npos) << from;
      model.replace(model.find(from), from.size(), to);
    };
    put("[55, 135, 225, 305]", w.angles);
    put("\"../motors/", "\"" + (fs::path(OMNIHIL_SOURCE_DIR) / "models/motors/").string());
    if (!w.rollers) {  // the wheel's own grip: sideways as ahead
      put("extremum_slip   = { value = 1.0, ", "extremum_slip   = { value = 0.10,");
      put("extremum_value  = { value = 0.02,", "extremum_value  = { value = 0.75,");
      put("asymptote_slip  = { value = 2.0, ", "asymptote_slip  = { value = 0.40,");
      put("asymptote_value = { value = 0.01,", "asymptote_value = { value = 0.60,");
    }
    std::ofstream(out_ / "wheels.toml") << model;
    const Ran ran = run_omnihil("sim" + shell(out_ / "wheels.toml") + "--excite steps --duration 4 --out " +
                                shell(out_ / "bench"));
    ASSERT_EQ(ran.exit_code, 0) << ran.text;
    const std::string toml = text_of(out_ / "bench" / "dataset.toml");
    EXPECT_NE(toml.find("duty_" + std::to_string(w.count)), std::string::npos);
    EXPECT_EQ(toml.find("duty_" + std::to_string(w.count + 1)), std::string::npos);
    std::string tubes;
    for (std::size_t i = 1; i <= w.count; ++i) tubes += " --tube velocity_" + std::to_string(i) + "=4";
    const Ran compared = run_omnihil("compare " + shell(out_ / "bench") + tubes);
    EXPECT_EQ(compared.exit_code, 0) << w.angles << compared.text;
  }
}

TEST_F(SimRobotVerb, ADatasetOfAnotherNumberOfWheelsThanItsModelIsRefused) {
  ASSERT_EQ(run_omnihil("sim omni_default --excite steps --duration 0.5 --out " + shell(out_)).exit_code, 0);
  std::string model = text_of(out_ / "model.toml");
  const auto at = model.find("wheel_angle_deg"), open = model.find('[', at), close = model.find(']', open);
  ASSERT_NE(at, std::string::npos);
  model.replace(open, close + 1 - open, "[150, 270, 30]");
  std::ofstream(out_ / "model.toml") << model;
  const Ran ran = run_omnihil("compare " + shell(out_));
  EXPECT_EQ(ran.exit_code, 2) << ran.text;
  EXPECT_TRUE(ran.says("the model has 3 wheels")) << ran.text;
}

TEST_F(SimRobotVerb, TheDongleServesRobotsOfFourWheelsOnlyAndSaysSo) {
  const Ran ran =
      run_omnihil("serve --duration 0.1 --clock free --device" + shell(out_) +
                  "--radio ulaval-hermes --robot '" OMNIHIL_SOURCE_DIR "/examples/import/kiwi_robot.toml'");
  EXPECT_EQ(ran.exit_code, 2) << ran.text;
  EXPECT_TRUE(ran.says("has 3 wheels; radio, firmware and recordings know four")) << ran.text;
}

}  // namespace
}  // namespace omnihil
