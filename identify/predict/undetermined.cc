#include "identify/predict/undetermined.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace omnihil {
namespace {

// Samples first to last, and `margin` to either side.
void mark(std::size_t first, std::size_t last, std::size_t margin, std::vector<bool>& out) {
  const std::size_t from = first - std::min(first, margin), to = std::min(out.size(), last + margin + 1);
  std::fill(out.begin() + static_cast<std::ptrdiff_t>(from), out.begin() + static_cast<std::ptrdiff_t>(to),
            true);
}

}  // namespace

std::vector<bool> standing_still(std::span<const double> position, double limit, std::size_t window,
                                 std::size_t margin) {
  std::vector<bool> out(position.size(), false);
  for (std::size_t k = 0; k + window < position.size(); ++k) {
    const auto [low, high] = std::ranges::minmax(position.subspan(k, window + 1));
    if (high - low <= limit) mark(k, k + window, margin, out);
  }
  return out;
}

std::vector<bool> unresolved_jumps(std::span<const double> torque, double band, double sigma,
                                   std::size_t margin) {
  constexpr double kMostOfRecord = 0.5;  // a choice
  const std::size_t n = torque.size();
  std::vector<bool> out(n, false);
  for (std::size_t k = 1; k + 2 < n; ++k) {
    const double before = std::abs(torque[k] - torque[k - 1]), jump = std::abs(torque[k + 1] - torque[k]),
                 after = std::abs(torque[k + 2] - torque[k + 1]);
    if (band * (jump - std::max(before, after)) / std::sqrt(12.0) > sigma) mark(k, k + 1, margin, out);
  }
  const auto marked = static_cast<double>(std::count(out.begin(), out.end(), true));
  if (marked > kMostOfRecord * static_cast<double>(n)) std::fill(out.begin(), out.end(), false);
  return out;
}

void leave_out_undetermined(const std::vector<bool>& still, const std::vector<bool>& jumps,
                            ComparedSignal& c) {
  std::size_t at_rest = 0, at_jumps = 0;
  c.with_undetermined = c.measured;
  for (std::size_t k = 0; k < c.measured.size(); ++k) {
    const bool rest = k < still.size() && still[k], jump = k < jumps.size() && jumps[k];
    if (!rest && !jump) continue;
    c.measured[k] = kMissing;
    ++(rest ? at_rest : at_jumps);
  }
  if (at_rest > 0) c.left_out += fmt::format(", {} samples at rest (friction takes what is asked)", at_rest);
  if (at_jumps > 0) c.left_out += fmt::format(", {} samples at jumps between two rows", at_jumps);
}

}  // namespace omnihil
