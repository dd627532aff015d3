// Every file of tests/sim/model/bad_models is refused with exactly the problems that its own "# expect" lines
// name:  # expect [FILE:]LINE:COLUMN KEY | words of the message
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>

#include "hil/loop/model_store.h"

namespace omnihil {
namespace {

namespace fs = std::filesystem;

const fs::path kFolder = fs::path(OMNIHIL_SOURCE_DIR) / "tests/sim/model/bad_models";

std::vector<std::string> bad_models() {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(kFolder)) {
    if (entry.path().extension() == ".toml") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

struct Expected {
  std::string place, key, words;
};

std::vector<Expected> expectations(const std::string& text) {
  const std::regex form(R"(# expect (\S+:\d+) (\S*) ?\| (.+))");
  std::vector<Expected> all;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::smatch match;
    if (std::regex_match(line, match, form)) all.push_back({match[1], match[2], match[3]});
  }
  return all;
}

class BadModel : public ::testing::TestWithParam<std::string> {};

TEST_P(BadModel, IsRefusedWithAllItsProblemsAndTheirPlaces) {
  const fs::path path = kFolder / (GetParam() + ".toml");
  const StoredModel read = load_model(path.string(), {});
  EXPECT_FALSE(read.model.has_value());
  const std::vector<Expected> expected = expectations(read.bundle.robot_text);
  ASSERT_FALSE(expected.empty()) << "the file names no problem";
  std::string all;
  for (const ModelProblem& p : read.problems) all += p.text() + "\n";
  ASSERT_EQ(read.problems.size(), expected.size()) << all;
  for (std::size_t n = 0; n < expected.size(); ++n) {
    const ModelProblem& p = read.problems[n];
    std::string place = std::to_string(p.line) + ":" + std::to_string(p.column);
    if (p.file != path.string()) place = fs::relative(p.file, kFolder).string() + ":" + place;
    EXPECT_EQ(place, expected[n].place) << p.text();
    EXPECT_EQ(p.key, expected[n].key) << p.text();
    EXPECT_NE((p.what + "; " + p.allowed).find(expected[n].words), std::string::npos) << p.text();
    EXPECT_EQ(p.text().rfind(p.file + ":", 0), 0u);
  }
}

INSTANTIATE_TEST_SUITE_P(Corpus, BadModel, ::testing::ValuesIn(bad_models()),
                         [](const auto& test) { return test.param; });

TEST(BadModelCorpus, HasAtLeastTwentyFiveFiles) { EXPECT_GE(bad_models().size(), 25u); }

TEST(BadModelFile, ThatDoesNotExistIsNamed) {
  const StoredModel read = load_model("no/such/robot.toml", {});
  ASSERT_EQ(read.problems.size(), 1u);
  EXPECT_EQ(read.problems[0].text(), "no/such/robot.toml: no such file");
}

TEST(BadModelFile, ThatIsAFolderIsNamed) {
  const StoredModel read = load_model(kFolder.string() + "/", {});
  ASSERT_EQ(read.problems.size(), 1u);
  EXPECT_NE(read.problems[0].text().find("is a folder"), std::string::npos);
}

TEST(BadModelFile, EmptyTextLacksFormatAndRig) {
  const ModelReading read = read_model("", "nothing.toml", nullptr);
  ASSERT_EQ(read.problems.size(), 2u);
  EXPECT_EQ(read.problems[0].key, "format");
  EXPECT_EQ(read.problems[1].key, "rig");
}

// Any prefix of a good file is read or refused, never worse.
TEST(BadModelFile, CutAnywhereIsRefusedOrRead) {
  const StoredModel good = load_model("omni_default", {OMNIHIL_SOURCE_DIR "/models"});
  ASSERT_TRUE(good.model.has_value());
  const auto motor = [&](const std::string&) { return MotorFileText{"motor", good.bundle.motor_text, ""}; };
  int read_whole = 0;
  for (std::size_t n = 0; n < good.bundle.robot_text.size(); n += 7) {
    const ModelReading read = read_model(std::string_view(good.bundle.robot_text).substr(0, n), "cut", motor);
    EXPECT_NE(read.model.has_value(), !read.problems.empty());
    read_whole += read.model.has_value() ? 1 : 0;
  }
  EXPECT_GT(read_whole, 0);  // optional sections stand last
}

TEST(NearestSpelling, FindsTheClosestAndOnlyIfClose) {
  constexpr std::string_view kWords[] = {"resistance_ohm", "inductance_H", "slots"};
  EXPECT_EQ(nearest_spelling("resistence_ohm", kWords), "resistance_ohm");
  EXPECT_EQ(nearest_spelling("inductance_h", kWords), "inductance_H");
  EXPECT_EQ(nearest_spelling("slot", kWords), "slots");
  EXPECT_EQ(nearest_spelling("colour", kWords), "");
}

}  // namespace
}  // namespace omnihil
