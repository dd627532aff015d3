#include "identify/record/dataset.h"

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

double median_period_s(const std::vector<double>& time_s) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < time_s.size(); ++i) steps.push_back(time_s[i] - time_s[i - 1]);
  if (steps.empty()) return 0.0;
  const auto mid = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), mid, steps.end());
  return *mid;
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
