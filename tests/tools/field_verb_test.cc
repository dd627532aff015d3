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
