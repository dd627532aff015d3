// Variables of a running image and of a running library, by name: in scenarios, recordings and on the way.
#include <gtest/gtest.h>

#include <cmath>

#include "hil/recording/session_setup.h"
#include "hil/variables/variable_watch.h"
#include "tests/hil/variables/variable_scenario.h"
#include "tests/tools/cli.h"

namespace omnihil {
namespace {

namespace fs = std::filesystem;

const std::string kImage = OMNIHIL_BUILD_DIR "/images/omni_reference_f405.elf";
const std::string kBoard = OMNIHIL_SOURCE_DIR "/boards/omni_reference_f405.toml";
const std::string kLibrary = OMNIHIL_BUILD_DIR "/tests/firmware/libwhole_integral.so";

class ImageVariables : public testing::Test {
 protected:
  void SetUp() override {
    if (!fs::exists(kImage)) GTEST_SKIP() << "arm-none-eabi-gcc is not installed";
  }
};

// The image counts its own periods: 1000 a second, from the instant at which its timer starts.
TEST_F(ImageVariables, AScenarioHoldsAVariableOfTheImageToLimits) {
  const auto good = outcome_of(
      "[[check]]\nis = \"signal\"\nsignal = \"var:state(reference_state).ticks\"\nfrom_s = 0.5\nto_s = "
      "0.502\n"
      "at_least_value = 490\nat_most_value = 503\n",
      {.file = kImage, .board = kBoard});
  EXPECT_TRUE(good.passed()) << failures(good);
  const auto bad = outcome_of(
      "[[check]]\nis = \"signal\"\nsignal = \"var:state(reference_state).ticks\"\nfrom_s = 0.5\nto_s = "
      "0.502\n"
      "at_most_value = 400\n",
      {.file = kImage, .board = kBoard});
  EXPECT_FALSE(bad.passed());
  EXPECT_NE(failures(bad).find("var:state(reference_state).ticks"), std::string::npos) << failures(bad);
}

// What is set while it runs acts: a loop whose integral says so many volts turns its wheel faster, for an instant.
TEST_F(ImageVariables, AStepSetsAVariableAndTheWheelFollows) {
  const std::string fast =
      "[[check]]\nis = \"signal\"\nsignal = \"omega_wheel_rad_s\"\nwheels = [2]\nfrom_s = 0.4\nto_s = 0.5\n"
      "at_most_rad_s = 21.0\n";
  EXPECT_TRUE(outcome_of(fast, {.file = kImage, .board = kBoard}).passed());
  const auto pushed = outcome_of(
      "[[step]]\nat_s = 0.4\ndo = \"set\"\nname = \"state(reference_state).loop[2].integral_V\"\nvalue = "
      "6.0\n" +
          fast,
      {.file = kImage, .board = kBoard});
  EXPECT_FALSE(pushed.passed()) << "an integral of 6 V changed nothing";
}

// Start-up code clears the variables: a value at the start is given after it, and before main() does anything.
TEST_F(ImageVariables, AValueAtTheStartOutlivesStartUpCode) {
  const auto outcome = outcome_of(
      "[[check]]\nis = \"signal\"\nsignal = \"var:main.c:now_us\"\nfrom_s = 0.1\nto_s = 0.11\n"
      "at_least_value = 500090000\nat_most_value = 500115000\n",
      {.file = kImage, .board = kBoard}, {"main.c:now_us=500000000"});
  EXPECT_TRUE(outcome.passed()) << failures(outcome);
}

TEST_F(ImageVariables, LookingChangesNothing) {
  const std::string check =
      "[[check]]\nis = \"signal\"\nsignal = \"omega_wheel_rad_s\"\nfrom_s = 0.5\nto_s = 0.6\nat_most_rad_s = "
      "1000\n";
  const auto plain = outcome_of(check, {.file = kImage, .board = kBoard});
  const auto watched =
      outcome_of(check + "[[check]]\nis = \"signal\"\nsignal = \"var:now_us\"\nat_least_value = 0\n",
                 {.file = kImage, .board = kBoard});
  EXPECT_EQ(plain.results[0].measured, watched.results[0].measured);
  EXPECT_EQ(plain.results[3].measured, watched.results[3].measured);
}

// Its state block is a struct of the library, found by its size.
TEST(LibraryVariables, TheStateBlockIsReadByName) {
  const auto outcome = outcome_of(
      "[[check]]\nis = \"signal\"\nsignal = \"var:state.ticks\"\nfrom_s = 0.3\nto_s = 0.302\nat_least_value "
      "= 301\n"
      "at_most_value = 302\n",
      {.file = kLibrary});
  EXPECT_TRUE(outcome.passed()) << failures(outcome);
}

TEST(LibraryVariables, AStepSetsTheStateBlock) {
  const auto outcome = outcome_of(
      "[[step]]\nat_s = 0.2\ndo = \"set\"\nname = \"state.ticks\"\nvalue = 100000\n"
      "[[check]]\nis = \"signal\"\nsignal = \"var:state.ticks\"\nfrom_s = 0.3\nto_s = 0.302\nat_least_value "
      "= 100101\n"
      "at_most_value = 100102\n",
      {.file = kLibrary});
  EXPECT_TRUE(outcome.passed()) << failures(outcome);
}

TEST(LibraryVariables, EveryProblemOfNamesIsSaidAtOnce) {
  const std::string said = refusal_of([] {
    outcome_of(
        "[[step]]\nat_s = 0.2\ndo = \"set\"\nname = \"state.tick\"\nvalue = 1\n"
        "[[step]]\nat_s = 0.2\ndo = \"set\"\nname = \"state.at\"\nvalue = \"high\"\n"
        "[[check]]\nis = \"signal\"\nsignal = \"var:state.ticks\"\nat_least_value = 0\n",
        {.file = kLibrary});
  });
  EXPECT_NE(said.find("it has .ticks"), std::string::npos) << said;
  EXPECT_NE(said.find("\"high\" is not allowed"), std::string::npos) << said;
  EXPECT_NE(said.find("variables.toml:9"), std::string::npos) << said;
}

TEST(LibraryVariables, TheReferenceFirmwareInThisProcessShowsNone) {
  const std::string said = refusal_of(
      [] { outcome_of("[[check]]\nis = \"signal\"\nsignal = \"var:ticks\"\nat_least_value = 0\n", {}); });
  EXPECT_NE(said.find("needed: an image on an emulated board"), std::string::npos) << said;
}

// A check on what is no number any more fails, and says when.
TEST(LibraryVariables, NotANumberFailsItsCheck) {
  const auto outcome = outcome_of(
      "[[step]]\nat_s = 0.203\ndo = \"set\"\nname = \"state.duty[3]\"\nvalue = nan\n"
      "[[check]]\nis = \"signal\"\nsignal = \"var:state.duty[3]\"\nto_s = 0.205\nat_most_value = 100\n",
      {.file = kLibrary});
  ASSERT_FALSE(outcome.passed());
  EXPECT_TRUE(std::isnan(*outcome.results[0].measured));
  EXPECT_NEAR(outcome.results[0].at_s, 0.203, 1e-9);
}

class VariablesProgram : public CliTest {
 protected:
  void SetUp() override {
    CliTest::SetUp();
    folder_ = fs::temp_directory_path() / ("omnihil_variables_" + std::to_string(::getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  fs::path folder_;
};

// Written by serve, read back by convert: the column is there with the values of both robots.
TEST_F(VariablesProgram, AWatchedVariableIsAColumnOfTheRecording) {
  const Ran served = run_omnihil(
      "serve --robots 0,1 --clock free --physics planar --duration 0.5 --sample-every 1 --device" +
      shell(folder_ / "dongle") + "--record" + shell(folder_ / "run.omnirec") + "--firmware" +
      shell(kLibrary) + "--watch state.ticks --watch state.duty --set state.ticks=1000");
  ASSERT_EQ(served.exit_code, 0) << served.text;
  const Ran converted =
      run_omnihil("convert" + shell(folder_ / "run.omnirec") + "--to csv --out" + shell(folder_ / "run.csv"));
  ASSERT_EQ(converted.exit_code, 0) << converted.text;
  std::ifstream csv(folder_ / "run.csv");
  std::string line;
  std::getline(csv, line);
  EXPECT_NE(line.find("var:state.ticks"), std::string::npos) << line;
  EXPECT_NE(line.find("var:state.duty[3]"), std::string::npos) << line;
  std::string last;
  while (std::getline(csv, line)) last = line;
  EXPECT_NE(last.find(",1500,"), std::string::npos) << last;  // 500 ticks of 1 ms from 1000 on
}

TEST_F(VariablesProgram, ListsNamesTypesAndPlaces) {
  const Ran all = run_omnihil("variables" + shell(kLibrary));
  EXPECT_EQ(all.exit_code, 0) << all.text;
  EXPECT_TRUE(all.says("kInvM1")) << all.text;
  EXPECT_TRUE(all.says("the state block")) << all.text;
  const Ran part = run_omnihil("variables" + shell(kLibrary) + "'kInvM1[2]'");
  EXPECT_EQ(part.exit_code, 0) << part.text;
  EXPECT_TRUE(part.says("kInvM1[2][3]")) << part.text;
  EXPECT_TRUE(part.says("starts as 0.00166")) << part.text;  // kInvM1[2][2] of the source
  const Ran none = run_omnihil("variables" + shell(kLibrary) + "kInvM2");
  EXPECT_EQ(none.exit_code, 2);
  EXPECT_TRUE(none.says("did you mean")) << none.text;
  EXPECT_EQ(run_omnihil("variables /nowhere.elf").exit_code, 2);
}

TEST_F(VariablesProgram, ATableHasEverySignalAndVariable) {
  const Ran ran = run_omnihil("scenario run wheel/speed_step --firmware" + shell(kLibrary) +
                              "--no-plots --watch state.ticks --csv" + shell(folder_ / "tables"));
  EXPECT_NE(ran.exit_code, 2) << ran.text;
  std::ifstream csv(folder_ / "tables" / "speed_step.csv");
  std::string head, first;
  std::getline(csv, head);
  std::getline(csv, first);
  EXPECT_TRUE(head.starts_with("time_s,omega_wheel_rad_s_0,")) << head;
  EXPECT_TRUE(head.ends_with(",var:state.ticks")) << head;
  EXPECT_TRUE(first.ends_with(",1")) << first;
}

}  // namespace
}  // namespace omnihil
