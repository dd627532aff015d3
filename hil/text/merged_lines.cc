#include "hil/text/merged_lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace omnihil {
namespace {
// Ascending numbers as "0-2, 4".
std::string ranges(const std::vector<int>& numbers) {
  std::string text;
  for (std::size_t i = 0; i < numbers.size();) {
    std::size_t last = i;
    while (last + 1 < numbers.size() && numbers[last + 1] == numbers[last] + 1) ++last;
    text += text.empty() ? "" : ", ";
    text += last == i ? std::to_string(numbers[i]) : fmt::format("{}-{}", numbers[i], numbers[last]);
    i = last + 1;
  }
  return text;
}
}  // namespace

std::vector<std::string> merge_lines(std::string_view one, std::string_view many,
                                     const std::vector<LinesOf>& all) {
  std::vector<std::pair<std::string, std::vector<int>>> whose;
  for (const LinesOf& each : all) {
    for (const std::string& line : each.lines) {
      auto found = std::find_if(whose.begin(), whose.end(), [&](const auto& w) { return w.first == line; });
      if (found == whose.end()) found = whose.insert(whose.end(), {line, {}});
      if (found->second.empty() || found->second.back() != each.number) found->second.push_back(each.number);
    }
  }
  std::vector<std::string> merged;
  for (const auto& [line, numbers] : whose) {
    merged.push_back(fmt::format("{} {}: {}", numbers.size() == 1 ? one : many, ranges(numbers), line));
  }
  return merged;
}

}  // namespace omnihil
