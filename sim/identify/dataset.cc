#include "sim/identify/dataset.h"

#include <algorithm>

namespace omnihil {

std::string_view use_name(Use use) {
  switch (use) {
    case Use::kFit:
      return "fit";
    case Use::kHoldout:
      return "holdout";
    case Use::kExtrapolation:
      return "extrapolation";
  }
  return "";
}

const std::vector<double>* Run::signal(std::string_view name) const {
  const auto found = signals.find(name);
  return found == signals.end() ? nullptr : &found->second;
}

const Channel* Dataset::channel(std::string_view signal) const {
  const auto found =
      std::find_if(channels.begin(), channels.end(), [&](const Channel& c) { return c.signal == signal; });
  return found == channels.end() ? nullptr : &*found;
}

bool Dataset::has(Use use) const {
  return std::any_of(runs.begin(), runs.end(), [&](const Run& r) { return r.use == use; });
}

}  // namespace omnihil
