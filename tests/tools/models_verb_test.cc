// `omnihil models`: what it prints and its exit codes.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdio>
#include <filesystem>
#include <string>

#include "tools/exit_codes.h"

namespace omnihil {
namespace {

struct Outcome {
  int exit_code = -1;
  std::string text;  // both streams
};

Outcome omnihil_models(const std::string& arguments) {
  Outcome run;
  const std::string command = std::string(OMNIHIL_PROGRAM) + " models " + arguments + " 2>&1";
  FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return run;
  char buffer[4096];
  for (std::size_t n; (n = fread(buffer, 1, sizeof buffer, pipe)) > 0;) run.text.append(buffer, n);
  const int status = pclose(pipe);
  if (WIFEXITED(status)) run.exit_code = WEXITSTATUS(status);
  return run;
}

class ModelsVerb : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(OMNIHIL_PROGRAM))
      GTEST_SKIP() << "the program is not built: " << OMNIHIL_PROGRAM;
  }
};

TEST_F(ModelsVerb, ListsRobotsAndMotors) {
  const Outcome run = omnihil_models("");
  EXPECT_EQ(run.exit_code, kExitOk);
  for (const char* name : {"omni_default", "roboteam_2024", "ulaval_delta", "maxon_ec45_flat_30w"}) {
    EXPECT_NE(run.text.find(name), std::string::npos) << name;
  }
}

TEST_F(ModelsVerb, ExplainsWithUnitToleranceAndSource) {
  const Outcome run = omnihil_models("maxon_ec45_flat_30w");
  EXPECT_EQ(run.exit_code, kExitOk);
  for (const char* words : {"1.2 ohm", "+-10 %", "Maxon data sheet 200142", "stall torque", "0.255 N m"}) {
    EXPECT_NE(run.text.find(words), std::string::npos) << words << " in\n" << run.text;
  }
}

TEST_F(ModelsVerb, ChecksAllFilesAndNamesEveryProblem) {
  const std::string bad = OMNIHIL_SOURCE_DIR "/tests/sim/model/bad_models/";
  const Outcome run =
      omnihil_models("--check omni_default " + bad + "many_at_once.toml " + bad + "no_direction.toml");
  EXPECT_EQ(run.exit_code, kExitBadInput);
  EXPECT_NE(run.text.find("omni_default: good"), std::string::npos);
  EXPECT_NE(run.text.find("many_at_once.toml:13:27: robot.mass_kg = \"heavy\""), std::string::npos);
  EXPECT_NE(run.text.find("no_direction.toml:22:13: encoder.direction = 0"), std::string::npos);
  EXPECT_NE(run.text.find("6 problems"), std::string::npos);
}

TEST_F(ModelsVerb, UnknownNameIsBadInput) {
  EXPECT_EQ(omnihil_models("no_such_model").exit_code, kExitBadInput);
}

}  // namespace
}  // namespace omnihil
