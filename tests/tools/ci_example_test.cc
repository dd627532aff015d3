// The workflow that teams copy says nothing that the program does not take.
#include <gtest/gtest.h>

#include <regex>

#include "tests/tools/cli.h"

namespace omnihil {
namespace {

class CiExample : public CliTest {};

TEST_F(CiExample, WorkflowUsesOptionsThatCheckHas) {
  const std::string workflow = text_of(OMNIHIL_SOURCE_DIR "/examples/ci/omnihil-check.yml");
  const Ran help = run_omnihil("check --help");
  const std::size_t command = workflow.find("omnihil check recordings");
  ASSERT_NE(command, std::string::npos);
  const std::string lines = workflow.substr(command, workflow.find("- if:", command) - command);
  const std::regex option("--[a-z-]+");
  int options = 0;
  for (std::sregex_iterator at(lines.begin(), lines.end(), option), end; at != end; ++at, ++options)
    EXPECT_TRUE(help.says("  " + at->str() + " ")) << at->str();
  EXPECT_GE(options, 6);
}

TEST_F(CiExample, ContainerInstallsThePackage) {
  const std::string file = text_of(OMNIHIL_SOURCE_DIR "/examples/ci/Containerfile");
  EXPECT_NE(file.find("FROM debian:12"), std::string::npos);
  EXPECT_NE(file.find("/tmp/omnihil_*.deb"), std::string::npos);
}

}  // namespace
}  // namespace omnihil
