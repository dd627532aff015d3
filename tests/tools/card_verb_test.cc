// `omnihil card` and `omnihil models --export`: what they write and their exit codes.
#include <filesystem>
#include <fstream>

#include "tests/tools/cli.h"

namespace omnihil {
namespace {

namespace fs = std::filesystem;

class CardVerb : public CliTest {
 protected:
  void SetUp() override {
    CliTest::SetUp();
    folder_ = fs::temp_directory_path() / (std::string("omnihil-card-verb-") +
                                           ::testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    fs::copy(fs::path(OMNIHIL_SOURCE_DIR) / "tests/data/broken/sound_drive", folder_ / "bench");
    model_ = folder_ / "bench/model.toml";
  }
  void TearDown() override { fs::remove_all(folder_); }
  Ran card(const std::string& more = "") const {
    return run_omnihil("card" + shell(model_) + "--no-evidence --data" + shell(folder_ / "bench") + more);
  }
  fs::path folder_, model_;
};

TEST_F(CardVerb, WritesPageAndJsonBesideTheModel) {
  const Ran ran = card();
  EXPECT_EQ(ran.exit_code, 0) << ran.text;
  EXPECT_TRUE(ran.says("licence not stated")) << ran.text;
  EXPECT_TRUE(fs::exists(folder_ / "bench/model.card.html"));
  EXPECT_TRUE(fs::exists(folder_ / "bench/model.card.json"));
}

TEST_F(CardVerb, CheckSaysWhenTheModelWasEditedSince) {
  ASSERT_EQ(card().exit_code, 0);
  EXPECT_EQ(run_omnihil("models --check" + shell(model_)).exit_code, 0);
  std::ofstream(model_, std::ios::app) << "# edited\n";
  const Ran ran = run_omnihil("models --check" + shell(model_));
  EXPECT_EQ(ran.exit_code, 1) << ran.text;
  EXPECT_TRUE(ran.says("stale card: ")) << ran.text;
  EXPECT_TRUE(ran.says("was edited since its card model.card.json")) << ran.text;
}

TEST_F(CardVerb, AGalleryNeedsCardsAndAPlaceForItsPage) {
  EXPECT_EQ(run_omnihil("card --gallery" + shell(folder_)).exit_code, 2);
  EXPECT_EQ(run_omnihil("card --gallery" + shell(folder_) + "--out" + shell(folder_ / "g.html")).exit_code,
            2);
  ASSERT_EQ(card().exit_code, 0);
  const Ran ran = run_omnihil("card --gallery" + shell(folder_) + "--out" + shell(folder_ / "g.html"));
  EXPECT_EQ(ran.exit_code, 0) << ran.text;
  EXPECT_NE(text_of(folder_ / "g.html").find("bench/model.card.html"), std::string::npos);
}

TEST_F(CardVerb, FaultyInputLeavesNoFile) {
  EXPECT_EQ(card("--axes speed").exit_code, 2);
  const Ran axes = card("--axes speed,luck");
  EXPECT_EQ(axes.exit_code, 2) << axes.text;
  EXPECT_TRUE(axes.says("--axes luck: these data have no such axis; allowed: ")) << axes.text;
  std::ofstream(model_, std::ios::app) << "\n[motor2]\nx = 1\n";
  const Ran ran = card();
  EXPECT_EQ(ran.exit_code, 2) << ran.text;
  EXPECT_TRUE(ran.says("motor2")) << ran.text;
  EXPECT_FALSE(fs::exists(folder_ / "bench/model.card.html"));
  EXPECT_FALSE(fs::exists(folder_ / "bench/model.card.json"));
}

TEST_F(CardVerb, ExportsSayWhatDoesNotSurvive) {
  const fs::path out = folder_ / "robot.xml";
  const Ran ran = run_omnihil("models omni_default --export mjcf --out" + shell(out));
  EXPECT_EQ(ran.exit_code, 0) << ran.text;
  EXPECT_TRUE(ran.says("does not survive: ")) << ran.text;
  EXPECT_NE(text_of(out).find("<mujoco model=\"omni_default\">"), std::string::npos);
  EXPECT_EQ(run_omnihil("models" + shell(model_) + "--export urdf").exit_code, 2);  // an axis
  EXPECT_EQ(run_omnihil("models omni_default --export fmu").exit_code, 2);
  EXPECT_EQ(run_omnihil("models omni_default --out" + shell(out)).exit_code, 2);
}

}  // namespace
}  // namespace omnihil
