// Manual pages and shell completion say what `--help` says.
#include <algorithm>
#include <fstream>
#include <regex>
#include <sstream>
#include <vector>

#include "tests/tools/cli.h"

namespace omnihil {
namespace {

namespace fs = std::filesystem;

std::string text_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

// The rows of `--help` from the line `title` to the next empty one: names and values, without the descriptions, which
// begin at column 30, on the next line where a name is too long.
std::vector<std::string> help_rows(const std::string& help, const std::string& title) {
  constexpr std::size_t kColumn = 30;
  std::vector<std::string> rows;
  std::istringstream lines(help);
  bool inside = false;
  for (std::string line; std::getline(lines, line);) {
    if (line.empty()) inside = false;
    const bool description = line.starts_with(std::string(kColumn, ' '));  // of the row before
    if (inside && !description) {
      const bool alone = lines.peek() == ' ' && help.compare(static_cast<std::size_t>(lines.tellg()), kColumn,
                                                             std::string(kColumn, ' ')) == 0;
      const std::string row = alone ? line : line.substr(0, kColumn);
      rows.push_back(row.substr(2, row.find_last_not_of(' ') - 1));
    }
    inside = inside || line == title;
  }
  return rows;
}

// The rows of a page below a heading (".SH OPTIONS", ".SS OPTIONS"), the first time after `from`.
// What roff makes of "\-" and of "\:", where a line may break.
std::string unescaped(const std::string& line) {
  return std::regex_replace(std::regex_replace(line, std::regex("\\\\-"), "-"), std::regex("\\\\:"), "");
}

std::vector<std::string> page_rows(const std::string& page, const std::string& heading,
                                   std::size_t from = 0) {
  std::vector<std::string> rows;
  const std::size_t at = page.find(heading + "\n", from);
  if (at == std::string::npos) return rows;
  std::istringstream lines(page.substr(at));
  std::string line;
  std::getline(lines, line);
  while (std::getline(lines, line) && !line.starts_with(".SH") && !line.starts_with(".SS")) {
    if (line.starts_with(".B ")) rows.push_back(unescaped(line.substr(3)));
  }
  return rows;
}

std::vector<std::string> names_of(const std::vector<std::string>& rows) {
  std::vector<std::string> names;
  for (const std::string& row : rows) names.push_back(row.substr(0, row.find(' ')));
  return names;
}

class ManualTest : public CliTest {
 protected:
  void SetUp() override {
    CliTest::SetUp();
    if (IsSkipped()) return;
    std::string pattern = (fs::temp_directory_path() / "omnihil-manual-XXXXXX").string();
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    folder_ = pattern;
    const Ran ran = run_omnihil("manual" + shell(folder_));
    ASSERT_EQ(ran.exit_code, 0) << ran.text;
    verbs_ = names_of(help_rows(run_omnihil("--help").text, "Subcommands:"));
    ASSERT_FALSE(verbs_.empty());
  }
  void TearDown() override {
    if (!folder_.empty()) fs::remove_all(folder_);
  }

  std::string page(const std::string& verb) const {
    return text_of(folder_ / "share/man/man1" / ("omnihil" + (verb.empty() ? "" : "-" + verb) + ".1"));
  }
  // What bash offers for the last of `words`.
  std::string completed(const std::string& words) const {
    const std::string script = "source '" + (folder_ / "share/bash-completion/completions/omnihil").string() +
                               "'; COMP_WORDS=(" + words +
                               "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _omnihil; echo \"${COMPREPLY[*]}\"";
    std::ofstream(folder_ / "script") << script;
    std::string text;
    std::FILE* pipe = ::popen(("bash '" + (folder_ / "script").string() + "' 2>&1").c_str(), "r");
    if (pipe == nullptr) return "no bash";
    char buffer[4096];
    for (std::size_t n; (n = std::fread(buffer, 1, sizeof buffer, pipe)) > 0;) text.append(buffer, n);
    ::pclose(pipe);
    return text.substr(0, text.find('\n'));
  }

  fs::path folder_;
  std::vector<std::string> verbs_;
};

TEST_F(ManualTest, EveryVerbHasAPageAndThereIsNoOther) {
  std::vector<std::string> pages, expected = {"omnihil.1"};
  for (const auto& entry : fs::directory_iterator(folder_ / "share/man/man1")) {
    pages.push_back(entry.path().filename().string());
  }
  for (const std::string& verb : verbs_) expected.push_back("omnihil-" + verb + ".1");
  std::sort(pages.begin(), pages.end());
  std::sort(expected.begin(), expected.end());
  EXPECT_EQ(pages, expected);
}

TEST_F(ManualTest, EachPageListsTheOptionsAndArgumentsOfHelp) {
  for (const std::string& verb : verbs_) {
    const std::string help = run_omnihil(verb + " --help").text;
    EXPECT_EQ(page_rows(page(verb), ".SH OPTIONS"), help_rows(help, "Options:")) << verb;
    EXPECT_EQ(page_rows(page(verb), ".SH ARGUMENTS"), help_rows(help, "Positionals:")) << verb;
    EXPECT_EQ(names_of(page_rows(page(verb), ".SH VERBS")), names_of(help_rows(help, "Subcommands:")))
        << verb;
  }
  EXPECT_EQ(page_rows(page(""), ".SH OPTIONS"), help_rows(run_omnihil("--help").text, "Options:"));
  EXPECT_EQ(page_rows(page(""), ".SH VERBS"), verbs_);
}

TEST_F(ManualTest, AVerbsOwnVerbsAreSectionsOfItsPage) {
  const std::string whole = page("scenario");
  for (const std::string sub : {"run", "fuzz", "list"}) {
    const std::size_t section = whole.find(".SH omnihil scenario " + sub + "\n");
    ASSERT_NE(section, std::string::npos) << sub;
    EXPECT_EQ(page_rows(whole, ".SS OPTIONS", section),
              help_rows(run_omnihil("scenario " + sub + " --help").text, "Options:"));
  }
}

TEST_F(ManualTest, RoffTakesEveryPageWithoutAWarning) {
  if (std::system("command -v groff >/dev/null") != 0) GTEST_SKIP() << "groff is not installed";
  for (const auto& entry : fs::directory_iterator(folder_ / "share/man/man1")) {
    const std::string log = (folder_ / "log").string();
    const std::string command =
        "groff -man -Tutf8 -ww '" + entry.path().string() + "' >/dev/null 2>'" + log + "'";
    EXPECT_EQ(std::system(command.c_str()), 0) << entry.path();
    EXPECT_EQ(text_of(log), "") << entry.path();
  }
}

TEST_F(ManualTest, AFolderThatCannotBeWrittenIsNamed) {
  const Ran ran = run_omnihil("manual /dev/null/here");
  EXPECT_EQ(ran.exit_code, 3);
  EXPECT_TRUE(ran.says("/dev/null/here")) << ran.text;
}

TEST_F(ManualTest, BashCompletesVerbsOptionsAndTheirValues) {
  std::string all;
  for (const std::string& verb : verbs_) all += (all.empty() ? "" : " ") + verb;
  EXPECT_EQ(completed("omnihil ''"), all);
  EXPECT_EQ(completed("omnihil se"), "serve");
  EXPECT_EQ(completed("omnihil serve --tea"), "--team");
  EXPECT_EQ(completed("omnihil serve --robots 0 --team ''"), "blue yellow");
  EXPECT_EQ(completed("omnihil scenario ''"), "run fuzz list");
  EXPECT_EQ(completed("omnihil scenario run --level w"), "wheel");
  EXPECT_EQ(completed("omnihil serve --record x"), "");  // a file: bash's own
}

TEST_F(ManualTest, BashAsksTheProgramForNamesOfModelsFormatsAndEffects) {
  EXPECT_EQ(completed("'" OMNIHIL_PROGRAM "' serve --robot omni_d"), "omni_default");
  EXPECT_EQ(completed("'" OMNIHIL_PROGRAM "' decode ulaval"), "ulaval-hermes");
  EXPECT_EQ(completed("'" OMNIHIL_PROGRAM "' serve --with cogg"), "cogging");
}

}  // namespace
}  // namespace omnihil
