#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/tools/cli.h"

namespace omnihil {
namespace {

namespace fs = std::filesystem;

class CompareVerb : public CliTest {
 protected:
  static fs::path corpus(const char* name) {
    return fs::path(OMNIHIL_SOURCE_DIR) / "tests/data/broken" / name;
  }
  Ran compare(const std::string& more) {
    return run_omnihil("compare" + shell(corpus("sound_drive")) + more);
  }
};

TEST_F(CompareVerb, PrintsErrorsPerSignalAndUse) {
  const Ran ran = compare("");
  EXPECT_EQ(ran.exit_code, 0) << ran.text;
  for (const char* word : {"RMSE", "% of std", "bias", "noise", "velocity", "motor_current", "holdout"}) {
    EXPECT_TRUE(ran.says(word)) << word << "\n" << ran.text;
  }
}

TEST_F(CompareVerb, ATubeIsAVerdictForScripts) {
  EXPECT_EQ(compare("--tube velocity=3").exit_code, 0);
  const Ran narrow = compare("--tube velocity=0.2 --tube motor_current=1");
  EXPECT_EQ(narrow.exit_code, 1) << narrow.text;
  EXPECT_TRUE(narrow.says("samples outside, the first in fit.csv")) << narrow.text;
  EXPECT_TRUE(narrow.says("tube motor_current +- 1: all")) << narrow.text;
}

TEST_F(CompareVerb, ATubeOfAnUnknownSignalIsRefused) {
  const Ran ran = compare("--tube velocty=3 --tube velocity=wide");
  EXPECT_EQ(ran.exit_code, 2) << ran.text;
  EXPECT_TRUE(ran.says("did you mean \"velocity\"?")) << ran.text;
  EXPECT_TRUE(ran.says("--tube velocity=wide: write SIGNAL=TOLERANCE")) << ran.text;
}

TEST_F(CompareVerb, JsonHoldsWhatTheTableSays) {
  const Ran ran = compare("--json - --tube velocity=3");
  ASSERT_EQ(ran.exit_code, 0) << ran.text;
  const nlohmann::json j = nlohmann::json::parse(ran.text);
  EXPECT_EQ(j["format"], "omnihil-comparison/1");
  EXPECT_GT(j["fit"]["velocity"]["rmse"].get<double>(), 0.0);
  EXPECT_EQ(j["fit"]["velocity"]["unit"], "rad/s");
  EXPECT_EQ(j["tubes"][0]["outside"], 0);
  EXPECT_EQ(j["runs"].size(), 2u * 3u);  // two runs, three signals
}

TEST_F(CompareVerb, AnotherModelCanBeHeldAgainstTheData) {
  const fs::path model = fs::temp_directory_path() / "omnihil-compare-other.toml";
  std::ifstream in(corpus("sound_drive") / "model.toml");
  std::string text((std::istreambuf_iterator<char>(in)), {});
  text.replace(text.find("0.03,"), 5, "0.04,");  // torque constant
  std::ofstream(model) << text;
  const Ran own = compare("--json -"), other = compare("--json - --model" + shell(model));
  fs::remove(model);
  ASSERT_EQ(other.exit_code, 0) << other.text;
  const auto rmse = [](const Ran& ran) {
    return nlohmann::json::parse(ran.text)["fit"]["velocity"]["rmse"].get<double>();
  };
  EXPECT_GT(rmse(other), 10.0 * rmse(own));
}

}  // namespace
}  // namespace omnihil
