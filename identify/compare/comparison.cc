#include "identify/compare/comparison.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "identify/compare/regime_bins.h"
#include "identify/compare/repeat_noise.h"
#include "identify/compare/worst_regime.h"
#include "identify/record/parallel.h"

namespace omnihil {
namespace {

// Sums over the samples of one signal and one split (or one run).
struct Sums {
  std::size_t n = 0;
  double square = 0.0, absolute = 0.0, error = 0.0;  // of model minus measurement
  double measured = 0.0, measured_square = 0.0;
  double noise_square = 0.0;
  double sigmas_square = 0.0;
  std::size_t whitened = 0;
  bool diverged = false, stated = true;
};

std::vector<double> residual_of(const ComparedSignal& signal, const std::vector<double>& model) {
  std::vector<double> residual(model.size());
  for (std::size_t i = 0; i < model.size(); ++i) residual[i] = signal.measured[i] - model[i];
  return residual;
}

void add_samples(const ComparedSignal& signal, const std::vector<double>& model, bool finite, Sums& sums) {
  std::vector<double> residual = residual_of(signal, model);
  const std::vector<double> shown = averaged(signal, residual), measured = averaged(signal, signal.measured);
  const double noise = averaged_sigma(signal);
  for (std::size_t i = 0; i < model.size(); ++i) {
    if (!std::isfinite(shown[i])) continue;
    const double e = -shown[i];
    ++sums.n;
    sums.square += e * e;
    sums.absolute += std::abs(e);
    sums.error += e;
    sums.measured += measured[i];
    sums.measured_square += measured[i] * measured[i];
    sums.noise_square += noise * noise;
  }
  sums.stated = sums.stated && signal.noise_is_stated;
  sums.diverged = sums.diverged || !finite;
  const double sigma = signal.whitened_sigma > 0.0 ? signal.whitened_sigma : signal.noise_sigma;
  if (sigma <= 0.0) return;
  for (const double r : whitened(signal, std::move(residual))) {
    if (!std::isfinite(r)) continue;
    sums.sigmas_square += r * r / (sigma * sigma);
    ++sums.whitened;
  }
}

SignalError error_of(const Sums& s) {
  SignalError e;
  e.samples = s.n;
  e.noise_is_stated = s.stated;
  if (s.diverged || s.n == 0) {
    const double bad = s.diverged ? std::numeric_limits<double>::infinity() : 0.0;
    e.rmse = e.mean_absolute = e.nrmse_percent = e.in_sigmas = e.relative = bad;
    return e;
  }
  const auto n = static_cast<double>(s.n);
  e.rmse = std::sqrt(s.square / n);
  e.mean_absolute = s.absolute / n;
  e.bias = s.error / n;
  e.noise_sigma = std::sqrt(s.noise_square / n);
  const double mean = s.measured / n;
  const double deviation = std::sqrt(std::max(0.0, s.measured_square / n - mean * mean));
  const double norm = std::sqrt(s.measured_square / n);
  e.nrmse_percent = deviation > 0.0 ? 100.0 * e.rmse / deviation : 0.0;
  e.relative = norm > 0.0 ? e.rmse / norm : 0.0;
  e.in_sigmas = s.whitened > 0 ? std::sqrt(s.sigmas_square / static_cast<double>(s.whitened)) : 0.0;
  return e;
}

// Signals by name, in the order in which the runs bring them.
std::vector<const ComparedSignal*> all_signals(const Predictor& predictor) {
  std::vector<const ComparedSignal*> out;
  for (int r = 0; r < predictor.run_count(); ++r) {
    for (const ComparedSignal& signal : predictor.compared(r)) {
      const auto same = [&](const ComparedSignal* s) { return s->name == signal.name; };
      if (std::none_of(out.begin(), out.end(), same)) out.push_back(&signal);
    }
  }
  return out;
}

// The samples of one signal and split along every axis.
struct AxisSamples {
  std::string unit;
  RegimeSamples samples;
};
using SamplesByAxis = std::map<std::string, AxisSamples>;

void add_regimes(const std::vector<RegimeTrack>& tracks, const ComparedSignal& signal,
                 const std::vector<double>& model, SamplesByAxis& out) {
  const std::vector<double> residual = averaged(signal, residual_of(signal, model));
  for (const RegimeTrack& track : tracks) {
    AxisSamples& at = out[track.name];
    at.unit = track.unit;
    for (std::size_t i = 0; i < model.size() && i < track.value.size(); ++i) {
      if (!std::isfinite(residual[i])) continue;
      at.samples.residual.push_back(residual[i]);
      at.samples.axis.push_back(track.value[i]);
    }
  }
}

void finish_regimes(SamplesByAxis& by_axis, const std::string& signal, Split split, Comparison& out) {
  for (auto& [axis, at] : by_axis) {
    const std::size_t n = at.samples.residual.size();
    if (n == 0) continue;
    at.samples.block.resize(n);
    for (std::size_t i = 0; i < n; ++i) at.samples.block[i] = static_cast<int>(i * kBlocks / n);
    RegimeError regime = regime_error(axis, at.samples);
    if (regime.bins.empty()) continue;
    regime.signal = signal;
    regime.split = split;
    regime.unit = at.unit;
    out.regimes.push_back(std::move(regime));
  }
}

int index_of(const std::vector<ComparedSignal>& signals, const std::string& name) {
  for (std::size_t s = 0; s < signals.size(); ++s) {
    if (signals[s].name == name) return static_cast<int>(s);
  }
  return -1;
}

}  // namespace

double Comparison::pooled(Split split) const {
  double square = 0.0;
  int signals = 0;
  for (const SignalError& e : errors) {
    if (e.split != split || (e.samples == 0 && std::isfinite(e.rmse))) continue;
    square += e.in_sigmas * e.in_sigmas;
    ++signals;
  }
  return signals > 0 ? std::sqrt(square / signals) : 0.0;
}

const SignalError* Comparison::error(Split split, std::string_view signal) const {
  const auto found = std::find_if(errors.begin(), errors.end(), [&](const SignalError& e) {
    return e.split == split && e.signal == signal;
  });
  return found == errors.end() ? nullptr : &*found;
}

Comparison compare(const Predictor& predictor, const Candidate& candidate) {
  std::vector<Prediction> predictions(static_cast<std::size_t>(predictor.run_count()));
  parallel_for(predictor.run_count(),
               [&](int r) { predictions[static_cast<std::size_t>(r)] = predictor.predict(candidate, r); });
  return compare(predictor, candidate, predictions);
}

Comparison compare(const Predictor& predictor, const Candidate& candidate,
                   std::span<const Prediction> predictions, bool with_regimes) {
  Comparison out;
  const int runs = predictor.run_count();
  std::vector<std::vector<RegimeTrack>> tracks(static_cast<std::size_t>(runs));
  for (int r = 0; r < runs; ++r) {
    const auto at = static_cast<std::size_t>(r);
    if (!predictions[at].finite) out.diverged.push_back(predictor.run(r).file);
  }
  parallel_for(with_regimes ? runs : 0, [&](int r) {
    const auto at = static_cast<std::size_t>(r);
    if (predictions[at].finite) tracks[at] = predictor.regimes(candidate, r);
  });
  for (const ComparedSignal* signal : all_signals(predictor)) {
    const double repeat = repeat_noise(predictor, signal->name).value_or(0.0);
    for (int u = 0; u < kSplits; ++u) {
      const Split split = static_cast<Split>(u);
      Sums sums;
      SamplesByAxis by_axis;
      bool any = false;
      for (int r = 0; r < runs; ++r) {
        const auto at = static_cast<std::size_t>(r);
        const int s = index_of(predictor.compared(r), signal->name);
        if (predictor.run(r).split != split || s < 0) continue;
        any = true;
        const ComparedSignal& compared = predictor.compared(r)[static_cast<std::size_t>(s)];
        const std::vector<double>& model = predictions[at].values[static_cast<std::size_t>(s)];
        add_samples(compared, model, predictions[at].finite, sums);
        Sums alone;
        add_samples(compared, model, predictions[at].finite, alone);
        const SignalError e = error_of(alone);
        out.runs.push_back({r, compared.name, e.rmse, e.mean_absolute, e.bias});
        add_regimes(tracks[at], compared, model, by_axis);
      }
      if (!any) continue;
      SignalError error = error_of(sums);
      error.signal = signal->name;
      error.unit = signal->unit;
      error.split = split;
      error.repeat_sigma = repeat;
      error.averaging_s = signal->averaging_s;
      out.errors.push_back(std::move(error));
      finish_regimes(by_axis, signal->name, split, out);
    }
  }
  std::stable_sort(out.runs.begin(), out.runs.end(),
                   [](const RunError& a, const RunError& b) { return a.run < b.run; });
  out.worst = worst_regimes(out.regimes);
  return out;
}

}  // namespace omnihil
