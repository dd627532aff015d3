// `acquire` drives a bench's robot through its dongle's own packets and makes a measurement of it; it stops whatever happens.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "hil/recording/heard_commands.h"
#include "hil/recording/recording_reader.h"
#include "hil/text/sha256.h"
#include "tests/tools/bench_test.h"

namespace omnihil {
namespace {

constexpr const char* kHead = R"(format = "omnihil-plan/1"
title = "a test"
drive = "body_velocity"
packets_Hz = 50
)";
constexpr const char* kTwoRuns = R"(
[[run]]
name = "one"
use = "fit"
duration_s = 1.5
steps = [[0.0, 0.6, 0, 0], [0.6, -0.3, 0.5, 0], [1.1, 0, 0, 2]]
[[run]]
name = "two"
use = "holdout"
duration_s = 1.2
steps = [[0.0, 0, 0.5, 0], [0.6, 0, -0.5, 1]]
)";
constexpr const char* kLongRun = R"(
[[run]]
name = "one"
use = "fit"
duration_s = 60
steps = [[0.0, 0.5, 0, 0]]
)";

class AcquireVerb : public BenchTest {
 protected:
  void write(const char* name, const std::string& text) { std::ofstream(folder_ / name) << text; }
  // Robot 3 behind `radio`, with vision.
  pid_t bench(const char* radio) {
    vision_ = "224.5.23.2:" + std::to_string(free_udp_port());
    const pid_t child = start({"serve",
                               "--device",
                               at("dongle"),
                               "--robots",
                               "3",
                               "--radio",
                               radio,
                               "--physics",
                               "planar",
                               "--league",
                               "--vision",
                               vision_,
                               "--quiet",
                               "--record",
                               at("bench.omnirec"),
                               "--league-robot-port",
                               std::to_string(free_udp_port()),
                               "--league-control-port",
                               std::to_string(free_udp_port()),
                               "--vision-noise",
                               "1"});
    wait_for_device("dongle");
    return child;
  }
  std::vector<std::string> words(const char* radio, bool vision = true) {
    std::vector<std::string> all{"acquire", at("plan.toml"), "--device", at("dongle"),           "--radio",
                                 radio,     "--robot",       "3",        "--reference-firmware", "--out",
                                 at("out")};
    if (vision) all.insert(all.end(), {"--vision", vision_, "--vision-interface", "127.0.0.1"});
    return all;
  }
  Ran acquire(const char* radio, const char* more = "", bool vision = true) {
    std::string line;
    for (const std::string& word : words(radio, vision)) line += " '" + word + "'";
    return run_omnihil(line + " " + more);
  }
  std::vector<HeardCommand> commands() {
    const Recording recording = load_recording(folder_ / "bench.omnirec");
    return heard_commands(recording, *find_radio_format(recording.header.radio_format));
  }
  static double size_of(const RobotCommand& c) {
    return std::hypot(c.v_forward_m_s, c.v_left_m_s) + std::abs(c.omega_body_rad_s);
  }
  std::string vision_;
};

TEST_F(AcquireVerb, DrivesThePlanAndWritesAMeasurementThatCanBeCompared) {
  write("plan.toml", std::string(kHead) + kTwoRuns);
  const pid_t robot = bench("roboteam-rem-v8");
  const Ran first = acquire("roboteam-rem-v8", "--runs 1");
  ASSERT_EQ(first.exit_code, 0) << first.text;
  EXPECT_TRUE(first.says("--resume goes on with two")) << first.text;
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out"));
  const std::string one = text_of(folder_ / "out.part" / "one.csv");
  EXPECT_EQ(acquire("roboteam-rem-v8").exit_code, 2);  // not by chance over what is there
  const Ran rest = acquire("roboteam-rem-v8", "--resume");
  ASSERT_EQ(rest.exit_code, 0) << rest.text;
  EXPECT_EQ(stop(robot), 0) << said();
  EXPECT_EQ(text_of(folder_ / "out" / "one.csv"), one);  // a finished run stays as it was
  const std::string dataset = text_of(folder_ / "out" / "dataset.toml");
  for (const char* signal :
       {"command_vx", "command_w", "wheel_speed_4", "bus_voltage", "gyro_z", "vision_theta"})
    EXPECT_NE(dataset.find(signal), std::string::npos) << signal;
  Sha256 hash;
  hash.add(text_of(folder_ / "plan.toml"));
  EXPECT_NE(text_of(folder_ / "out" / "README.md").find(hash.hex()), std::string::npos);
  // What the robot was asked: the plan's largest, turned into the field's frame and nothing else.
  double fastest = 0.0;
  const std::vector<HeardCommand> heard = commands();
  for (const HeardCommand& c : heard)
    fastest = std::max(fastest, std::hypot(c.command.v_forward_m_s, c.command.v_left_m_s));
  EXPECT_NEAR(fastest, 0.6, 0.002);  // the packet's steps of 0.5 mm/s
  EXPECT_NEAR(size_of(heard.back().command), 0.0, 1e-3);
  const Ran compare = run_omnihil("compare" + shell(folder_ / "out"));
  EXPECT_EQ(compare.exit_code, 0) << compare.text;
  EXPECT_TRUE(compare.says("vision_x")) << compare.text;
}

TEST_F(AcquireVerb, ASignalStopsTheRobotFirst) {
  write("plan.toml", std::string(kHead) + kLongRun);
  const pid_t robot = bench("ulaval-hermes");
  const pid_t driver = start(words("ulaval-hermes"));
  ASSERT_TRUE(wait_until([&] {
    const std::vector<HeardCommand> so_far = commands();
    return !so_far.empty() && size_of(so_far.back().command) > 0.4;
  })) << said();
  EXPECT_EQ(stop(driver), 130) << said();
  EXPECT_EQ(stop(robot), 0) << said();
  const std::vector<HeardCommand> heard = commands();
  EXPECT_EQ(size_of(heard.back().command), 0.0);
  EXPECT_NE(said().find("stopped by the user"), std::string::npos) << said();
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out"));
}

TEST_F(AcquireVerb, ALimitStopsTheRobotAndNamesItself) {
  write("plan.toml", std::string(kHead) + "[limits]\ntravel_m = 0.2\n" + kLongRun);
  const pid_t robot = bench("ulaval-hermes");
  const Ran ran = acquire("ulaval-hermes");
  EXPECT_EQ(ran.exit_code, 1) << ran.text;
  EXPECT_TRUE(ran.says("from its start, allowed are 0.2 m")) << ran.text;
  EXPECT_EQ(stop(robot), 0) << said();
  const std::vector<HeardCommand> heard = commands();
  EXPECT_EQ(size_of(heard.back().command), 0.0);
}

TEST_F(AcquireVerb, ARobotThatIsNotThereIsNotDriven) {
  write("plan.toml", std::string(kHead) + kLongRun);
  const pid_t robot = bench("ulaval-hermes");
  std::string line;
  for (const std::string& word : words("ulaval-hermes", false))
    line += " '" + (word == "3" ? "4" : word) + "'";
  const Ran ran = run_omnihil(line);
  EXPECT_EQ(ran.exit_code, 1) << ran.text;
  EXPECT_TRUE(ran.says("has not answered at all")) << ran.text;
  EXPECT_EQ(stop(robot), 0);
  for (const HeardCommand& c : commands()) EXPECT_EQ(size_of(c.command), 0.0);
}

TEST_F(AcquireVerb, ADryRunSaysWhatItTakesAndSendsNothing) {
  write("plan.toml", std::string(kHead) + kTwoRuns);
  const Ran ran = run_omnihil("acquire" + shell(folder_ / "plan.toml") + "--radio ulaval-hermes --dry-run");
  EXPECT_EQ(ran.exit_code, 0) << ran.text;
  EXPECT_TRUE(ran.says("x 0.00 to 0.36")) << ran.text;  // 0.6 m/s for 0.6 s
  const Ran duties =
      run_omnihil("acquire" + shell(folder_ / "plan.toml") + "--radio rhoban-master-serial --dry-run");
  EXPECT_EQ(duties.exit_code, 0) << duties.text;
  write("wheels.toml", R"(format = "omnihil-plan/1"
drive = "wheel_speed"
[[run]]
name = "one"
use = "fit"
duration_s = 1
steps = [[0, 10, 10, 10, 10]]
)");
  const Ran refused =
      run_omnihil("acquire" + shell(folder_ / "wheels.toml") + "--radio ulaval-hermes --dry-run");
  EXPECT_EQ(refused.exit_code, 2) << refused.text;
  EXPECT_TRUE(refused.says("ulaval-hermes cannot ask a robot for wheel_speed")) << refused.text;
}

TEST_F(AcquireVerb, TheUsualPlanIsReadBack) {
  const Ran wrote = run_omnihil("experiment --usual --duration 6 --max-travel 1.2 --packets 60 --write" +
                                shell(folder_ / "usual.toml"));
  ASSERT_EQ(wrote.exit_code, 0) << wrote.text;
  const Ran dry =
      run_omnihil("acquire" + shell(folder_ / "usual.toml") + "--radio roboteam-rem-v8 --dry-run");
  EXPECT_EQ(dry.exit_code, 0) << dry.text;
  EXPECT_TRUE(dry.says("extrapolation")) << dry.text;
}

}  // namespace
}  // namespace omnihil
