// A function of a Python script below tests/hil/ as a test: it fails with what the script prints.
//
//   SCRIPT_TEST(ServeTest, "serve/serial_client.py", can_be_closed_and_opened_again)
#pragma once
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <string>

namespace omnihil {

struct ScriptOutcome {
  int exit_code = -1;
  std::string text;
};

inline ScriptOutcome run_script(const std::string& script, const std::string& name) {
  const std::string command = "OMNIHIL_PROGRAM='" OMNIHIL_PROGRAM "' OMNIHIL_BUILD='" OMNIHIL_BUILD_DIR
                              "' PYTHONDONTWRITEBYTECODE=1 /usr/bin/python3 '" +
                              std::string(OMNIHIL_SOURCE_DIR) + "/tests/hil/" + script + "' " + name +
                              " 2>&1";
  ScriptOutcome outcome;
  std::FILE* pipe = ::popen(command.c_str(), "r");
  if (pipe == nullptr) return outcome;
  std::array<char, 4096> buffer{};
  for (std::size_t n; (n = std::fread(buffer.data(), 1, buffer.size(), pipe)) > 0;) {
    outcome.text.append(buffer.data(), n);
  }
  const int status = ::pclose(pipe);
  if (WIFEXITED(status)) outcome.exit_code = WEXITSTATUS(status);
  return outcome;
}

inline constexpr int kSkipped = 77;

#define SCRIPT_TEST(suite, script, name)                             \
  TEST(suite, name) {                                                \
    const ScriptOutcome outcome = run_script(script, #name);         \
    if (outcome.exit_code == kSkipped) GTEST_SKIP() << outcome.text; \
    EXPECT_EQ(outcome.exit_code, 0) << outcome.text;                 \
  }

}  // namespace omnihil
