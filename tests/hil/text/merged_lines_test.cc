#include "hil/text/merged_lines.h"

#include <gtest/gtest.h>

namespace omnihil {
namespace {

TEST(MergedLines, EqualLinesOfManyAreOneAndKeepTheirOrder) {
  const std::vector<std::string> merged = merge_lines(
      "robot", "robots", {{0, {"a", "b"}}, {1, {"a", "b", "c"}}, {2, {"b", "a"}}, {4, {"a"}}, {5, {"d"}}});
  EXPECT_EQ(merged,
            (std::vector<std::string>{"robots 0-2, 4: a", "robots 0-2: b", "robot 1: c", "robot 5: d"}));
}

TEST(MergedLines, TheSameLineTwiceOfOneIsSaidOnce) {
  EXPECT_EQ(merge_lines("board", "boards", {{3, {"a", "a"}}}), (std::vector<std::string>{"board 3: a"}));
  EXPECT_TRUE(merge_lines("board", "boards", {{0, {}}, {1, {}}}).empty());
}

}  // namespace
}  // namespace omnihil
