// `tap` between a real host's bytes and a bench that stands for the real dongle: both recordings have the same bytes.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <sstream>
#include <thread>

#include "tests/hil/recording/fake_run.h"
#include "tests/tools/cli.h"

namespace omnihil {
namespace {

class TapVerb : public CliTest {
 protected:
  void TearDown() override {
    for (const pid_t child : children_) stop(child);
  }
  pid_t start(const std::vector<std::string>& words) {
    std::vector<char*> arguments{const_cast<char*>(OMNIHIL_PROGRAM)};
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t quiet;
    posix_spawn_file_actions_init(&quiet);
    posix_spawn_file_actions_addopen(&quiet, STDOUT_FILENO, (folder_ / "said").c_str(),
                                     O_WRONLY | O_CREAT | O_APPEND, 0644);
    posix_spawn_file_actions_adddup2(&quiet, STDOUT_FILENO, STDERR_FILENO);
    pid_t child = -1;
    EXPECT_EQ(posix_spawn(&child, OMNIHIL_PROGRAM, &quiet, nullptr, arguments.data(), environ), 0);
    posix_spawn_file_actions_destroy(&quiet);
    children_.push_back(child);
    return child;
  }
  int stop(pid_t child) {
    std::erase(children_, child);
    ::kill(child, SIGTERM);
    int status = 0;
    ::waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  void wait_for_device(const char* name) {
    for (int n = 0; n < 1000 && !std::filesystem::exists(folder_ / name); ++n)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    ASSERT_TRUE(std::filesystem::exists(folder_ / name)) << name << "\n" << text_of(folder_ / "said");
  }
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
  std::string at(const char* name) { return (folder_ / name).string(); }
  static std::string text_of(const std::filesystem::path& path) {
    std::ifstream in(path);
    return {std::istreambuf_iterator<char>(in), {}};
  }

  fake::TempFolder folder_;
  std::vector<pid_t> children_;
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
