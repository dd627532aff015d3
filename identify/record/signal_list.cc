#include "identify/record/signal_list.h"

#include <algorithm>

#include "identify/record/rig.h"

namespace omnihil {

const SignalRow* find_signal(const Rig& rig, std::string_view name) {
  const auto at = std::find_if(rig.signals.begin(), rig.signals.end(),
                               [&](const SignalRow& r) { return r.name == name; });
  return at == rig.signals.end() ? nullptr : &*at;
}

std::string_view signal_unit(const SignalRow& row, bool linear) {
  return linear ? row.linear_unit : row.unit;
}

std::vector<std::string_view> signal_names(const Rig& rig) {
  std::vector<std::string_view> names;
  for (const SignalRow& row : rig.signals) names.push_back(row.name);
  return names;
}

std::vector<std::string_view> drive_group_signals(const Rig& rig, std::string_view group) {
  std::vector<std::string_view> names;
  for (const SignalRow& row : rig.signals) {
    if (row.role == SignalRole::kDrive && row.drive_group == group) names.push_back(row.name);
  }
  return names;
}

}  // namespace omnihil
