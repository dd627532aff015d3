#include "hil/observe/profile_text.h"

#include <fmt/format.h>

#include <algorithm>

#include "hil/observe/exception_names.h"

namespace omnihil {
namespace {

constexpr std::size_t kShown = 20;  // functions of the table: a screen

std::int64_t cycles(std::int64_t sixteenths) { return sixteenths / mcu::kSubcycles; }

const DebugLine* line_at(std::span<const DebugLine> lines, std::uint32_t address) {
  auto after = std::ranges::upper_bound(lines, std::uint64_t{address}, {}, &DebugLine::begin);
  if (after == lines.begin()) return nullptr;
  --after;
  return address < after->end ? &*after : nullptr;
}

struct SourceFile {
  std::map<int, std::uint64_t> lines;                              // how often
  std::map<std::string, std::pair<int, std::uint64_t>> functions;  // line, how often
};

}  // namespace

std::string lcov_text(const ImageProfile& profile, std::span<const DebugLine> lines) {
  std::map<std::string, SourceFile> files;
  for (const DebugLine& row : lines) {
    if (!row.begins) continue;
    std::uint64_t& hits = files[row.file].lines[row.line];
    hits = std::max(hits, profile.runs_of(static_cast<std::uint32_t>(row.begin)));
  }
  for (const auto& [address, name] : profile.image_functions()) {
    const DebugLine* row = line_at(lines, address);
    if (row == nullptr) continue;
    auto& [line, hits] = files[row->file].functions[name];
    line = row->line;
    hits = std::max(hits, profile.runs_of(address));
  }
  std::string text = "TN:\n";
  for (const auto& [name, file] : files) {
    text += fmt::format("SF:{}\n", name);
    std::size_t hit = 0;
    for (const auto& [function, at] : file.functions) text += fmt::format("FN:{},{}\n", at.first, function);
    for (const auto& [function, at] : file.functions) {
      text += fmt::format("FNDA:{},{}\n", at.second, function);
      hit += at.second > 0 ? 1 : 0;
    }
    text += fmt::format("FNF:{}\nFNH:{}\n", file.functions.size(), hit);
    hit = 0;
    for (const auto& [line, hits] : file.lines) {
      text += fmt::format("DA:{},{}\n", line, hits);
      hit += hits > 0 ? 1 : 0;
    }
    text += fmt::format("LF:{}\nLH:{}\nend_of_record\n", file.lines.size(), hit);
  }
  return text;
}

std::string callgrind_text(const ImageProfile& profile, std::span<const DebugLine> lines) {
  std::map<std::string, std::pair<std::string, int>> places;
  for (const auto& [address, name] : profile.image_functions()) {
    const DebugLine* row = line_at(lines, address);
    places[name] = row != nullptr ? std::pair(row->file, row->line) : std::pair(std::string("?"), 0);
  }
  const auto place = [&](const std::string& name) {
    const auto found = places.find(name);
    return found == places.end() ? std::pair(std::string("?"), 0) : found->second;
  };
  std::int64_t all = 0;
  for (const auto& [name, cost] : profile.functions()) all += cycles(cost.self);
  std::string text = fmt::format(
      "# callgrind format\nversion: 1\ncreator: omnihil\npositions: line\nevents: Cycles\nsummary: {}\n",
      all);
  for (const auto& [name, cost] : profile.functions()) {
    const auto [file, line] = place(name);
    text += fmt::format("\nfl={}\nfn={}\n{} {}\n", file, name, line, cycles(cost.self));
    for (auto call = profile.calls().lower_bound({name, ""}); call != profile.calls().end(); ++call) {
      if (call->first.first != name) break;
      const auto [to_file, to_line] = place(call->first.second);
      text += fmt::format("cfi={}\ncfn={}\ncalls={} {}\n{} {}\n", to_file, call->first.second,
                          call->second.calls, to_line, line, cycles(call->second.inclusive));
    }
  }
  return text;
}

std::string profile_table(const ImageProfile& profile) {
  std::vector<std::pair<std::string, FunctionCost>> rows(profile.functions().begin(),
                                                         profile.functions().end());
  std::ranges::stable_sort(rows, [](const auto& a, const auto& b) { return a.second.self > b.second.self; });
  std::int64_t all = profile.asleep();
  for (const auto& [name, cost] : rows) all += cost.self;
  const auto share = [all](std::int64_t part) {
    return all > 0 ? 100.0 * static_cast<double>(part) / static_cast<double>(all) : 0.0;
  };
  std::string text =
      fmt::format("{:>7}  {:>9}  {:>12}  {:>12}  function\n", "share", "calls", "cycles", "with callees");
  text += fmt::format("{:>6.2f}%  {:>9}  {:>12}  {:>12}  (asleep)\n", share(profile.asleep()), "",
                      cycles(profile.asleep()), "");
  for (std::size_t i = 0; i < std::min(rows.size(), kShown); ++i) {
    const auto& [name, cost] = rows[i];
    text += fmt::format("{:>6.2f}%  {:>9}  {:>12}  {:>12}  {}\n", share(cost.self), cost.calls,
                        cycles(cost.self), cycles(cost.inclusive), name);
  }
  if (rows.size() > kShown) text += fmt::format("         {} more functions\n", rows.size() - kShown);
  if (!profile.interrupts().empty())
    text += fmt::format("{:<12}  {:>9}  {:>16}  {:>14}\n", "interrupt", "times", "longest, cycles",
                        "stack, bytes");
  for (const auto& [exception, cost] : profile.interrupts()) {
    text += fmt::format("{:<12}  {:>9}  {:>16}  {:>14}\n", exception_name(exception), cost.count,
                        cycles(cost.longest), cost.stack_bytes);
  }
  return text;
}

}  // namespace omnihil
