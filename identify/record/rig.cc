#include "identify/record/rig.h"

#include <algorithm>

namespace omnihil {

const Rig* find_rig(std::string_view name) {
  const auto rigs = all_rigs();
  const auto at = std::find_if(rigs.begin(), rigs.end(), [&](const Rig* r) { return r->name == name; });
  return at == rigs.end() ? nullptr : *at;
}

std::string rig_choice() {
  const auto rigs = all_rigs();
  std::string out;
  for (std::size_t i = 0; i < rigs.size(); ++i) {
    if (i > 0) out += i + 1 < rigs.size() ? ", " : " or ";
    out += '"' + std::string(rigs[i]->name) + '"';
  }
  return out;
}

}  // namespace omnihil
