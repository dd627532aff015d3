#include "identify/record/dataset.h"

#include <algorithm>

#include "identify/record/statistics.h"

namespace omnihil {

std::string_view split_name(Split split) {
  switch (split) {
    case Split::kTraining:
      return "fit";
    case Split::kValidation:
      return "holdout";
    case Split::kExtrapolation:
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
  return median_in_place(steps);
}

const Channel* Dataset::channel(std::string_view signal) const {
  const auto found =
      std::find_if(channels.begin(), channels.end(), [&](const Channel& c) { return c.signal == signal; });
  return found == channels.end() ? nullptr : &*found;
}

bool Dataset::has(Split split) const {
  return std::any_of(runs.begin(), runs.end(), [&](const Run& r) { return r.split == split; });
}

}  // namespace omnihil
