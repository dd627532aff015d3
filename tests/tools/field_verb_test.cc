// omnihil field, and the field in serve and replay, as a user runs them.
#include <fstream>

#include "tests/hil/recording/fake_run.h"
#include "tests/tools/cli.h"

namespace omnihil {
namespace {

class FieldVerb : public CliTest {
 protected:
  std::string in_folder(const char* name) { return std::string(work_ / name); }
  fake::TempFolder work_;
};

TEST_F(FieldVerb, ToursTheSeedPaper) {
  const Ran ran = run_omnihil("field seed");
  EXPECT_EQ(ran.exit_code, 0) << ran.text;
  for (const char* what : {"field and ball", "direct kick", "V(24) = 10.12 m/s", "chip kick", "dribbler"})
    EXPECT_TRUE(ran.says(what)) << what << "\n" << ran.text;
  EXPECT_EQ(run_omnihil("field seed --robot nobody").exit_code, 2);
}

TEST_F(FieldVerb, FitsATeamsOwnTableOfKicks) {
  const std::string table = in_folder("kicks.csv");
  std::ofstream out(table);
  out << "k,speed_m_s\n";
  for (int k = 2; k <= 24; k += 2)
    out << k << "," << -0.0001 * k * k * k + 0.0213 * k * k - 0.0315 * k - 0.0098 << "\n";
  out.close();
  const Ran ran = run_omnihil("field kick '" + table + "'");
  EXPECT_EQ(ran.exit_code, 0) << ran.text;
  for (const char* what : {"12 points", "[kicker]", "c3_m_s = -0.0001", "c2_m_s = 0.0213", "k_most = 24"})
    EXPECT_TRUE(ran.says(what)) << what << "\n" << ran.text;
  const Ran wrong = run_omnihil("field chip '" + table + "'");
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_TRUE(wrong.says("y_m")) << wrong.text;
}

// The network that is trained on a table kicks in a model file as it did when it was trained.
TEST_F(FieldVerb, ATrainedChipGoesIntoAModelFile) {
  const std::string table = in_folder("chips2.csv");
  {
    std::ofstream out(table);
    out << "k,y_m,speed_m_s,angle_deg\n";
    for (int k = 2; k <= 10; ++k)
      for (int y = -3; y <= 3; ++y)
        out << k << ',' << 0.01 * y << ',' << 0.4 * k * (1.0 - 20.0 * 1e-4 * y * y) << ',' << 50.0 - k
            << '\n';
  }
  const Ran trained = run_omnihil("field chip '" + table + "'");
  ASSERT_EQ(trained.exit_code, 0) << trained.text;
  const std::size_t row = trained.text.find("chip_network = ");
  ASSERT_NE(row, std::string::npos) << trained.text;
  const std::string model = text_of(OMNIHIL_SOURCE_DIR "/models/robots/omni_default.toml");
  std::filesystem::create_directory(in_folder("robots"));
  const std::string file = in_folder("robots/mine.toml"), bad = in_folder("robots/bad.toml");
  std::filesystem::copy(OMNIHIL_SOURCE_DIR "/models/motors", in_folder("motors"));
  std::ofstream(file) << model << "\n[kicker]\n"
                      << trained.text.substr(row, trained.text.find('\n', row) - row) << '\n';
  std::ofstream(bad) << model << "\n[kicker]\nchip_network = \"1 2 3\"\n";
  const Ran seed = run_omnihil("field seed --robot '" + file + "'");
  EXPECT_EQ(seed.exit_code, 0) << seed.text;
  EXPECT_TRUE(seed.says("k = 6, ball in the middle: 2.4")) << seed.text;
  EXPECT_TRUE(seed.says("at 44.")) << seed.text;
  const Ran refused = run_omnihil("models --check '" + bad + "'");
  EXPECT_EQ(refused.exit_code, 2) << refused.text;
  EXPECT_TRUE(refused.says("chip_network")) << refused.text;
}

TEST_F(FieldVerb, ServeWithAFieldIsRecordedReplayedAndDrawn) {
  const std::string record = in_folder("m.omnirec"), picture = in_folder("m.svg");
  const Ran served = run_omnihil(
      "serve --robots 0-1 --opponents 3 --field division-b --ball 0.5,0.1 --physics planar "
      "--clock free --duration 0.2 --quiet --device '" +
      in_folder("dongle") + "' --opponents-device '" + in_folder("other") + "' --record '" + record + "'");
  EXPECT_EQ(served.exit_code, 0) << served.text;
  EXPECT_TRUE(served.says("opponents 3 at device")) << served.text;
  EXPECT_EQ(run_omnihil("check --exact '" + record + "'").exit_code, 0);
  EXPECT_EQ(run_omnihil("replay '" + record + "' --picture '" + picture + "'").exit_code, 0);
  std::ifstream in(picture);
  std::string first;
  std::getline(in, first);
  EXPECT_TRUE(first.starts_with("<svg ")) << first;
  const std::string page = in_folder("m.html");
  EXPECT_EQ(run_omnihil("replay '" + record + "' --picture '" + page + "'").exit_code, 0);
  EXPECT_NE(text_of(page).find("<th>what</th>"), std::string::npos);
  EXPECT_NE(text_of(page).find("<svg "), std::string::npos);
  const Ran other = run_omnihil("replay '" + record + "' --picture '" + in_folder("m.jpg") + "'");
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_TRUE(other.says("allowed: a file that ends in .svg, .png or .html")) << other.text;
}

TEST_F(FieldVerb, APngIsDrawnByRsvgConvertAndItsLackIsSaid) {
  const std::string record = in_folder("p.omnirec"), picture = in_folder("p.png");
  ASSERT_EQ(
      run_omnihil(
          "serve --robots 0 --ball 0.5,0.1 --physics planar --clock free --duration 0.1 --quiet --device '" +
          in_folder("dongle") + "' --record '" + record + "'")
          .exit_code,
      0);
  const Ran drawn = run_omnihil("replay '" + record + "' --picture '" + picture + "'");
  if (std::system("command -v rsvg-convert > /dev/null") != 0) {
    EXPECT_NE(drawn.exit_code, 0);
    EXPECT_TRUE(drawn.says("librsvg2-bin")) << drawn.text;
    EXPECT_FALSE(std::filesystem::exists(picture));
    GTEST_SKIP() << "rsvg-convert is not installed";
  }
  ASSERT_EQ(drawn.exit_code, 0) << drawn.text;
  // PNG's signature, and its width in the header chunk (ISO/IEC 15948, 5.2, 11.2.2).
  const std::string png = text_of(picture);
  EXPECT_EQ(png.substr(0, 8), "\x89PNG\r\n\x1a\n");
  EXPECT_EQ(static_cast<unsigned char>(png[18]) * 256 + static_cast<unsigned char>(png[19]), 900);
  EXPECT_FALSE(std::filesystem::exists(picture + ".svg"));
}

TEST_F(FieldVerb, WhatCannotBeIsNamed) {
  const Ran ran =
      run_omnihil("serve --ball here --ghosts --field division-b --opponents-device ./x --duration 1");
  EXPECT_EQ(ran.exit_code, 2);
  for (const char* what : {"--ball: found \"here\"", "--ghosts", "--opponents-device: needs --opponents"})
    EXPECT_TRUE(ran.says(what)) << what << "\n" << ran.text;
}

}  // namespace
}  // namespace omnihil
