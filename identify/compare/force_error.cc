#include "identify/compare/force_error.h"

#include <cmath>
#include <vector>

#include "identify/record/decimate.h"

namespace omnihil {
namespace {

constexpr int kFactor = 10;  // source: the published recipe (Janot, Gautier, Brunot 2019): 1 kHz to 100 Hz
constexpr std::size_t kLeastSamples = 100;  // of a stretch: shorter ones are all ends of the filter; a choice

double decimated_square(const std::vector<double>& x) {
  double square = 0.0;
  for (const double v : decimate(x, kFactor)) square += v * v;
  return square;
}

}  // namespace

std::optional<double> force_error(const Predictor& predictor, std::span<const Prediction> predictions,
                                  Split split) {
  double error = 0.0, force = 0.0;
  for (int r = 0; r < predictor.run_count(); ++r) {
    if (predictor.run(r).split != split || predictor.run(r).steady) continue;
    for (std::size_t s = 0; s < predictor.compared(r).size(); ++s) {
      const ComparedSignal& signal = predictor.compared(r)[s];
      if (signal.name != "motor_torque") continue;
      const std::vector<double>& model = predictions[static_cast<std::size_t>(r)].values[s];
      const std::vector<double>& force_all =
          signal.with_undetermined.empty() ? signal.measured : signal.with_undetermined;
      std::vector<double> residual, measured;
      for (std::size_t k = 0; k <= model.size(); ++k) {
        const double e = k < model.size() ? force_all[k] - model[k] : NAN;
        if (std::isfinite(e)) {
          residual.push_back(e);
          measured.push_back(force_all[k]);
          continue;
        }
        if (residual.size() >= kLeastSamples) {
          error += decimated_square(residual);
          force += decimated_square(measured);
        }
        residual.clear();
        measured.clear();
      }
    }
  }
  if (force <= 0.0) return std::nullopt;
  return std::sqrt(error / force);
}

}  // namespace omnihil
