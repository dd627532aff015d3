// The program with the reference image on its board, in a folder of the test's own; skipped where no compiler made the image.
#pragma once
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>

#include "tests/hil/observe/observed_image.h"
#include "tests/tools/cli.h"

namespace omnihil {

class ImageProgram : public CliTest {
 protected:
  void SetUp() override {
    CliTest::SetUp();
    if (!std::filesystem::exists(kReferenceImage)) GTEST_SKIP() << "arm-none-eabi-gcc is not installed";
    folder_ = std::filesystem::temp_directory_path() / ("omnihil_image_" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  static std::string image() {
    return " --firmware '" + kReferenceImage +
           "' --board '" OMNIHIL_SOURCE_DIR "/boards/omni_reference_f405.toml' ";
  }
  std::filesystem::path folder_;
};

}  // namespace omnihil
