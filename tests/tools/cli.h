// Runs the program as a user does and keeps what it said.
//
//   const Ran ran = run_omnihil("check '" + path + "'");
//   EXPECT_EQ(ran.exit_code, 0) << ran.text;
#pragma once
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace omnihil {

struct Ran {
  int exit_code = -1;
  std::string text;  // stdout and stderr together

  bool says(const std::string& what) const { return text.find(what) != std::string::npos; }
};

inline Ran run_omnihil(const std::string& arguments) {
  Ran ran;
  std::FILE* pipe = ::popen(("'" OMNIHIL_PROGRAM "' " + arguments + " 2>&1").c_str(), "r");
  if (pipe == nullptr) return ran;
  char buffer[4096];
  for (std::size_t n; (n = std::fread(buffer, 1, sizeof buffer, pipe)) > 0;) ran.text.append(buffer, n);
  const int status = ::pclose(pipe);
  ran.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128;
  return ran;
}

inline std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

inline std::string shell(const std::filesystem::path& path) { return " '" + path.string() + "' "; }

// Tests of the program: skipped where only the tests were built.
class CliTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(OMNIHIL_PROGRAM)) GTEST_SKIP() << "the program omnihil is not built";
  }
};

}  // namespace omnihil
