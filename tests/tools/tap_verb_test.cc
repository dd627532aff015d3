// `tap` between a real host's bytes and a bench that stands for the real dongle: both recordings have the same bytes.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <chrono>
#include <sstream>
#include <thread>

#include "tests/tools/bench_test.h"

namespace omnihil {
namespace {

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
