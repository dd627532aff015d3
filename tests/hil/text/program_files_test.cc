#include "hil/text/program_files.h"

#include <gtest/gtest.h>

#include <filesystem>

namespace omnihil {
namespace {

namespace fs = std::filesystem;

TEST(ProgramFilesTest, ABuildTreeUsesTheSourcesThemselves) {
  for (const std::string folder : {"models", "boards", "examples/scenarios"}) {
    EXPECT_EQ(data_folder(folder), fs::canonical(fs::path(OMNIHIL_SOURCE_DIR) / folder).string());
  }
}

TEST(ProgramFilesTest, AFolderThatIsNotThereIsNamedWhereItWasLookedFor) {
  const fs::path program = fs::read_symlink("/proc/self/exe");
  const fs::path wanted = program.parent_path().parent_path() / "share/omnihil/no_such_folder";
  EXPECT_EQ(data_folder("no_such_folder"), wanted.string());
}

TEST(ProgramFilesTest, HelpersAreFoundFromTheProgramsPlaceAndElseByName) {
  EXPECT_TRUE(fs::equivalent(helper_program("omnihil_firmware_process"),
                             fs::path(OMNIHIL_BUILD_DIR) / "tools/omnihil_firmware_process"));
  EXPECT_EQ(helper_program("no_such_program"), "no_such_program");
}

}  // namespace
}  // namespace omnihil
