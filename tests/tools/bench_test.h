// Programs in the background of a test, in a folder of its own: a bench, a tap, a driver; all are ended with it.
//
//   const pid_t bench = start({"serve", "--device", at("dongle"), "--quiet"});
//   wait_for_device("dongle");
//   EXPECT_EQ(stop(bench), 0) << text_of(folder_ / "said");
#pragma once
#include <arpa/inet.h>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "tests/hil/recording/fake_run.h"
#include "tests/tools/cli.h"

namespace omnihil {

inline int free_udp_port() {
  const int fd = ::socket(AF_INET, SOCK_DGRAM, 0);
  sockaddr_in any{};
  any.sin_family = AF_INET;
  any.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof any;
  EXPECT_EQ(::bind(fd, reinterpret_cast<sockaddr*>(&any), size), 0);
  EXPECT_EQ(::getsockname(fd, reinterpret_cast<sockaddr*>(&any), &size), 0);
  ::close(fd);
  return ntohs(any.sin_port);
}

class BenchTest : public CliTest {
 protected:
  void TearDown() override {
    const std::vector<pid_t> all = children_;
    for (const pid_t child : all) stop(child);
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
  // Exit code once it has ended, asked to by a signal (0: of its own accord).
  int stop(pid_t child, int signal = SIGTERM) {
    std::erase(children_, child);
    if (signal != 0) ::kill(child, signal);
    int status = 0;
    ::waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  // Far beyond what a loaded computer needs; only a fault reaches it.
  bool wait_until(const std::function<bool()>& true_at_last) {
    for (int n = 0; n < 6000; ++n) {
      if (true_at_last()) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
  }
  void wait_for_device(const char* name) {
    ASSERT_TRUE(wait_until([&] { return std::filesystem::exists(folder_ / name); })) << name << "\n"
                                                                                     << said();
  }
  std::string said() { return text_of(folder_ / "said"); }
  std::string at(const char* name) { return (folder_ / name).string(); }

  fake::TempFolder folder_;
  std::vector<pid_t> children_;
};

}  // namespace omnihil
