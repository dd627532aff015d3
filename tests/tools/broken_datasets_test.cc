// The corpus of broken measurements and models: tests/data/broken/README.md says what is in it.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <string>
#include <vector>

#include "tests/tools/cli.h"

namespace omnihil {
namespace {

namespace fs = std::filesystem;

struct Case {
  fs::path folder;
  std::string outcome;             // "refused", "fault", "accepted"
  std::vector<std::string> words;  // each has to be said
};

std::vector<Case> all_cases() {
  std::vector<Case> cases;
  for (const auto& entry : fs::directory_iterator(fs::path(OMNIHIL_SOURCE_DIR) / "tests/data/broken")) {
    if (!entry.is_directory()) continue;
    Case made{.folder = entry.path(), .outcome = "", .words = {}};
    std::ifstream expect(entry.path() / "expect.txt");
    std::getline(expect, made.outcome);
    for (std::string line; std::getline(expect, line);) made.words.push_back(line);
    cases.push_back(std::move(made));
  }
  std::sort(cases.begin(), cases.end(), [](const Case& a, const Case& b) { return a.folder < b.folder; });
  return cases;
}

class BrokenDatasets : public CliTest {};

TEST_F(BrokenDatasets, AreRefusedOrDiagnosedNeverSilentlyRepaired) {
  for (const Case& c : all_cases()) {
    SCOPED_TRACE(c.folder.filename());
    const Ran ran = run_omnihil("compare" + shell(c.folder));
    EXPECT_EQ(ran.exit_code, c.outcome == "refused" ? 2 : 0) << ran.text;
    EXPECT_EQ(ran.says("data fault:"), c.outcome == "fault") << ran.text;
    for (const std::string& word : c.words)
      EXPECT_TRUE(ran.says(word)) << "not said: " << word << "\n" << ran.text;
  }
}

// What is refused is refused by every verb that reads a measurement, and nothing is written. They share their
// reader: every eighth case will do.
TEST_F(BrokenDatasets, AreRefusedByEveryVerbAlike) {
  int number = 0;
  for (const Case& c : all_cases()) {
    if (c.outcome != "refused" || number++ % 8 != 0) continue;
    SCOPED_TRACE(c.folder.filename());
    const fs::path out =
        fs::temp_directory_path() / ("omnihil-broken-" + c.folder.filename().string() + ".json");
    for (const char* verb : {"diagnose", "fit"}) {
      const Ran ran = run_omnihil(verb + shell(c.folder) + "--json" + shell(out));
      EXPECT_EQ(ran.exit_code, 2) << verb << "\n" << ran.text;
      EXPECT_FALSE(fs::exists(out)) << verb;
      for (const std::string& word : c.words)
        EXPECT_TRUE(ran.says(word)) << verb << " does not say: " << word << "\n" << ran.text;
    }
  }
}

TEST(BrokenDatasetsCorpus, HasAtLeastFortyCasesOfEitherKind) {
  const std::vector<Case> cases = all_cases();
  const auto refused =
      std::count_if(cases.begin(), cases.end(), [](const Case& c) { return c.outcome == "refused"; });
  const auto fault =
      std::count_if(cases.begin(), cases.end(), [](const Case& c) { return c.outcome == "fault"; });
  EXPECT_GE(refused, 40);
  EXPECT_GE(fault, 10);
}

}  // namespace
}  // namespace omnihil
