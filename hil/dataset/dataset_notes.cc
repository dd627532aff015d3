#include "hil/dataset/dataset_notes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <span>

namespace omnihil {

void RunNotes::add(const std::string& what, const std::string& run) {
  const auto same = [&](const auto& note) { return note.first == what; };
  const auto found = std::find_if(notes_.begin(), notes_.end(), same);
  if (found == notes_.end()) {
    notes_.push_back({what, {run}});
  } else {
    found->second.push_back(run);
  }
}

std::vector<std::string> RunNotes::lines(std::size_t runs) const {
  constexpr std::size_t kNamed = 4;
  std::vector<std::string> out;
  for (const auto& [what, where] : notes_) {
    const std::span<const std::string> named(where.data(), std::min(where.size(), kNamed));
    out.push_back(fmt::format("{} in {} of {} runs ({}{})", what, where.size(), runs, fmt::join(named, ", "),
                              where.size() > kNamed ? ", …" : ""));
  }
  return out;
}

}  // namespace omnihil
