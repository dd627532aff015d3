// One wheel on a bench through the program: `sim --rig wheel`, and what the other verbs make of it.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "tests/tools/cli.h"

namespace omnihil {
namespace {

namespace fs = std::filesystem;

class SimWheelVerb : public CliTest {
 protected:
  void TearDown() override { fs::remove_all(out_); }
  fs::path out_ = fs::temp_directory_path() / ("omnihil_sim_wheel_" + std::to_string(::getpid()));
};

TEST_F(SimWheelVerb, TheModelThatComesWithTheDataLeavesTheNoise) {
  const Ran ran =
      run_omnihil("sim omni_default --rig wheel --excite steps --duration 2 --out " + shell(out_));
  ASSERT_EQ(ran.exit_code, 0) << ran.text;
  EXPECT_NE(text_of(out_ / "dataset.toml").find("rig = \"wheel\""), std::string::npos);
  // five sigmas of 0.03 A and 0.05 N; a count of 4096 in a millisecond is 1.53 rad/s
  const Ran compared =
      run_omnihil("compare " + shell(out_) +
                  " --tube velocity=1.54 --tube motor_current=0.15 --tube force_x=0.25 --tube "
                  "force_y=0.25");
  EXPECT_EQ(compared.exit_code, 0) << compared.text;
}

TEST_F(SimWheelVerb, RollersThatTheModelLacksAreSeenByTheLoadCell) {
  ASSERT_EQ(
      run_omnihil("sim omni_default --rig wheel --excite steps --duration 2 --with roller_ripple --out " +
                  shell(out_))
          .exit_code,
      0);
  const Ran compared = run_omnihil("compare " + shell(out_) + " --tube force_x=0.25");
  EXPECT_EQ(compared.exit_code, 1) << compared.text;
  const Ran fitted = run_omnihil("fit " + shell(out_));
  EXPECT_EQ(fitted.exit_code, 0) << fitted.text;
  EXPECT_TRUE(fitted.says("tyre.longitudinal.extremum_value")) << fitted.text;
}

TEST_F(SimWheelVerb, WhatAWheelHasNotIsRefusedByName) {
  fs::create_directories(out_);
  std::ofstream(out_ / "dataset.toml")
      << "format = \"omnihil-dataset/1\"\nrig = \"wheel\"\nmodel = \"model.toml\"\n[channels]\n"
         "time = { column = \"t\" }\nduty = { column = \"u\" }\ngyro_z = { column = \"g\" }\n"
         "[[runs]]\nfile = \"a.csv\"\nuse = \"fit\"\n";
  const Ran ran = run_omnihil("compare " + shell(out_));
  EXPECT_EQ(ran.exit_code, 2);
  EXPECT_TRUE(ran.says("there is no such signal on rig \"wheel\"")) << ran.text;
  const Ran file = run_omnihil("sim omni_default --rig wheel --excite a.csv --out " + shell(out_ / "d"));
  EXPECT_EQ(file.exit_code, 2);
  EXPECT_TRUE(file.says("by name")) << file.text;
}

}  // namespace
}  // namespace omnihil
