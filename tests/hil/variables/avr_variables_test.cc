// Variables of AVR images by name: sizes and places of avr-gcc's debug information, and boards that run.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "tests/hil/variables/built_program.h"
#include "tests/hil/variables/variable_scenario.h"
#include "tests/tools/cli.h"

namespace omnihil {
namespace {

namespace fs = std::filesystem;

const std::string kImages = OMNIHIL_BUILD_DIR "/images/";
const std::string kImage = kImages + "omni_reference_avr.elf";
const std::string kBoard = OMNIHIL_SOURCE_DIR "/boards/omni_reference_avr.toml";

// tests/firmware_iface/mcu/avr_images/names.c
class AvrNames : public testing::Test {
 protected:
  void SetUp() override {
    if (!fs::exists(kImages + "avr_names.elf")) GTEST_SKIP() << "avr-gcc is not installed";
    std::string problem;
    const auto info = DebugInfo::read(bytes_of(kImages + "avr_names.elf"), problem);
    ASSERT_NE(info, nullptr) << problem;
    names_ = std::make_unique<VariableNames>(info, VariableSpace{4});
  }
  VariablePlace place(const std::string& name) const {
    std::string problem;
    const auto found = names_->find(name, problem);
    EXPECT_TRUE(found) << name << " " << problem;
    return found.value_or(VariablePlace{});
  }
  std::string problem(const std::string& name) const {
    std::string said;
    EXPECT_FALSE(names_->find(name, said)) << name;
    return said;
  }
  // What the file has there, as the program starts with it.
  std::string starts_as(const std::string& name) const {
    const VariablePlace at = place(name);
    return text_of_value(names_->info().type(at.type), at,
                         names_->info().initial(at.piece.address, at.piece.bytes));
  }
  std::unique_ptr<VariableNames> names_;
};

TEST_F(AvrNames, ValuesHaveTheSizesOfAnAvr) {
  EXPECT_EQ(place("whole").piece.bytes, 2u);
  EXPECT_EQ(place("ratio").piece.bytes, 4u);
  EXPECT_EQ(place("wide").piece.bytes, 8u);
  EXPECT_EQ(place("axes[0].port").piece.bytes, 2u);
  EXPECT_EQ(place("axes[0].mode").piece.bytes, 2u);
  EXPECT_EQ(place("axes[0].table").piece.bytes, 16u);
  // int, double, 8 bits, enum, pointer, four longs, without gaps
  EXPECT_EQ(place("axes[0]").piece.bytes, 2u + 4u + 1u + 2u + 2u + 16u);
  EXPECT_EQ(place("axes[1].gain").piece.address - place("axes").piece.address, 27u + 2u);
  EXPECT_GE(place("axes").piece.address, 0x800100u);
  EXPECT_LT(place("axes").piece.address, 0x800900u);
}

TEST_F(AvrNames, WhatTheFileGivesThemIsReadByName) {
  EXPECT_EQ(starts_as("whole"), "-1234");
  EXPECT_EQ(starts_as("ratio"), "0.625");
  EXPECT_EQ(starts_as("wide"), "-5000000000");
  EXPECT_EQ(starts_as("axes[0].last"), "7");
  EXPECT_EQ(starts_as("axes[0].gain"), "1.5");
  EXPECT_EQ(starts_as("axes[0].level"), "5");
  EXPECT_EQ(starts_as("axes[0].trim"), "-9");
  EXPECT_EQ(starts_as("axes[0].mode"), "MODE_DRIVING");
  EXPECT_EQ(starts_as("axes[0].table[1][0]"), "3");
  EXPECT_EQ(starts_as("axes[0].port"), "0x0025");  // PORTB
  EXPECT_EQ(place("main::turns@3").piece.board, 3u);
}

TEST_F(AvrNames, WhatIsNotInDataMemoryIsSaidByItsPlace) {
  EXPECT_NE(problem("in_flash").find("flash (PROGMEM)"), std::string::npos) << problem("in_flash");
  EXPECT_NE(problem("main::words").find("flash (PROGMEM)"), std::string::npos) << problem("main::words");
  EXPECT_NE(problem("in_eeprom").find("EEPROM"), std::string::npos) << problem("in_eeprom");
  EXPECT_NE(problem("PORTB").find("register"), std::string::npos) << problem("PORTB");
  EXPECT_NE(problem("left_out").find("removed by the linker"), std::string::npos) << problem("left_out");
  EXPECT_NE(problem("spent").find("optimiser"), std::string::npos) << problem("spent");
  EXPECT_EQ(place("gone").constant, (std::vector<std::uint8_t>{5, 0}));  // all that the optimiser kept of it
  EXPECT_NE(problem("i").find("is a local of main()"), std::string::npos) << problem("i");
}

TEST_F(AvrNames, StabsAndHexAreSaidAndWhatToDo) {
  std::string why;
  EXPECT_EQ(DebugInfo::read(bytes_of(kImages + "avr_names.hex"), why), nullptr);
  EXPECT_NE(why.find("give the ELF"), std::string::npos) << why;
  const fs::path stabs = fs::temp_directory_path() / ("omnihil_stabs_" + std::to_string(::getpid()));
  const std::string command = "avr-objcopy -g --add-section .stab='" + kBoard + "' '" + kImages +
                              "avr_names.elf' '" + stabs.string() + "'";
  ASSERT_EQ(std::system(command.c_str()), 0);
  EXPECT_EQ(DebugInfo::read(bytes_of(stabs), why), nullptr);
  fs::remove(stabs);
  EXPECT_NE(why.find("-gdwarf-4"), std::string::npos) << why;
}

class AvrVariables : public CliTest {
 protected:
  void SetUp() override {
    CliTest::SetUp();
    if (!fs::exists(OMNIHIL_BUILD_DIR "/tools/omnihil-avr")) GTEST_SKIP() << "no simavr";
    if (!fs::exists(kImage)) GTEST_SKIP() << "avr-gcc is not installed";
  }
  static ScenarioOutcome run(const std::string& steps_and_checks, const std::vector<std::string>& set = {},
                             const std::string& image = kImage) {
    return outcome_of(steps_and_checks, {.file = image, .board = kBoard, .deadline_s = 60.0}, set,
                      "omni_1024");
  }
  static std::string limits(const std::string& signal, double at_s, double least, double most) {
    return fmt::format(
        "[[check]]\nis = \"signal\"\nsignal = \"var:{}\"\nfrom_s = {}\nto_s = {}\nat_least_value = {}\n"
        "at_most_value = {}\n",
        signal, at_s, at_s + 0.002, least, most);
  }
};

// Each board counts its own time, 2000 us a control period from the instant on at which its timer starts.
TEST_F(AvrVariables, AScenarioHoldsAVariableOfABoardToLimits) {
  const auto good =
      run(limits("node.now_us", 0.5, 490000, 503000) + limits("node.now_us@3", 0.5, 490000, 503000) +
          limits("node.wheel@2", 0.5, 2, 2) + limits("node.tuning.gear_ratio", 0.5, 3, 3));
  EXPECT_TRUE(good.passed()) << failures(good);
  const auto bad = run(limits("node.wheel@2", 0.5, 3, 3));
  EXPECT_FALSE(bad.passed());
  EXPECT_NE(failures(bad).find("var:node.wheel@2"), std::string::npos) << failures(bad);
}

// What is set while it runs acts, on that board: an integral of so many volts turns its wheel faster, for an instant.
TEST_F(AvrVariables, AStepSetsAVariableAndTheWheelFollows) {
  const auto fast = [](int wheel) {
    return fmt::format(
        "[[check]]\nis = \"signal\"\nsignal = \"omega_wheel_rad_s\"\nwheels = [{}]\nfrom_s = 0.4\nto_s = "
        "0.5\nat_most_rad_s = 22.0\n",
        wheel);
  };
  const std::string set =
      "[[step]]\nat_s = 0.4\ndo = \"set\"\nname = \"node.loop.integral_V@2\"\nvalue = 8.0\n";
  const auto plain = run(fast(2));
  EXPECT_TRUE(plain.passed()) << failures(plain);
  EXPECT_FALSE(run(set + fast(2)).passed()) << "an integral of 8 V changed nothing";
  const auto others = run(set + fast(1));
  EXPECT_TRUE(others.passed()) << failures(others);
}

// Start-up code copies .data: what is set at the start is set behind it, at main().
TEST_F(AvrVariables, AValueAtTheStartOutlivesStartUpCode) {
  const std::vector<std::string> set = {"whole=500", "cleared=70000", "axes[0].gain@3=0.5"};
  const auto outcome =
      run(limits("axes[1].last", 0.3, 507, 507) + limits("axes[0].gain", 0.3, 1.5, 1.5) +
              limits("axes[0].gain@3", 0.3, 0.5, 0.5) + limits("axes[1].last@3", 0.3, -1227, -1227),
          set, kImages + "avr_names.elf");
  EXPECT_TRUE(outcome.passed()) << failures(outcome);
}

TEST_F(AvrVariables, LookingChangesNothing) {
  const std::string check =
      "[[check]]\nis = \"signal\"\nsignal = \"omega_wheel_rad_s\"\nfrom_s = 0.5\nto_s = 0.6\nat_most_rad_s = "
      "1000\n";
  const auto plain = run(check), watched = run(check + limits("node.loop.integral_V@1", 0.5, -100, 100));
  for (std::size_t w = 0; w < 4; ++w) EXPECT_EQ(plain.results[w].measured, watched.results[w].measured);
}

TEST_F(AvrVariables, EveryProblemOfNamesIsSaidAtOnce) {
  const std::string said = refusal_of([] {
    run(limits("node.whee", 0.5, 0, 1) + limits("PORTB", 0.5, 0, 1) + limits("node.wheel@4", 0.5, 0, 1));
  });
  EXPECT_NE(said.find("it has .wheel"), std::string::npos) << said;
  EXPECT_NE(said.find("register"), std::string::npos) << said;
  EXPECT_NE(said.find("allowed: @0 to @3"), std::string::npos) << said;
}

TEST_F(AvrVariables, IntelHexNamesNoVariablesAndSaysSo) {
  const std::string said =
      refusal_of([] { run(limits("node.wheel", 0.5, 0, 0), {}, kImages + "omni_reference_avr.hex"); });
  EXPECT_NE(said.find("give the ELF"), std::string::npos) << said;
}

TEST_F(AvrVariables, AWatchedVariableIsAColumnOfTheRecording) {
  const fs::path folder = fs::temp_directory_path() / ("omnihil_avr_variables_" + std::to_string(::getpid()));
  fs::create_directories(folder);
  const Ran served = run_omnihil(
      "serve --robots 0 --robot omni_1024 --clock free --physics planar --duration 0.3 --sample-every 1 "
      "--device" +
      shell(folder / "dongle") + "--record" + shell(folder / "run.omnirec") + "--firmware" + shell(kImage) +
      "--board" + shell(kBoard) + "--watch node.now_us --watch node.geometry.rim_per_body[1]@1");
  EXPECT_EQ(served.exit_code, 0) << served.text;
  const Ran converted =
      run_omnihil("convert" + shell(folder / "run.omnirec") + "--to csv --out" + shell(folder / "run.csv"));
  EXPECT_EQ(converted.exit_code, 0) << converted.text;
  std::ifstream csv(folder / "run.csv");
  std::string head, line, last;
  std::getline(csv, head);
  EXPECT_NE(head.find("var:node.now_us"), std::string::npos) << head;
  EXPECT_NE(head.find("var:node.geometry.rim_per_body[1][2]@1"), std::string::npos) << head;
  while (std::getline(csv, line)) last = line;
  const std::size_t at = last.find(",29");  // of 0.3 s, after some start-up, in periods of 2000 us
  ASSERT_NE(at, std::string::npos) << last;
  const double now_us = std::stod(last.substr(at + 1));
  EXPECT_TRUE(now_us >= 290000 && now_us <= 300000 && std::fmod(now_us, 2000) == 0) << last;
  fs::remove_all(folder);
}

}  // namespace
}  // namespace omnihil
