// Scenario files: what is read, and every problem of a bad one with its place.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "hil/scenario/scenario.h"
#include "hil/scenario/scenario_rows.h"
#include "hil/scenario/scenario_suite.h"
#include "sim/law/random.h"

namespace omnihil {
namespace {

namespace fs = std::filesystem;
const fs::path kSuite = fs::path(OMNIHIL_SOURCE_DIR) / "examples/scenarios";
const fs::path kBroken = fs::path(OMNIHIL_SOURCE_DIR) / "tests/hil/scenario/broken_files";

std::string text_of(const fs::path& file) {
  std::ifstream in(file);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

constexpr std::string_view kGood = R"(format = "omnihil-scenario/1"
title = "t"
duration_s = 2.0
[[step]]
at_s = 0.1
do = "command"
omega_wheel_rad_s = [1.0, 2, 3.0, 4.0]
[[step]]
at_s = 0.5
for_s = 0.25
do = "wheel_blocked"
wheels = [1]
[[check]]
is = "wind_up"
at_most_ratio = 0.1
[[check]]
is = "rise_time"
at_most_s = 0.2
)";

TEST(ScenarioReader, ReadsStepsChecksAndTheirWindows) {
  const ScenarioReading r = read_scenario(kGood, "good.toml");
  ASSERT_TRUE(r.scenario) << r.problems.front().text();
  const Scenario& s = *r.scenario;
  ASSERT_EQ(s.steps.size(), 2u);
  EXPECT_EQ(s.steps[0].command.mode, std::uint32_t{OMNIHIL_MODE_WHEEL_SPEED});
  EXPECT_EQ(s.steps[0].command.omega_wheel_rad_s[3], 4.0);
  EXPECT_EQ(s.steps[1].until_s, 0.75);
  EXPECT_EQ(s.steps[1].line, 8);
  EXPECT_EQ(s.checks[0].from_s, 0.75);  // from the release
  EXPECT_EQ(s.checks[0].to_s, 2.0);
  EXPECT_EQ(s.checks[0].wheels, (WheelSet{false, true, false, false}));
  EXPECT_EQ(s.checks[1].from_s, 0.1);  // from the command to the next step
  EXPECT_EQ(s.checks[1].to_s, 0.5);
}

// Each file's comments say which problems it has: "# expect: LINE KEY".
TEST(ScenarioReader, EveryProblemOfABadFileIsNamedWithItsLine) {
  int files = 0;
  for (const auto& entry : fs::directory_iterator(kBroken)) {
    ++files;
    const std::string text = text_of(entry.path());
    const ScenarioReading r = read_scenario(text, entry.path().filename().string());
    EXPECT_FALSE(r.scenario) << entry.path();
    std::istringstream lines(text);
    std::size_t expected = 0;
    for (std::string line; std::getline(lines, line);) {
      if (line.rfind("# expect: ", 0) != 0) continue;
      ++expected;
      std::istringstream words(line.substr(10));
      int at = 0;
      std::string key;
      words >> at >> key;
      const bool found = std::ranges::any_of(r.problems, [&](const ModelProblem& p) {
        return p.line == at && (key.empty() || p.key.find(key) != std::string::npos) &&
               (!p.allowed.empty() || key.empty());
      });
      std::string all;
      for (const ModelProblem& p : r.problems) all += p.text() + "\n";
      EXPECT_TRUE(found) << entry.path() << ": " << line << "\n" << all;
    }
    EXPECT_EQ(r.problems.size(), expected) << entry.path();
  }
  EXPECT_GE(files, 5);
}

// Bytes changed, dropped and doubled at places that a counter picks: read or refused with a reason, no third.
TEST(ScenarioReader, DamagedFilesAreReadOrRefusedWithAReason) {
  constexpr std::string_view kBytes = "[]{}=\"\n.#0-9eE'x\\ ";
  int refused = 0;
  for (std::uint64_t n = 0; n < 2000; ++n) {
    std::string text(kGood);
    for (std::uint64_t k = 0; k < 3; ++k) {
      const std::uint64_t bits = random_bits(1, n, k);
      const std::size_t at = bits % text.size();
      const char byte = kBytes[(bits >> 20) % kBytes.size()];
      if ((bits >> 40) % 3 == 0) text[at] = byte;
      if ((bits >> 40) % 3 == 1) text.erase(at, 1 + (bits >> 44) % 9);
      if ((bits >> 40) % 3 == 2) text.insert(at, text.substr(at, 1 + (bits >> 44) % 40));
    }
    const ScenarioReading r = read_scenario(text, "damaged.toml");
    EXPECT_NE(r.scenario.has_value(), !r.problems.empty()) << text;
    refused += r.scenario ? 0 : 1;
  }
  EXPECT_GT(refused, 1000);
}

TEST(ScenarioReader, ShippedSuiteReadsAndShowsEveryStepAndCheck) {
  const SuiteReading suite = read_suite({kSuite.string()}, "");
  for (const std::string& problem : suite.problems) ADD_FAILURE() << problem;
  for (const StepRow& row : step_rows()) {
    // What needs a firmware with variables of its own or an emulated chip is in chip_faults_test.cc, program_test.cc and
    // tests/hil/variables.
    if (row.kind == StepKind::kSet || row.kind == StepKind::kType || row.kind == StepKind::kChip) continue;
    EXPECT_TRUE(std::ranges::any_of(suite.scenarios, [&](const Scenario& s) {
      return std::ranges::find(s.steps, row.kind, &ScenarioStep::kind) != s.steps.end();
    })) << row.word;
  }
  for (const CheckRow& row : check_rows()) {
    if (row.kind == CheckKind::kStopsSafely || of_console(row.kind)) continue;  // go with those
    EXPECT_TRUE(std::ranges::any_of(suite.scenarios, [&](const Scenario& s) {
      return std::ranges::find(s.checks, row.kind, &ScenarioCheck::kind) != s.checks.end();
    })) << row.word;
  }
}

TEST(ScenarioFault, IsOneStepThatLasts) {
  std::vector<std::string> problems;
  const auto step =
      read_fault(" at_s = 1.5, for_s = 0.25, do = \"wheel_blocked\", wheels = [0, 2]", problems);
  ASSERT_TRUE(step) << problems.at(0);
  EXPECT_EQ(step->at_s, 1.5);
  EXPECT_EQ(step->until_s, 1.75);
  EXPECT_EQ(faults_of(*step).blocked, (PerWheel<bool>{true, false, true}));
  const auto forever = read_fault("at_s = 0, do = \"brown_out\", supply_ratio = 0.5", problems);
  ASSERT_TRUE(forever) << problems.at(0);
  EXPECT_TRUE(std::isinf(forever->until_s));
  EXPECT_EQ(faults_of(*forever).supply_ratio, 0.5);
  for (const char* wrong :
       {"", "at_s = 1.0", "at_s = 1.0, do = \"ball\"", "at_s = 1.0, do = \"wheel_blokked\", wheels = [0]",
        "at_s = 1.0, do = \"disturb\", push = 3",
        "at_s = 1.0, do = \"disturb\" }, { at_s = 2.0, do = \"disturb\"", "at_s = 1.0,\ndo = \"disturb\"",
        "at_s = ", "at_s = 1.0, do = \"disturb\"}]\n#"}) {
    problems.clear();
    EXPECT_FALSE(read_fault(wrong, problems)) << wrong;
    EXPECT_FALSE(problems.empty()) << wrong;
  }
  problems.clear();
  read_fault("at_s = 1.0, do = \"wheel_blokked\", wheels = [0]", problems);
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_EQ(problems[0].find("do = \"wheel_blokked\""), 0U) << problems[0];
}

TEST(ScenarioReader, ReadsWhatAConsoleIsToSay) {
  const std::string says =
      std::string(kGood) +
      "[[check]]\nis = \"console_says\"\ntext = \"ready\"\nport = \"RTT\"\nboard = 1\nfrom_s = 0.5\n";
  const ScenarioReading r = read_scenario(says, "s.toml");
  ASSERT_TRUE(r.scenario) << r.problems.front().text();
  const ScenarioCheck& c = r.scenario->checks.back();
  EXPECT_EQ(c.text, "ready");
  EXPECT_EQ(c.port, "RTT");
  EXPECT_EQ(c.board, 1);
  EXPECT_FALSE(c.at_most);
  EXPECT_EQ(c.from_s, 0.5);
  EXPECT_EQ(c.to_s, 2.0);
  const std::pair<const char*, const char*> kWrong[] = {
      {"is = \"console_says\"\n", "text"},
      {"is = \"console_says\"\ntext = \"\"\n", "is empty"},
      {"is = \"console_never_says\"\ntext = \"x\"\nat_most_s = 1.0\n", "at_most_s"},
      {"is = \"console_never_says\"\ntext = \"x\"\nwheels = [0]\n", "wheels"},
      {"is = \"console_says\"\ntext = \"x\"\nboard = 4\n", "0 to 3"},
      {"is = \"rise_time\"\nat_most_s = 1.0\ntext = \"x\"\n", "text"}};
  for (const auto& [check, what] : kWrong) {
    const ScenarioReading wrong = read_scenario(std::string(kGood) + "[[check]]\n" + check, "s.toml");
    ASSERT_EQ(wrong.problems.size(), 1u) << check;
    EXPECT_NE(wrong.problems[0].text().find(what), std::string::npos) << wrong.problems[0].text();
  }
}

}  // namespace
}  // namespace omnihil
