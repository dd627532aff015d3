#include "identify/compare/repeat_noise.h"

#include <algorithm>
#include <cmath>

#include "identify/record/rig.h"

namespace omnihil {
namespace {

bool is_drive(std::string_view name) {
  return std::any_of(all_rigs().begin(), all_rigs().end(), [&](const Rig* rig) {
    const SignalRow* row = find_signal(*rig, name);
    return row != nullptr && row->role == SignalRole::kDrive;
  });
}

// Equal over the first n samples, and not constant.
bool equal_so_far(const std::vector<double>& a, const std::vector<double>& b, std::size_t n) {
  constexpr double kShare = 1e-3;  // of the input's size: three decimals of a duty in a file; a choice
  double size = 0.0;
  for (std::size_t i = 0; i < n; ++i) size = std::max(size, std::abs(a[i]));
  bool moves = false;
  for (std::size_t i = 0; i < n; ++i) {
    if (std::isnan(a[i]) != std::isnan(b[i]) || std::abs(a[i] - b[i]) > kShare * size) return false;
    moves = moves || (i > 0 && a[i] != a[i - 1]);
  }
  return moves;
}

bool same_input(const Run& a, const Run& b) {
  constexpr double kLeast = 0.8;  // of the longer run: a repetition that was cut short; a choice
  const std::size_t n = std::min(a.time_s.size(), b.time_s.size());
  if (a.steady || b.steady || a.known != b.known || n < 10) return false;
  if (static_cast<double>(n) < kLeast * static_cast<double>(std::max(a.time_s.size(), b.time_s.size())))
    return false;
  const double period_s = a.duration_s() / static_cast<double>(a.time_s.size() - 1);
  for (std::size_t i = 0; i < n; ++i) {
    if (std::abs((a.time_s[i] - a.time_s[0]) - (b.time_s[i] - b.time_s[0])) > 0.1 * period_s) return false;
  }
  bool driven = false;
  for (const auto& [name, values] : a.signals) {
    if (!is_drive(name)) continue;
    const std::vector<double>* other = b.signal(name);
    if (other == nullptr || !equal_so_far(values, *other, n)) return false;
    driven = true;
  }
  return driven;
}

const ComparedSignal* find_signal(const std::vector<ComparedSignal>& signals, std::string_view name) {
  const auto found =
      std::find_if(signals.begin(), signals.end(), [&](const ComparedSignal& s) { return s.name == name; });
  return found == signals.end() ? nullptr : &*found;
}

}  // namespace

std::optional<double> repeat_noise(const Predictor& predictor, std::string_view signal) {
  double square = 0.0;
  std::size_t count = 0;
  for (int i = 0; i < predictor.run_count(); ++i) {
    for (int j = i + 1; j < predictor.run_count(); ++j) {
      const ComparedSignal* a = find_signal(predictor.compared(i), signal);
      const ComparedSignal* b = find_signal(predictor.compared(j), signal);
      if (a == nullptr || b == nullptr || !same_input(predictor.run(i), predictor.run(j))) continue;
      const std::vector<double> one = averaged(*a, a->measured), other = averaged(*b, b->measured);
      for (std::size_t k = 0; k < std::min(one.size(), other.size()); ++k) {
        const double d = one[k] - other[k];
        if (std::isfinite(d)) square += d * d, ++count;
      }
    }
  }
  if (count == 0) return std::nullopt;
  return std::sqrt(square / static_cast<double>(count) / 2.0);
}

}  // namespace omnihil
