#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "hil/text/sha256.h"
#include "tests/tools/cli.h"

extern char** environ;

namespace omnihil {
namespace {

namespace fs = std::filesystem;

// Twelve seconds at a simulated bench with cogging in it, and the model without.
class SlowDiagnoseVerb : public CliTest {
 protected:
  void SetUp() override {
    CliTest::SetUp();
    if (IsSkipped()) return;
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::temp_directory_path() / (std::string("omnihil-diagnose-") + test->name());
    fs::remove_all(folder_);
    const Ran made = run_omnihil(
        "sim maxon_ec45_flat_50w --excite steps prbs --amplitude 0.3 --duration 4 --with "
        "cogging.amplitude_Nm=0.008 --out" +
        shell(folder_));
    ASSERT_EQ(made.exit_code, 0) << made.text;
  }
  void TearDown() override { fs::remove_all(folder_); }
  Ran verb(const std::string& name, const std::string& more) {
    return run_omnihil(name + shell(folder_) + more);
  }

  fs::path folder_;
};

TEST_F(SlowDiagnoseVerb, FromTheVerdictToTheMendedModel) {
  const Ran first = verb("diagnose", "--json" + shell(folder_ / "d.json") + "--report" +
                                         shell(folder_ / "d.html") + "--progress");
  ASSERT_EQ(first.exit_code, 0) << first.text;
  const std::size_t ranked = first.text.find(" %  first ranking: cogging\n");
  ASSERT_NE(ranked, std::string::npos) << first.text;
  EXPECT_LT(first.text.find(" %  refitting the base parameters\n"), ranked) << first.text;
  EXPECT_LT(ranked, first.text.find(" %  last fit\n")) << first.text;
  EXPECT_TRUE(first.says("Verdict: found: cogging")) << first.text;
  const nlohmann::json j = nlohmann::json::parse(text_of(folder_ / "d.json"));
  EXPECT_EQ(j["verdict"], "effect");
  EXPECT_GT(fs::file_size(folder_ / "d.html"), 10000u);
  const std::string before = text_of(folder_ / "model.toml");
  const Ran add = verb("add", "cogging --write" + shell(folder_ / "model.toml"));
  EXPECT_EQ(add.exit_code, 0) << add.text;
  EXPECT_TRUE(add.says("Useful: ")) << add.text;
  EXPECT_EQ(text_of(folder_ / "model.toml.1"), before);
  EXPECT_EQ(verb("add", "cogging").exit_code, 2);  // the model has it already
}

TEST_F(SlowDiagnoseVerb, DataWithAFaultAreSearchedOnlyWhenAskedAndBothAreSaid) {
  std::string toml = text_of(folder_ / "dataset.toml");
  const std::string current = "motor_current = { ";
  ASSERT_NE(toml.find(current), std::string::npos) << toml;
  toml.insert(toml.find(current) + current.size(), "scale = -1.0, ");
  std::ofstream(folder_ / "dataset.toml") << toml;
  const Ran refused = verb("diagnose", "--quick --json" + shell(folder_ / "d.json"));
  EXPECT_EQ(refused.exit_code, 0) << refused.text;
  EXPECT_TRUE(refused.says("Verdict: not searched (a fault of the data would be taken for an effect: "))
      << refused.text;
  EXPECT_TRUE(refused.says("--anyway")) << refused.text;
  EXPECT_FALSE(refused.says("no known effect")) << refused.text;
  const nlohmann::json j = nlohmann::json::parse(text_of(folder_ / "d.json"));
  EXPECT_EQ(j["outcome"], "not searched");
  EXPECT_FALSE(j["not_searched"].get<std::string>().empty());
  const Ran anyway = verb("diagnose", "--quick --anyway --report" + shell(folder_ / "d.html"));
  EXPECT_EQ(anyway.exit_code, 0) << anyway.text;
  EXPECT_TRUE(anyway.says("Searched past a fault of the data")) << anyway.text;
  EXPECT_TRUE(anyway.says("First ranking")) << anyway.text;
  EXPECT_NE(text_of(folder_ / "d.html").find("Searched past a fault of the data"), std::string::npos);
}

// Where a number came from can be read in the file: which data, when, and what was believed before.
TEST_F(SlowDiagnoseVerb, AFittedNumberSaysFromWhichDataAndKeepsItsBelief) {
  const std::string mended = shell(folder_ / "mended.toml");
  ::setenv("SOURCE_DATE_EPOCH", "1795392000", 1);  // 2026-11-23
  const Ran fit = verb("fit", "--freeze motor.inductance_H --write" + mended);
  const Ran add = verb("add", "cogging --model" + mended + "--write" + mended);
  ::unsetenv("SOURCE_DATE_EPOCH");
  ASSERT_EQ(fit.exit_code, 0) << fit.text;
  ASSERT_EQ(add.exit_code, 0) << add.text;
  std::string all = text_of(folder_ / "dataset.toml");
  for (const char* run : {"steps.csv", "steps_holdout.csv", "prbs.csv", "prbs_holdout.csv"})
    all += text_of(folder_ / run);
  Sha256 hash;
  hash.add(all);
  const std::string stamp =
      "source = \"fitted\", data = \"sha256:" + hash.hex().substr(0, 12) + "\", date = \"2026-11-23\"";
  const std::string text = text_of(folder_ / "mended.toml");
  const auto line = [&](const std::string& key) {
    const std::size_t at = text.find("\n" + key + " = ");
    return at == std::string::npos ? "" : text.substr(at + 1, text.find('\n', at + 1) - at - 1);
  };
  for (const char* key : {"resistance_ohm", "inductance_H", "amplitude_Nm", "torque_Nm"})
    EXPECT_NE(line(key).find(stamp), std::string::npos) << key << text;
  EXPECT_NE(line("resistance_ohm").find("believed = { value = 0.447, tolerance = "), std::string::npos)
      << text;
  EXPECT_NE(line("amplitude_Nm").find("believed = { value = 0, sigma = "), std::string::npos) << text;
  EXPECT_EQ(line("pole_pairs"), "pole_pairs = 8");
  EXPECT_EQ(verb("compare", "--model" + mended).exit_code, 0);
  const Ran explained = run_omnihil("models" + mended);
  EXPECT_TRUE(explained.says("fitted to sha256:")) << explained.text;
  EXPECT_TRUE(explained.says("believed 0.447 +-")) << explained.text;
}

TEST_F(SlowDiagnoseVerb, AddRefusesWhatMakesNoDifferenceAndWritesNothing) {
  const std::string before = text_of(folder_ / "model.toml");
  const Ran add = verb("add", "sample_jitter --write" + shell(folder_ / "model.toml"));
  EXPECT_EQ(add.exit_code, 1) << add.text;  // "Not useful": differs from what was hoped
  EXPECT_EQ(text_of(folder_ / "model.toml"), before);
  EXPECT_FALSE(fs::exists(folder_ / "model.toml.1"));
}

TEST_F(SlowDiagnoseVerb, WhatIsNoEffectIsNamedWithANearOne) {
  const Ran add = verb("add", "coging");
  EXPECT_EQ(add.exit_code, 2);
  EXPECT_TRUE(add.says("cogging")) << add.text;
}

// Ctrl-C early: exit code 130, what is known is said, no model is written.
TEST_F(SlowDiagnoseVerb, AnInterruptEndsItWithWhatIsKnown) {
  const fs::path said = folder_ / "said.txt", model = folder_ / "mended.toml";
  std::string data = folder_.string(), write = model.string();
  std::string program = OMNIHIL_PROGRAM, name = "diagnose", option = "--write";
  char* arguments[] = {program.data(), name.data(), data.data(), option.data(), write.data(), nullptr};
  posix_spawn_file_actions_t output;
  posix_spawn_file_actions_init(&output);
  posix_spawn_file_actions_addopen(&output, STDOUT_FILENO, said.c_str(), O_WRONLY | O_CREAT, 0644);
  posix_spawn_file_actions_adddup2(&output, STDOUT_FILENO, STDERR_FILENO);
  pid_t child = -1;
  // no shell between: some catch the signal too
  const int failed = posix_spawn(&child, program.c_str(), &output, nullptr, arguments, environ);
  posix_spawn_file_actions_destroy(&output);
  ASSERT_EQ(failed, 0);
  // the dataset is read once it catches the signal
  for (;;) {
    std::ifstream status("/proc/" + std::to_string(child) + "/status");
    std::string line, caught;
    while (std::getline(status, line)) {
      if (line.starts_with("SigCgt:")) caught = line.substr(7);
    }
    if (!caught.empty() && (std::stoull(caught, nullptr, 16) >> (SIGINT - 1) & 1u) != 0) break;
    ASSERT_EQ(waitpid(child, nullptr, WNOHANG), 0) << text_of(said);
  }
  ::kill(child, SIGINT);
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 130) << text_of(said);
  EXPECT_NE(text_of(said).find("Error, step by step"), std::string::npos) << text_of(said);
  EXPECT_FALSE(fs::exists(model));
}

}  // namespace
}  // namespace omnihil
