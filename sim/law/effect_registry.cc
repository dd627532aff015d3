#include "sim/law/effect_registry.h"

#include <algorithm>
#include <vector>

#include "sim/law/spelling.h"

namespace omnihil {

std::string_view place_name(Place place) {
  static constexpr std::string_view kNames[kPlaces] = {"command", "supply",  "bridge", "winding", "torque",
                                                       "shaft",   "contact", "body",   "sensor",  "timing"};
  return kNames[static_cast<int>(place)];
}

const EffectEntry* find_effect(std::string_view id) {
  for (const EffectEntry* e : all_effects()) {
    if (e->info->id == id) return e;
  }
  return nullptr;
}

std::string_view nearest_effect(std::string_view id) {
  std::vector<std::string_view> ids;
  for (const EffectEntry* e : all_effects()) ids.push_back(e->info->id);
  return nearest_spelling(id, ids);
}

int find_param(const EffectInfo& info, std::string_view name) {
  const auto found = std::find_if(info.params.begin(), info.params.end(),
                                  [&](const EffectParam& row) { return row.name == name; });
  return found == info.params.end() ? -1 : static_cast<int>(found - info.params.begin());
}

std::string_view nearest_param(const EffectInfo& info, std::string_view name) {
  std::vector<std::string_view> names;
  for (const EffectParam& row : info.params) names.push_back(row.name);
  return nearest_spelling(name, names);
}

}  // namespace omnihil
