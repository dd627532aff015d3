// `tap` between a real host's bytes and a bench that stands for the real dongle: both recordings have the same bytes.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <chrono>
#include <cstdio>
#include <fstream>
#include <sstream>
#include <thread>

#include "protocols/radio_format.h"
#include "tests/tools/bench_test.h"

namespace omnihil {
namespace {

// Six robots at 60 Hz for two seconds, as `play` takes it: ping, which the base station gives back, and velocities.
std::string tigers_stream() {
  const RadioFormat& format = *find_radio_format("tigers-base-station");
  std::string text;
  for (int k = 0; k < 120; ++k) {
    std::vector<std::uint8_t> bytes;
    RobotCommand command{};
    command.mode = OMNIHIL_MODE_BODY_VELOCITY;
    command.v_forward_m_s = 0.01 * k;
    EXPECT_TRUE(format.encode_command(command, {.robot_id = k % 6, .team = Team::kBlue}, bytes));
    text += std::to_string(k / 60.0) + " ";
    for (const std::uint8_t byte : bytes) {
      constexpr const char* kHex = "0123456789abcdef";
      text += kHex[byte >> 4];
      text += kHex[byte & 15];
    }
    text += "\n";
  }
  return text;
}

class TapVerb : public BenchTest {
 protected:
  // All bytes of one way, as hex.
  std::string bytes(const char* name, const std::string& way) {
    std::istringstream lines(text_of(folder_ / name));
    std::string line, tag, time, hex, all;
    while (std::getline(lines, line)) {
      std::istringstream words(line);
      words >> tag >> time >> hex;
      if (tag == way) all += hex;
    }
    return all;
  }
};

TEST_F(TapVerb, NeitherSideNoticesAndBothRecordingsAgree) {
  const pid_t bench = start({"serve", "--device", at("real"), "--robots", "0-5", "--physics", "planar",
                             "--quiet", "--record", at("real.omnirec")});
  wait_for_device("real");
  const pid_t tap = start({"tap", at("real"), "--device", at("dongle"), "--radio", "ulaval-hermes",
                           "--record", at("tap.omnirec")});
  wait_for_device("dongle");
  const Ran played =
      run_omnihil("play '" OMNIHIL_SOURCE_DIR
                  "/examples/streams/hermes-drive.txt' --radio ulaval-hermes --speed 8 --device" +
                  shell(folder_ / "dongle"));
  EXPECT_EQ(played.exit_code, 0) << played.text;
  // What was on its way when the host left arrives before either is stopped.
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  EXPECT_EQ(stop(tap), 0) << text_of(folder_ / "said");
  EXPECT_EQ(stop(bench), 0) << text_of(folder_ / "said");
  const std::string sent = bytes("tap.omnirec", ">");
  EXPECT_GT(sent.size(), 50'000u);
  EXPECT_EQ(sent, bytes("real.omnirec", ">"));
  EXPECT_GT(bytes("tap.omnirec", "<").size(), 100u);
  // What the bench had answered when the tap went may still have been on its way.
  EXPECT_EQ(bytes("real.omnirec", "<").find(bytes("tap.omnirec", "<")), 0u);
  const Ran dump = run_omnihil("dump" + shell(folder_ / "tap.omnirec"));
  EXPECT_EQ(dump.exit_code, 0);
  EXPECT_TRUE(dump.says("SPEED_MOVE_ADVANCE")) << dump.text.substr(0, 500);
  EXPECT_TRUE(text_of(folder_ / "said").find("own delay") != std::string::npos);
}

TEST_F(TapVerb, OverUdpNeitherSideNoticesEither) {
  const std::string far = "udp:127.0.0.1:" + std::to_string(free_udp_port());
  const std::string near = "udp:127.0.0.1:" + std::to_string(free_udp_port());
  const pid_t bench =
      start({"serve", "--device", far + "?listen=1", "--radio", "tigers-base-station", "--robots", "0-5",
             "--physics", "planar", "--quiet", "--record", at("real.omnirec")});
  ASSERT_TRUE(wait_until([&] { return said().find("ready: tigers") != std::string::npos; })) << said();
  const pid_t tap = start({"tap", far, "--device", near + "?listen=1", "--radio", "tigers-base-station",
                           "--record", at("tap.omnirec")});
  ASSERT_TRUE(wait_until([&] { return said().find("passed on to") != std::string::npos; })) << said();
  std::ofstream(folder_ / "stream.txt") << tigers_stream();
  const Ran played = run_omnihil("play" + shell(folder_ / "stream.txt") +
                                 "--radio tigers-base-station --device '" + near + "'");
  EXPECT_EQ(played.exit_code, 0) << played.text;
  EXPECT_EQ(stop(tap), 0) << said();
  EXPECT_EQ(stop(bench), 0) << said();
  const std::string sent = bytes("tap.omnirec", ">");
  EXPECT_GT(sent.size(), 5'000u);
  EXPECT_EQ(sent, bytes("real.omnirec", ">"));
  EXPECT_GT(bytes("tap.omnirec", "<").size(), 5'000u);
  EXPECT_EQ(bytes("real.omnirec", "<").find(bytes("tap.omnirec", "<")), 0u);
}

TEST_F(TapVerb, TheCamerasBesideItStandOnTheRecordingsClock) {
  const std::string group = "224.5.23.2:" + std::to_string(free_udp_port());
  const pid_t bench =
      start({"serve", "--device", at("real"), "--robots", "0,3", "--physics", "planar", "--quiet", "--league",
             "--vision", group, "--vision-delay", "5", "--vision-delay-most", "8", "--league-robot-port",
             std::to_string(free_udp_port()), "--league-control-port", std::to_string(free_udp_port())});
  wait_for_device("real");
  const pid_t tap =
      start({"tap", at("real"), "--device", at("dongle"), "--radio", "ulaval-hermes", "--record",
             at("tap.omnirec"), "--vision", group, "--vision-interface", "127.0.0.1"});
  const auto enough = [&] {
    std::error_code error;
    return std::filesystem::file_size(folder_ / "tap.omnirec.vision.csv.part", error) > 10'000 && !error;
  };
  EXPECT_TRUE(wait_until(enough)) << said();
  EXPECT_EQ(stop(tap), 0) << said();
  EXPECT_EQ(stop(bench), 0) << said();
  EXPECT_FALSE(std::filesystem::exists(folder_ / "tap.omnirec.vision.csv.part"));
  std::istringstream lines(text_of(folder_ / "tap.omnirec.vision.csv"));
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(line, "time_s,camera,team,robot,x_m,y_m,yaw_rad,arrived_s");
  int rows = 0;
  while (std::getline(lines, line)) {
    double time_s = 0.0, arrived_s = 0.0, x_m = 0.0, y_m = 0.0, yaw = 0.0;
    int camera = -1, robot = -1;
    char team[8] = {};
    ASSERT_EQ(std::sscanf(line.c_str(), "%lf,%d,%7[a-z],%d,%lf,%lf,%lf,%lf", &time_s, &camera, team, &robot,
                          &x_m, &y_m, &yaw, &arrived_s),
              8)
        << line;
    EXPECT_TRUE(robot == 0 || robot == 3) << line;
    EXPECT_STREQ(team, "blue");
    EXPECT_LE(time_s, arrived_s - 0.005 + 1e-3) << line;  // 5 ms from capture to sending; the loop's step
    ++rows;
  }
  EXPECT_GT(rows, 100);
  EXPECT_NE(said().find("camera 0: "), std::string::npos) << said();
}

TEST_F(TapVerb, ADongleThatGoesAwayEndsItWithAWholeRecording) {
  const pid_t bench =
      start({"serve", "--device", at("real"), "--robots", "0", "--physics", "planar", "--quiet"});
  wait_for_device("real");
  const pid_t tap = start({"tap", at("real"), "--device", at("dongle"), "--radio", "ulaval-hermes",
                           "--record", at("tap.omnirec")});
  wait_for_device("dongle");
  stop(bench);
  int status = 0;
  ::waitpid(tap, &status, 0);
  std::erase(children_, tap);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 3) << text_of(folder_ / "said");
  EXPECT_NE(text_of(folder_ / "said").find("omnihil tap: "), std::string::npos);
  EXPECT_NE(text_of(folder_ / "tap.omnirec").find("\"end\""), std::string::npos);
}

TEST_F(TapVerb, ADongleThatIsNotThereIsNamed) {
  const Ran ran = run_omnihil("tap" + shell(folder_ / "nothing") + " --device" + shell(folder_ / "dongle"));
  EXPECT_EQ(ran.exit_code, 3) << ran.text;
  EXPECT_TRUE(ran.says("nothing")) << ran.text;
}

}  // namespace
}  // namespace omnihil
