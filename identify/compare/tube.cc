#include "identify/compare/tube.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

namespace omnihil {
namespace {

bool number_in(std::string_view text, double& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() && std::isfinite(value);
}

double range_of(const std::vector<double>& values) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const double v : values) {
    if (std::isfinite(v)) low = std::min(low, v), high = std::max(high, v);
  }
  return high > low ? high - low : 0.0;
}

void hold_run(const ComparedSignal& signal, const std::vector<double>& model, const std::string& run,
              const Tube& tube, TubeResult& out) {
  const double tolerance =
      tube.relative ? tube.tolerance / 100.0 * range_of(signal.measured) : tube.tolerance;
  std::size_t from = 0, to = 0;
  for (std::size_t k = 0; k < model.size(); ++k) {
    const double t = signal.time_s[k];
    while (signal.time_s[from] < t - tube.time_s) ++from;
    while (to < model.size() && signal.time_s[to] <= t + tube.time_s) ++to;
    if (!std::isfinite(signal.measured[k])) continue;
    ++out.samples;
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (std::size_t i = from; i < to; ++i) {
      if (std::isfinite(model[i])) low = std::min(low, model[i]), high = std::max(high, model[i]);
    }
    const double beyond =
        std::max(low - tolerance - signal.measured[k], signal.measured[k] - high - tolerance);
    if (beyond <= 0.0) continue;
    if (out.outside++ == 0) out.first_run = run, out.first_s = t;
    if (beyond > out.worst) out.worst = beyond, out.worst_run = run, out.worst_s = t;
  }
}

}  // namespace

std::optional<Tube> parse_tube(std::string_view text, std::string& fault) {
  const std::size_t equals = text.find('=');
  fault = fmt::format("--tube {}: write SIGNAL=TOLERANCE, SIGNAL=PERCENT% or SIGNAL=TOLERANCE/SECONDS", text);
  if (equals == std::string_view::npos || equals == 0) return std::nullopt;
  Tube tube{.signal = std::string(text.substr(0, equals))};
  std::string_view value = text.substr(equals + 1);
  if (const std::size_t slash = value.find('/'); slash != std::string_view::npos) {
    if (!number_in(value.substr(slash + 1), tube.time_s) || tube.time_s < 0.0) return std::nullopt;
    value = value.substr(0, slash);
  }
  if (value.ends_with('%')) tube.relative = true, value.remove_suffix(1);
  if (!number_in(value, tube.tolerance) || tube.tolerance < 0.0) return std::nullopt;
  fault.clear();
  return tube;
}

TubeResult hold_in_tube(const Predictor& predictor, std::span<const Prediction> predictions,
                        const Tube& tube) {
  TubeResult out;
  for (int r = 0; r < predictor.run_count(); ++r) {
    for (std::size_t s = 0; s < predictor.compared(r).size(); ++s) {
      const ComparedSignal& signal = predictor.compared(r)[s];
      if (signal.name != tube.signal) continue;
      hold_run(signal, predictions[static_cast<std::size_t>(r)].values[s], predictor.run(r).file, tube, out);
    }
  }
  return out;
}

}  // namespace omnihil
