#include "identify/compare/clock_offset.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace omnihil {
namespace {

constexpr int kStretches = 8;   // a spread from so many is known within 27 % (1 / sqrt(2 (n - 1))); a choice
constexpr int kMostSteps = 60;  // periods, to either side: what the search costs; a choice
constexpr double kMostSeconds = 0.15;       // beyond what a radio, a bus or a camera's chain delays; a choice
constexpr std::size_t kLeastSamples = 200;  // per stretch; a choice

struct Stretch {
  const ComparedSignal* signal;
  std::vector<double> model;  // of the whole run, without holes
  std::size_t from, to;
  double period_s;
};

// Linear interpolation over the missing values: the model of a camera signal is known at its frames alone.
std::vector<double> without_holes(const std::vector<double>& model) {
  std::vector<double> out = model;
  std::size_t last = model.size();
  for (std::size_t k = 0; k < model.size(); ++k) {
    if (!std::isfinite(model[k])) continue;
    for (std::size_t i = last + 1; last < model.size() && i < k; ++i) {
      const double share = static_cast<double>(i - last) / static_cast<double>(k - last);
      out[i] = model[last] + share * (model[k] - model[last]);
    }
    last = k;
  }
  return out;
}

// Mean squared error at this lag over the samples that measurement and model both have; infinite when there
// are fewer than kLeastCommon, of which a mean square is known within 26 % (sqrt(2 / n)); a choice.
double mean_square(const Stretch& s, int lag) {
  constexpr std::size_t kLeastCommon = 30;  // as above: a choice
  double sum = 0.0;
  std::size_t n = 0;
  for (std::size_t k = s.from; k < s.to; ++k) {
    const auto then = static_cast<std::size_t>(static_cast<std::ptrdiff_t>(k) - lag);
    const double e = s.signal->measured[k] - s.model[then];
    if (std::isfinite(e)) sum += e * e, ++n;
  }
  return n < kLeastCommon ? std::numeric_limits<double>::infinity() : sum / static_cast<double>(n);
}

struct Best {
  double lag = 0.0;  // in periods
  double at_zero = 0.0, least = 0.0;
};

Best best_lag(const Stretch& s) {
  const int reach = std::clamp(static_cast<int>(kMostSeconds / s.period_s), 3, kMostSteps);
  std::vector<double> error;
  for (int lag = -reach; lag <= reach; ++lag) error.push_back(mean_square(s, lag));
  const auto at = static_cast<std::size_t>(std::min_element(error.begin(), error.end()) - error.begin());
  Best best{.lag = static_cast<double>(at) - reach,
            .at_zero = error[static_cast<std::size_t>(reach)],
            .least = error[at]};
  if (!std::isfinite(best.at_zero)) return {};
  if (at == 0 || at + 1 == error.size() || !std::isfinite(error[at - 1] + error[at + 1])) return best;
  const double curvature = error[at - 1] - 2.0 * error[at] + error[at + 1];
  if (curvature <= 0.0) return best;
  const double shift = 0.5 * (error[at - 1] - error[at + 1]) / curvature;
  best.lag += shift;
  best.least = std::max(0.0, error[at] - 0.25 * (error[at - 1] - error[at + 1]) * shift);
  return best;
}

std::vector<Stretch> stretches_of(const Predictor& predictor, std::span<const Prediction> predictions,
                                  std::string_view name) {
  std::vector<Stretch> out;
  for (int r = 0; r < predictor.run_count(); ++r) {
    const Prediction& prediction = predictions[static_cast<std::size_t>(r)];
    if (predictor.run(r).steady || !prediction.finite) continue;
    for (std::size_t s = 0; s < predictor.compared(r).size(); ++s) {
      const ComparedSignal& signal = predictor.compared(r)[s];
      if (signal.name != name || signal.time_s.size() < kLeastSamples + 2 * kMostSteps) continue;
      const std::size_t n = signal.time_s.size();
      const double period_s = (signal.time_s.back() - signal.time_s.front()) / static_cast<double>(n - 1);
      const std::size_t usable = n - 2 * kMostSteps;
      const std::size_t parts = std::min<std::size_t>(kStretches, usable / kLeastSamples);
      for (std::size_t p = 0; p < parts; ++p) {
        out.push_back({&signal, without_holes(prediction.values[s]), kMostSteps + usable * p / parts,
                       kMostSteps + usable * (p + 1) / parts, period_s});
      }
    }
  }
  return out;
}

}  // namespace

std::optional<ClockOffset> clock_offset(const Predictor& predictor, std::span<const Prediction> predictions,
                                        std::string_view signal) {
  const std::vector<Stretch> stretches = stretches_of(predictor, predictions, signal);
  double weight = 0.0, mean_s = 0.0, square = 0.0, at_zero = 0.0, least = 0.0, period_s = 0.0;
  std::vector<double> seconds, weights;
  for (const Stretch& s : stretches) {
    const Best best = best_lag(s);
    const double gain = (best.at_zero - best.least) * static_cast<double>(s.to - s.from);
    at_zero += best.at_zero * static_cast<double>(s.to - s.from);
    least += best.least * static_cast<double>(s.to - s.from);
    period_s = s.period_s;
    seconds.push_back(best.lag * s.period_s);
    weights.push_back(gain);
    weight += gain;
    mean_s += gain * seconds.back();
  }
  if (stretches.size() < 2 || weight <= 0.0 || at_zero <= 0.0) return std::nullopt;
  mean_s /= weight;
  double weight_square = 0.0;
  for (std::size_t i = 0; i < seconds.size(); ++i) {
    square += weights[i] * (seconds[i] - mean_s) * (seconds[i] - mean_s);
    weight_square += weights[i] * weights[i];
  }
  const double effective = weight * weight / weight_square;  // effective number of stretches (Kish 1965)
  ClockOffset out{.seconds = mean_s, .error_share = 1.0 - least / at_zero};
  out.sigma_s = std::sqrt(square / weight / std::max(1.0, effective - 1.0));
  // Three standard errors (two-sided p = 0.3 % of a normal); the rest is a choice: an offset below a tenth of
  // a period or a twentieth of the error is nobody's trouble. Sensitivity not measured.
  out.significant = effective > 1.5 && std::abs(mean_s) > 3.0 * out.sigma_s &&
                    std::abs(mean_s) > 0.1 * period_s && out.error_share > 0.05;
  return out;
}

}  // namespace omnihil
