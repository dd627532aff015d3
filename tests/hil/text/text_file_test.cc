#include "hil/text/text_file.h"

#include <gtest/gtest.h>

#include <system_error>

#include "tests/hil/recording/fake_run.h"

namespace omnihil {
namespace {

TEST(TextFile, WhatIsWrittenIsReadAndWhatIsAppendedStandsBehindIt) {
  const fake::TempFolder folder;
  const std::filesystem::path path = folder.path() / "report.xml";
  std::string error;
  write_text_file(path, "old and longer\n");
  write_text_file(path, "a\r\n");
  append_text_file(path, "b\n");
  EXPECT_EQ(read_text_file(path, error), "a\r\nb\n");
  EXPECT_EQ(error, "");
}

TEST(TextFile, AFileThatCannotBeWrittenIsNamed) {
  const fake::TempFolder folder;
  const std::filesystem::path path = folder.path() / "none" / "report.xml";
  for (const auto put : {write_text_file, append_text_file}) {
    try {
      put(path, "a");
      FAIL() << "there is no such folder";
    } catch (const std::system_error& refused) {
      EXPECT_NE(std::string(refused.what()).find(path.string()), std::string::npos) << refused.what();
    }
  }
}

}  // namespace
}  // namespace omnihil
