#include "identify/compare/worst_regime.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace omnihil {
namespace {

// Share of the error less share of the time: less is not reported.
constexpr double kLeastExcess = 0.10;  // a choice

struct AxisWords {
  std::string_view axis;
  std::string_view low, high;  // "below", "above" and the like
  std::string_view what;       // after value and unit; "" for speeds, whose unit is enough
};
constexpr AxisWords kWords[] = {
    {"time", "before", "after", ""},
    {"time_since_step", "within", "later than", "after a step of the input"},
    {"abs_current", "below", "above", "of current, either way"},
    {"abs_command", "below", "above", "of the drive input, either way"},
    {"rotor_angle", "below", "above", "of the rotor's angle"},
    {"output_angle", "below", "above", "of the output's angle"},
    {"acceleration", "below", "above", "(acceleration)"},
    {"temperature", "below", "above", "(temperature)"},
    {"bus_voltage", "below", "above", "of bus voltage"},
    {"position", "below", "above", "(position)"},
    {"velocity", "below", "above", "(signed speed)"},
    {"command_age", "below", "above", "of the command's age"},
};

const AxisWords& words_for(std::string_view axis) {
  static constexpr AxisWords kOther{"", "below", "above", ""};
  const auto found =
      std::find_if(std::begin(kWords), std::end(kWords), [&](const AxisWords& w) { return w.axis == axis; });
  return found == std::end(kWords) ? kOther : *found;
}

std::string range_text(const RegimeError& regime, std::size_t first, std::size_t last) {
  if (regime.axis == "direction") {
    const double middle = 0.5 * (regime.bins[first].from + regime.bins[last].to);
    return middle > 0.0 ? "in the positive direction"
                        : (middle < 0.0 ? "in the negative direction" : "at standstill");
  }
  const AxisWords& words = words_for(regime.axis);
  const std::string unit = regime.unit.empty() || regime.unit == "1" ? "" : " " + regime.unit;
  const std::string what = words.what.empty() ? "" : fmt::format(" {}", words.what);
  const double from = regime.bins[first].from, to = regime.bins[last].to;
  const double whole = regime.bins.back().to - regime.bins.front().from;
  const bool from_the_start = from - regime.bins.front().from < 1e-3 * whole;  // standstill itself left out
  if (from_the_start) return fmt::format("{} {:.3g}{}{}", words.low, to, unit, what);
  if (last + 1 == regime.bins.size()) return fmt::format("{} {:.3g}{}{}", words.high, from, unit, what);
  return fmt::format("between {:.3g} and {:.3g}{}{}", from, to, unit, what);
}

}  // namespace

std::optional<WorstRegime> worst_of(const RegimeError& regime) {
  double best = 0.0, sum = 0.0;
  std::size_t first = 0, best_first = 0, best_last = 0;
  for (std::size_t b = 0; b < regime.bins.size(); ++b) {
    if (sum <= 0.0) sum = 0.0, first = b;
    sum += regime.bins[b].energy_share - regime.bins[b].time_share;
    if (sum > best) best = sum, best_first = first, best_last = b;
  }
  if (best < kLeastExcess) return std::nullopt;
  WorstRegime out{.signal = regime.signal, .axis = regime.axis, .split = regime.split, .sentence = ""};
  for (std::size_t b = best_first; b <= best_last; ++b) {
    out.share += regime.bins[b].energy_share;
    out.time_share += regime.bins[b].time_share;
  }
  out.sentence =
      fmt::format("{:.0f} % of the error energy of {} is {} ({:.0f} % of the time)", 100.0 * out.share,
                  regime.signal, range_text(regime, best_first, best_last), 100.0 * out.time_share);
  return out;
}

std::vector<WorstRegime> worst_regimes(const std::vector<RegimeError>& regimes) {
  const auto excess = [](const WorstRegime& w) { return w.share - w.time_share; };
  std::vector<WorstRegime> out;
  for (const RegimeError& regime : regimes) {
    std::optional<WorstRegime> worst = worst_of(regime);
    if (!worst) continue;
    const auto same = std::find_if(out.begin(), out.end(), [&](const WorstRegime& w) {
      return w.signal == regime.signal && w.split == regime.split;
    });
    if (same == out.end()) {
      out.push_back(std::move(*worst));
    } else if (excess(*worst) > excess(*same)) {
      *same = std::move(*worst);
    }
  }
  std::stable_sort(out.begin(), out.end(),
                   [&](const WorstRegime& a, const WorstRegime& b) { return excess(a) > excess(b); });
  return out;
}

}  // namespace omnihil
