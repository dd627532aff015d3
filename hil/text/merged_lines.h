// Lines that several have alike, said once.
//
//   merge_lines("robot", "robots", {{0, {"a", "b"}}, {1, {"a"}}});   // "robots 0-1: a", "robot 0: b"
//
// In the order in which they first come; ranges of numbers as 0-2, 4.
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace omnihil {

struct LinesOf {
  int number = 0;
  std::vector<std::string> lines;
};

std::vector<std::string> merge_lines(std::string_view one, std::string_view many,
                                     const std::vector<LinesOf>& all);

}  // namespace omnihil
