#include "identify/predict/input_wander.h"

#include <cmath>

#include "identify/record/dataset.h"

namespace omnihil {
namespace {

double mean_square(std::span<const Wander> wanders, double time_constant_s) {
  double sum = 0.0, count = 0.0;
  for (const Wander& w : wanders) {
    ComparedSignal signal;
    signal.whitening_s = time_constant_s;
    signal.time_s.assign(w.signal->time_s.begin(),
                         w.signal->time_s.begin() + static_cast<std::ptrdiff_t>(w.change.size()));
    for (const double v : whitened(signal, w.change)) {
      if (std::isfinite(v)) sum += v * v, count += 1.0;
    }
  }
  return count > 0.0 ? sum / count : 0.0;
}

}  // namespace

Whitening whitening_beside(std::span<const Wander> wanders, double longest_s, double shortest_s) {
  const ComparedSignal& signal = *wanders.front().signal;
  const double period_s = median_period_s(signal.time_s);
  // a difference of two positions over the time between them: noise_sigma = sqrt(2) sigma / dt
  const double position_square = 0.5 * signal.noise_sigma * signal.noise_sigma * period_s * period_s;
  for (double tau_s = longest_s;; tau_s *= 0.5) {
    // of the rounding's differences through the leak a: sigma^2 2 / (1 + a)
    const double rounding = position_square * 2.0 / (1.0 + std::exp(-period_s / tau_s)),
                 wander = mean_square(wanders, tau_s);
    if (wander <= rounding || 0.5 * tau_s < shortest_s)
      return {.time_constant_s = tau_s, .sigma = std::sqrt(rounding + wander)};
  }
}

}  // namespace omnihil
