// `serve --bench FILE`: the same bench as by its options, and every fault of the file named.
#include <gtest/gtest.h>

#include "tests/hil/recording/fake_run.h"
#include "tests/tools/cli.h"

namespace omnihil {
namespace {

class BenchFile : public CliTest {
 protected:
  Ran serve(const std::string& text, const std::string& more = "") {
    fake::write_text(folder_ / "bench.toml", text);
    return run_omnihil("serve --bench" + shell(folder_ / "bench.toml") + "--device" +
                       shell(folder_ / "dongle") + more);
  }
  fake::TempFolder folder_;
};

constexpr const char* kGood =
    "format = \"omnihil-bench/1\"\nrobot = \"ulaval_delta\"\nrobots = \"0,3\"\nteam = \"yellow\"\nphysics = "
    "\"planar\"\n"
    "clock = \"free\"\nduration = 0.05\nseed = 7\nwith = [\"battery_sag\", \"floor_tilt\"]\n[air]\nloss = "
    "2.5\n";

TEST_F(BenchFile, SaysWhatTheOptionsSay) {
  const Ran ran = serve(kGood, "--record" + shell(folder_ / "a.omnirec"));
  EXPECT_EQ(ran.exit_code, 0) << ran.text;
  EXPECT_TRUE(ran.says("robots 0 3 of model ulaval_delta, team yellow, planar, free-running")) << ran.text;
  const std::string header = text_of(folder_ / "a.omnirec").substr(0, 20'000);
  EXPECT_NE(header.find("\"seed\":7"), std::string::npos);
  EXPECT_NE(header.find("\"air\":{\"share\":0.025}"), std::string::npos);
  EXPECT_NE(header.find("[effects.battery_sag]"), std::string::npos);
  EXPECT_NE(header.find("[effects.floor_tilt]"), std::string::npos);
  const Ran other = run_omnihil(
      "serve --robot ulaval_delta --robots 0,3 --team yellow --physics planar --clock free --duration 0.05 "
      "--seed 7 --with "
      "battery_sag --with floor_tilt --air-loss 2.5 --device" +
      shell(folder_ / "dongle") + "--record" + shell(folder_ / "b.omnirec"));
  EXPECT_EQ(other.exit_code, 0) << other.text;
  EXPECT_EQ(run_omnihil("replay --sha256" + shell(folder_ / "a.omnirec")).text,
            run_omnihil("replay --sha256" + shell(folder_ / "b.omnirec")).text);
}

TEST_F(BenchFile, TheCommandLineWins) {
  const Ran ran = serve(kGood, "--robots 5 --quiet");
  EXPECT_EQ(ran.exit_code, 0) << ran.text;
  EXPECT_TRUE(ran.says("robots 5 of model ulaval_delta")) << ran.text;
}

TEST_F(BenchFile, FilesAreLookedForBesideIt) {
  std::filesystem::copy_file(OMNIHIL_SOURCE_DIR "/examples/radio/our_team.toml", folder_ / "ours.toml");
  const Ran ran = serve(
      "format = \"omnihil-bench/1\"\nradio_file = \"ours.toml\"\nclock = \"free\"\nduration = 0.01\nrobots = "
      "\"0\"\n");
  EXPECT_EQ(ran.exit_code, 0) << ran.text;
}

TEST_F(BenchFile, FaultsAreNamedWithTheirLine) {
  const Ran ran = serve("format = \"omnihil-bench/1\"\nrobotts = \"0\"\nquiet = 3\n[air]\nlos = 2\n");
  EXPECT_EQ(ran.exit_code, 2);
  EXPECT_TRUE(ran.says("bench.toml:2:1: ") &&
              ran.says("\"robotts\" is no option of serve; did you mean \"robots\"?"))
      << ran.text;
  EXPECT_TRUE(ran.says("bench.toml:3:9: quiet = 3: is a flag")) << ran.text;
  EXPECT_TRUE(ran.says("bench.toml:5:1: ") && ran.says("\"los\"")) << ran.text;
  EXPECT_EQ(serve("robots = \"0\"\n").exit_code, 2);  // no format
  EXPECT_EQ(serve("format = \"omnihil-bench/9\"\n").exit_code, 2);
  EXPECT_EQ(serve("format = [\n").exit_code, 2);  // no TOML
  EXPECT_EQ(serve("format = \"omnihil-bench/1\"\nduration = \"long\"\n").exit_code,
            2);  // as on the command line
  EXPECT_EQ(run_omnihil("serve --bench /nonexistent/b.toml").exit_code, 2);
}

}  // namespace
}  // namespace omnihil
