#include "identify/predict/undetermined.h"

#include <algorithm>
#include <cmath>

namespace omnihil {

std::vector<bool> standing_still(std::span<const double> position, double limit, std::size_t window) {
  std::vector<bool> out(position.size(), false);
  for (std::size_t k = 0; k + window < position.size(); ++k) {
    const auto [low, high] = std::ranges::minmax(position.subspan(k, window + 1));
    if (!(high - low <= limit)) continue;
    const auto from = out.begin() + static_cast<std::ptrdiff_t>(k);
    std::fill(from, from + static_cast<std::ptrdiff_t>(window + 1), true);
  }
  return out;
}

std::vector<bool> unresolved_jumps(std::span<const double> torque, double band, double sigma,
                                   std::size_t samples) {
  constexpr double kMostOfRecord = 0.5;  // a choice
  const std::size_t n = torque.size();
  std::vector<bool> out(n, false);
  for (std::size_t k = 1; k + 2 < n; ++k) {
    const double before = std::abs(torque[k] - torque[k - 1]), jump = std::abs(torque[k + 1] - torque[k]),
                 after = std::abs(torque[k + 2] - torque[k + 1]);
    if (band * (jump - std::max(before, after)) / std::sqrt(12.0) <= sigma) continue;
    const std::size_t from = k - std::min(k, samples), to = std::min(n, k + 2 + samples);
    std::fill(out.begin() + static_cast<std::ptrdiff_t>(from), out.begin() + static_cast<std::ptrdiff_t>(to),
              true);
  }
  const auto marked = static_cast<double>(std::count(out.begin(), out.end(), true));
  if (marked > kMostOfRecord * static_cast<double>(n)) std::fill(out.begin(), out.end(), false);
  return out;
}

}  // namespace omnihil
