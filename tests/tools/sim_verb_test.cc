// `omnihil effects` and `omnihil sim` as a user runs them.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "tests/tools/cli.h"

namespace omnihil {
namespace {

class SimVerb : public CliTest {
 protected:
  void SetUp() override {
    CliTest::SetUp();
    folder_ = std::filesystem::temp_directory_path() /
              ("omnihil_sim_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()) +
               "_" + std::to_string(::getpid()));
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path file(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
    return folder_ / name;
  }
  std::string text_of(const std::filesystem::path& path) const {
    std::ostringstream out;
    out << std::ifstream(path).rdbuf();
    return out.str();
  }
  std::filesystem::path model(const std::string& more = "") const {
    return file(
        "axis.toml",
        "format = \"omnihil-model/1\"\nrig = \"axis\"\n[motor]\nresistance_ohm = 0.464\n"
        "torque_constant_Nm_per_A = { value = 0.0335, tolerance = 0.05 }\nrotor_inertia_kg_m2 = 1.35e-5\n"
        "pole_pairs = 8\nslots = 12\n[load]\ninertia_kg_m2 = 4.6e-5\n[supply]\nvoltage_V = 24.0\n" +
            more);
  }

  std::filesystem::path folder_;
};

TEST_F(SimVerb, WritesADatasetWithAFitAndAHoldoutRun) {
  const Ran ran =
      run_omnihil("sim" + shell(model()) + "--excite steps --duration 1 --out" + shell(folder_ / "d"));
  EXPECT_EQ(ran.exit_code, 0) << ran.text;
  EXPECT_TRUE(ran.says("2 runs, 2002 rows")) << ran.text;
  const std::string set = text_of(folder_ / "d/dataset.toml");
  for (const char* needed : {"omnihil-dataset/1", "rig = \"axis\"", "use = \"fit\"", "use = \"holdout\"",
                             "sigma = 0.03", "counts_per_rev = 4096"}) {
    EXPECT_NE(set.find(needed), std::string::npos) << needed << "\n" << set;
  }
  const std::string csv = text_of(folder_ / "d/steps.csv");
  EXPECT_EQ(csv.substr(0, csv.find('\n')), "time_s,duty,bus_V,current_A,ticks");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1002);
  EXPECT_NE(
      text_of(folder_ / "d/model.toml").find("torque_constant_Nm_per_A = { value = 0.0335, tolerance = 0.05"),
      std::string::npos);
}

TEST_F(SimVerb, KeepsAnAddedEffectOutOfTheNominalModelAndIntoTheData) {
  const std::string common = "sim" + shell(model()) + "--excite ramp --duration 1 --noise 0 ";
  ASSERT_EQ(run_omnihil(common + "--out" + shell(folder_ / "a")).exit_code, 0);
  ASSERT_EQ(
      run_omnihil(common + "--with coulomb_friction.torque_Nm=0.01 --out" + shell(folder_ / "b")).exit_code,
      0);
  EXPECT_EQ(text_of(folder_ / "a/model.toml"), text_of(folder_ / "b/model.toml"));
  EXPECT_NE(text_of(folder_ / "a/ramp.csv"), text_of(folder_ / "b/ramp.csv"));
}

TEST_F(SimVerb, IsTheSameForTheSameSeedAndAnotherForAnother) {
  const std::string common = "sim" + shell(model()) + "--excite prbs --duration 0.5 ";
  ASSERT_EQ(run_omnihil(common + "--seed 3 --out" + shell(folder_ / "a")).exit_code, 0);
  ASSERT_EQ(run_omnihil(common + "--seed 3 --out" + shell(folder_ / "b")).exit_code, 0);
  ASSERT_EQ(run_omnihil(common + "--seed 4 --out" + shell(folder_ / "c")).exit_code, 0);
  EXPECT_EQ(text_of(folder_ / "a/prbs.csv"), text_of(folder_ / "b/prbs.csv"));
  EXPECT_NE(text_of(folder_ / "a/prbs.csv"), text_of(folder_ / "c/prbs.csv"));
}

TEST_F(SimVerb, FollowsAFileOfCommands) {
  const auto csv = file("mine.csv", "time_s,duty\n0,0\n0.001,0.5\n0.002,0.5\n0.003,0.2\n0.0041,0\n0.005,0\n");
  const Ran ran =
      run_omnihil("sim" + shell(model()) + "--excite" + shell(csv) + "--out" + shell(folder_ / "d"));
  EXPECT_EQ(ran.exit_code, 0) << ran.text;
  EXPECT_NE(text_of(folder_ / "d/mine.csv").find("0.002000,0.5,"), std::string::npos);
  EXPECT_NE(text_of(folder_ / "d/mine_holdout.csv").find("0.004100,0,"), std::string::npos);
}

TEST_F(SimVerb, RefusesWithEveryReasonAndWritesNothing) {
  const Ran ran = run_omnihil("sim" + shell(model("[effects.coging]\namplitude_Nm = 1\n")) +
                              "--excite wobble --with dead_tim --duration -1 --out" + shell(folder_ / "d"));
  EXPECT_EQ(ran.exit_code, 2);
  EXPECT_TRUE(ran.says("did you mean \"cogging\"?")) << ran.text;
  EXPECT_TRUE(ran.says("--duration")) << ran.text;
  const Ran second =
      run_omnihil("sim" + shell(model()) + "--excite wobble --with dead_tim --drive position_target --out" +
                  shell(folder_ / "d"));
  EXPECT_TRUE(second.says("did you mean \"dead_time\"?")) << second.text;
  EXPECT_TRUE(second.says("no [servo]")) << second.text;
  EXPECT_FALSE(std::filesystem::exists(folder_ / "d"));
}

TEST_F(SimVerb, DrivesAMotorFileAndARobotsWheelToo) {
  for (const char* model : {"maxon_ec45_flat_30w", "omni_default --rig axis"}) {
    const auto folder = folder_ / std::string(model).substr(0, 4);
    const Ran ran =
        run_omnihil(std::string("sim ") + model + " --excite steps --duration 0.2 --out" + shell(folder));
    EXPECT_EQ(ran.exit_code, 0) << ran.text;
    EXPECT_NE(text_of(folder / "dataset.toml").find("rig = \"axis\""), std::string::npos) << model;
  }
}

TEST_F(SimVerb, EffectsListsThemAndExplainsOne) {
  EXPECT_TRUE(run_omnihil("effects").says("cogging"));
  const Ran one = run_omnihil("effects cogging");
  EXPECT_EQ(one.exit_code, 0);
  EXPECT_TRUE(one.says("tau += A sin(n theta + p)")) << one.text;
  const Ran none = run_omnihil("effects coging");
  EXPECT_EQ(none.exit_code, 2);
  EXPECT_TRUE(none.says("did you mean \"cogging\"?")) << none.text;
}

}  // namespace
}  // namespace omnihil
