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

// The image of the ports, which says "boot" on USART2 in its first 2 ms; its wheels do not turn.
class ScenarioConsoleProgram : public ScenarioProgram {
 protected:
  void SetUp() override {
    ScenarioProgram::SetUp();
    if (!fs::exists(OMNIHIL_BUILD_DIR "/images/ports.elf")) GTEST_SKIP() << "no image";
  }
  Ran run(const std::string& checks, const std::string& port = "of = \"USART2\"\nconsole = true\n") const {
    std::ifstream board(OMNIHIL_SOURCE_DIR "/boards/four_wheels_f405.toml");
    std::ofstream(folder_ / "board.toml") << board.rdbuf() << (port.empty() ? "" : "\n[[port]]\n") << port;
    std::ofstream(folder_ / "s.toml")
        << "format = \"omnihil-scenario/1\"\ntitle = \"t\"\nduration_s = 0.05\nstand = true\n"
           "opponents = 2\n[[step]]\nat_s = 0.01\ndo = \"command\"\nomega_wheel_rad_s = 5.0\n"
        << checks;
    return run_omnihil("scenario run" + shell(folder_ / "s.toml") + "--no-plots --all --json" +
                       shell(folder_ / "out.json") + "--junit" + shell(folder_ / "out.xml") +
                       "--firmware '" OMNIHIL_BUILD_DIR "/images/ports.elf' --board" +
                       shell(folder_ / "board.toml"));
  }
};
const std::string kSaysBoot = "[[check]]\nis = \"console_says\"\ntext = \"boot\"\nat_most_s = 0.003\n";
const std::string kNeverBoot = "[[check]]\nis = \"console_never_says\"\ntext = \"boot\"\nport = \"USART2\"\n";

TEST_F(ScenarioConsoleProgram, WhatABoardSaysIsExpected) {
  const Ran ran = run(kSaysBoot + "[[check]]\nis = \"console_never_says\"\ntext = \"fault\"\n");
  EXPECT_EQ(ran.exit_code, 0) << ran.text;
  EXPECT_TRUE(ran.says("console_says \"boot\"")) << ran.text;
}

// Once: of the robot, not of its opponents, which run the same image.
TEST_F(ScenarioConsoleProgram, WhatItMustNotSayFailsAndIsShown) {
  const Ran ran = run(kNeverBoot);
  EXPECT_EQ(ran.exit_code, 1) << ran.text;
  EXPECT_TRUE(ran.says("console_never_says \"boot\"") && ran.says("1              at most 0")) << ran.text;
  EXPECT_TRUE(ran.says("  said  0.00") && ran.says("robot 1 USART2 | boot")) << ran.text;
  EXPECT_NE(text_of("out.xml").find("<system-out>0.00"), std::string::npos);
  EXPECT_NE(text_of("out.json").find("\"text\":\"boot\""), std::string::npos);
}

// The image gives back every letter as a capital. The opponents run it as well, and are typed at by nobody.
const std::string kTypes = "[[step]]\nat_s = 0.01\ndo = \"type\"\ntext = \"go on\\n\"\n";
TEST_F(ScenarioConsoleProgram, WhatIsTypedIsRead) {
  const std::string answers =
      "[[check]]\nis = \"console_says\"\ntext = \"GO ON\"\nfrom_s = 0.01\nat_most_s = 0.005\n";
  const auto with = [](const std::string& of) {  // past its words by semihosting, without which it stops
    return "of = \"semihosting\"\nconsole = true\n[[port]]\nof = \"" + of + "\"\nconsole = true\n";
  };
  EXPECT_EQ(run(kTypes + answers, with("USART2")).exit_code, 0);
  EXPECT_EQ(run(answers, with("USART2")).exit_code, 1);
  const Ran rtt = run(kTypes + answers, with("RTT"));
  EXPECT_EQ(rtt.exit_code, 0) << rtt.text;
}

TEST_F(ScenarioConsoleProgram, NothingIsTypedWhereNobodyReads) {
  const Ran ran = run(kTypes + kSaysBoot, "of = \"ITM\"\nconsole = true\n");
  EXPECT_EQ(ran.exit_code, 2) << ran.text;
  EXPECT_TRUE(ran.says("s.toml:10: type: needed") && ran.says("a serial port or RTT")) << ran.text;
}

TEST_F(ScenarioConsoleProgram, WithoutAConsoleNothingIsExpectedOfIt) {
  const Ran ran = run(kNeverBoot, "");
  EXPECT_EQ(ran.exit_code, 2) << ran.text;
  EXPECT_TRUE(ran.says("s.toml:10: console_never_says") && ran.says("console = true")) << ran.text;
}

// An RP2040 in the loop: four wheels on a stand, geared 3 to 1; encoders by pin interrupts and by PIO.
class ScenarioRp2040 : public ScenarioProgram {
 protected:
  Ran run(const std::string& image, const std::string& step, const std::string& limits) const {
    std::ofstream(folder_ / "s.toml")
        << "format = \"omnihil-scenario/1\"\ntitle = \"t\"\nduration_s = 1.5\nstand = true\n"
        << "[[step]]\n"
        << step << "[[check]]\nis = \"signal\"\nsignal = \"omega_wheel_rad_s\"\nfrom_s = 1.2\n"
        << limits;
    return run_omnihil("scenario run" + shell(folder_ / "s.toml") + "--no-plots --all --firmware '" + image +
                       "' --board '" OMNIHIL_SOURCE_DIR "/boards/four_wheels_rp2040.toml'");
  }
};

TEST_F(ScenarioRp2040, HoldsTheSpeedsOfItsFlash) {
  const std::string image = OMNIHIL_BUILD_DIR "/images/wheels_rp2040.elf";
  if (!fs::exists(image)) GTEST_SKIP() << "no image";
  const Ran ran = run(image, "at_s = 1.0\ndo = \"mark\"\n", "at_least_rad_s = 19.8\nat_most_rad_s = 20.2\n");
  EXPECT_EQ(ran.exit_code, 0) << ran.text;
}

// docs/mcu-third-party.md says how it is built.
TEST_F(ScenarioRp2040, AnImageOfThePicoSdkIsToldItsSpeedsByConsole) {
  const char* folder = std::getenv("OMNIHIL_IMAGES");
  const std::string image = folder != nullptr ? std::string(folder) + "/pico-wheels.elf" : std::string();
  if (!fs::exists(image)) GTEST_SKIP() << "no pico-wheels.elf in OMNIHIL_IMAGES";
  const Ran ran = run(image, "at_s = 0.1\ndo = \"type\"\ntext = \"S 40 40 40 40\\n\"\n",
                      "at_least_rad_s = 13.2\nat_most_rad_s = 13.5\n");
  EXPECT_EQ(ran.exit_code, 0) << ran.text;
}

}  // namespace
}  // namespace omnihil
