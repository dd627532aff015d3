// check_data: all checks, and their findings put together for a reader.
#include <fmt/format.h>

#include <algorithm>

#include "identify/checks/check_list.h"

namespace omnihil {
namespace {

constexpr CheckFunction kChecks[] = {
    &check_clock,
    &check_length,
    &check_constant,
    &check_held,
    &check_glitches,
    &check_counter,
    &check_standing_counts,
    &check_direction,
    &check_position_against_speed,
    &check_electrics,
    &check_supply,
    &check_command,
    &check_stall,
    &check_closed_loop,
    &check_duplicates,
    &check_flags,
    &check_silent,
    &check_splits,
};

bool same_kind(const DataFinding& a, const DataFinding& b) {
  return a.kind == b.kind && a.signal == b.signal && a.grade == b.grade;
}

// A finding of one kind, signal and grade in more than kSaidSingly runs is reported once, with the run where
// its size is largest.
std::vector<DataFinding> merged(const std::vector<DataFinding>& all) {
  constexpr std::ptrdiff_t kSaidSingly = 3;  // lines that a reader still reads: a choice
  std::vector<DataFinding> out;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto same = [&](const DataFinding& f) { return same_kind(f, all[i]); };
    const std::ptrdiff_t count = std::count_if(all.begin(), all.end(), same);
    if (count <= kSaidSingly) {
      out.push_back(all[i]);
    } else if (std::none_of(out.begin(), out.end(), same)) {
      DataFinding worst = all[i];
      for (const DataFinding& f : all) {
        if (same(f) && f.size > worst.size) worst = f;
      }
      worst.sentence += fmt::format(" (the worst of {} runs with this)", count);
      out.push_back(std::move(worst));
    }
  }
  std::stable_sort(out.begin(), out.end(),
                   [](const DataFinding& a, const DataFinding& b) { return a.grade > b.grade; });
  return out;
}

}  // namespace

std::vector<DataFinding> check_data(const Dataset& dataset, const Candidate& nominal) {
  const CheckContext context = check_context(dataset, nominal);
  std::vector<DataFinding> findings;
  for (const CheckFunction check : kChecks) check(context, findings);
  for (DataFinding& f : findings) {
    if (!f.run.empty()) f.sentence = fmt::format("{}: {}", f.run, f.sentence);
  }
  return merged(findings);
}

const DataFinding* first_fault(const std::vector<DataFinding>& findings) {
  const auto fault = std::find_if(findings.begin(), findings.end(),
                                  [](const DataFinding& f) { return f.grade == DataFinding::Grade::kFault; });
  return fault == findings.end() ? nullptr : &*fault;
}

}  // namespace omnihil
