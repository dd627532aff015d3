// `serve --bench FILE`: the same bench as by its options, and every fault of the file named.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

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

constexpr const char* kRobots =
    "format = \"omnihil-bench/1\"\nmodel = \"ulaval_delta\"\nphysics = \"planar\"\nclock = \"free\"\n"
    "duration = 0.3\nball = \"0,2\"\n"
    "[[robot]]\nid = 0\nx_m = 1.0\ny_m = -2.0\nyaw_deg = 90\n"
    "[[robot]]\nid = 3\nmodel = \"roboteam_2024\"\nwith = [\"battery_sag\"]\n"
    "[[robot]]\nid = 1\nteam = \"yellow\"\nwith = \"floor_tilt\"\nx_m = 2\ny_m = 2\n"
    "[[fault]]\nrobots = \"0,3\"\nat_s = 0.1\nfor_s = 0.05\ndo = \"wheel_blocked\"\nwheels = [2]\n"
    "[[fault]]\nrobots = 1\nteam = \"yellow\"\nat_s = 0.2\ndo = \"brown_out\"\nsupply_ratio = 0.5\n";

TEST_F(BenchFile, RobotsThatDifferBothTeamsPlacesAndFaultsAreInTheRecordingWhichReplaysWithoutTheFile) {
  const Ran ran = serve(kRobots, "--sample-every 1 --record" + shell(folder_ / "a.omnirec"));
  ASSERT_EQ(ran.exit_code, 0) << ran.text;
  EXPECT_TRUE(ran.says("robots 0 3 of model ulaval_delta")) << ran.text;
  EXPECT_TRUE(ran.says("opponents 1")) << ran.text;
  const std::string text = text_of(folder_ / "a.omnirec");
  const nlohmann::json header = nlohmann::json::parse(text.substr(2, text.find('\n') - 2));
  ASSERT_EQ(header["other_robots"].size(), 2U);
  EXPECT_EQ(header["other_robots"][0]["robot"], "roboteam_2024");
  EXPECT_NE(header["other_robots"][0]["robot_text"].get<std::string>().find("battery_sag"),
            std::string::npos);
  EXPECT_EQ(header["other_robots"][1]["robot_ids"], nlohmann::json({33}));
  EXPECT_NE(header["other_robots"][1]["robot_text"].get<std::string>().find("floor_tilt"), std::string::npos);
  ASSERT_EQ(header["faults"].size(), 3U);
  EXPECT_EQ(header["faults"][1]["robot"], 3);
  EXPECT_EQ(header["faults"][1]["from_ns"], 100'000'000);
  EXPECT_EQ(header["faults"][1]["until_ns"], 150'000'000);
  EXPECT_EQ(header["faults"][1]["blocked"], nlohmann::json({false, false, true, false}));
  EXPECT_EQ(header["faults"][2]["robot"], 33);
  EXPECT_FALSE(header["faults"][2].contains("until_ns"));
  EXPECT_NE(header["bench"].get<std::string>().find("robot_of = [\"3=roboteam_2024\"]"), std::string::npos);
  EXPECT_NE(text.find("\np 0 0 1 -2 1.5707963"), std::string::npos);  // put there before the first step
  std::filesystem::remove(folder_ / "bench.toml");
  const Ran again = run_omnihil("replay" + shell(folder_ / "a.omnirec"));
  EXPECT_EQ(again.exit_code, 0) << again.text;
  EXPECT_TRUE(again.says("identical")) << again.text;
  EXPECT_EQ(run_omnihil("check --exact --quiet" + shell(folder_ / "a.omnirec")).exit_code, 0);
}

TEST_F(BenchFile, PrintedWithAllItsOptionsItIsTheSameBench) {
  const Ran first = serve(kRobots, "--print-bench");
  ASSERT_EQ(first.exit_code, 0) << first.text;
  EXPECT_TRUE(first.says("robots = \"0,3\"")) << first.text;
  EXPECT_TRUE(first.says("start = [\"0=1,-2,90\", \"opponents:1=2,2,0\"]")) << first.text;
  EXPECT_TRUE(first.says("step = 1\n")) << first.text;  // a default
  const Ran second = serve(first.text, "--print-bench");
  EXPECT_EQ(second.exit_code, 0) << second.text;
  EXPECT_EQ(second.text, first.text);
}

TEST_F(BenchFile, ShippedBenchesRun) {
  for (const auto& entry : std::filesystem::directory_iterator(OMNIHIL_SOURCE_DIR "/examples/bench")) {
    const Ran ran =
        run_omnihil("serve --clock free --duration 0.05 --bench" + shell(entry.path()) + "--device" +
                    shell(folder_ / "dongle") + "--opponents-device" + shell(folder_ / "other"));
    EXPECT_EQ(ran.exit_code, 0) << entry.path() << ran.text;
  }
}

TEST_F(BenchFile, WhatIsWrongWithARobotOrAFaultHasItsLine) {
  const Ran ran = serve(
      "format = \"omnihil-bench/1\"\n[[robot]]\nmodl = \"x\"\n[[robot]]\nid = 1\nx_m = 1\nteam = \"red\"\n"
      "board = \"b.toml\"\n[[fault]]\nrobots = 1\nat_s = 1.0\ndo = \"wheel_blokked\"\n"
      "[[fault]]\nrobots = 1\nat_s = 1.0\ndo = \"ball\"\n");
  EXPECT_EQ(ran.exit_code, 2);
  EXPECT_TRUE(ran.says("bench.toml:3:1: robot[1].modl") && ran.says("did you mean \"model\"?")) << ran.text;
  EXPECT_TRUE(ran.says("bench.toml:2:1: robot[1].id")) << ran.text;
  EXPECT_TRUE(ran.says("bench.toml:7:8: robot[2].team = \"red\"")) << ran.text;
  EXPECT_TRUE(ran.says("robot[2].y_m")) << ran.text;
  EXPECT_TRUE(ran.says("robot[2].firmware")) << ran.text;
  EXPECT_TRUE(ran.says("bench.toml:9:1: fault[1]: do = \"wheel_blokked\"")) << ran.text;
  EXPECT_TRUE(ran.says("bench.toml:13:1: fault[2]: ") && ran.says("is no fault")) << ran.text;
}

TEST_F(BenchFile, ReplayAndScenarioTakeWhatIsTheirs) {
  ASSERT_EQ(serve(kGood, "--record" + shell(folder_ / "a.omnirec")).exit_code, 0);
  // Robots, devices and air are the recording's; what is known of it must still be right.
  const std::string bench = "--bench" + shell(folder_ / "bench.toml");
  EXPECT_EQ(run_omnihil("replay" + shell(folder_ / "a.omnirec") + bench).exit_code, 0);
  EXPECT_EQ(run_omnihil("check --quiet" + shell(folder_ / "a.omnirec") + bench).exit_code, 0);
  fake::write_text(folder_ / "bench.toml", std::string("firmware = \"nowhere.so\"\n") + kGood);
  const Ran missing = run_omnihil("replay" + shell(folder_ / "a.omnirec") + bench);
  EXPECT_EQ(missing.exit_code, 3);
  EXPECT_TRUE(missing.says("nowhere.so")) << missing.text;
  const Ran scenario = run_omnihil("scenario run --level wheel " + bench);
  EXPECT_EQ(scenario.exit_code, 2);
  EXPECT_TRUE(scenario.says("nowhere.so")) << scenario.text;
  fake::write_text(folder_ / "bench.toml", "format = \"omnihil-bench/1\"\nrobotts = 1\n");
  EXPECT_EQ(run_omnihil("replay" + shell(folder_ / "a.omnirec") + bench).exit_code, 2);
}

}  // namespace
}  // namespace omnihil
