// How far a model is from a measurement: per signal and per split, with the regime where it is worst.
//
//   Comparison c = compare(predictor, candidate);
//   c.error(Split::kValidation, "velocity")->rmse;
//   c.worst[0].sentence;       // "62 % of the error energy of velocity is below 3 rad/s (11 % of the time)"
//
// A run in which the model stops being finite has an infinite error: it never looks good by having few
// samples. Noise: what the predictor's signals state or show; where the same input was given twice, the
// difference of the two responses is a floor of its own (`repeat_sigma`).
#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "identify/predict/predictor.h"

namespace omnihil {

struct SignalError {
  std::string signal;
  std::string unit;
  Split split = Split::kTraining;
  std::size_t samples = 0;
  double rmse = 0.0;
  double mean_absolute = 0.0;
  double nrmse_percent = 0.0;  // rmse over the standard deviation of the measured signal
  double bias = 0.0;           // mean of model minus measurement
  double noise_sigma = 0.0;    // floor that no model can pass
  bool noise_is_stated = false;
  double repeat_sigma = 0.0;  // of responses to the same input; 0: no input was given twice
  double in_sigmas = 0.0;     // rms of the whitened residual over its noise: 1 is perfect
  double relative = 0.0;      // norm of the error over norm of the measured signal
  double averaging_s = 0.0;   // the error is a mean over this time (predictor.h); 0: sample by sample
};

// Error energy in one range of one axis.
struct RegimeBin {
  double from = 0.0, to = 0.0;
  double energy_share = 0.0;  // of the squared error of this signal and split
  double time_share = 0.0;
  double mean = 0.0;   // of the residual (measured minus model), in the signal's unit
  double sigma = 0.0;  // standard error of the mean, from blocks (residuals are autocorrelated)
};
// Errors are in the signal's unit, `from` and `to` in the axis'.
struct RegimeError {
  std::string signal;
  std::string axis;  // RegimeTrack::name
  std::string unit;  // of the axis
  Split split = Split::kTraining;
  std::vector<RegimeBin> bins;
  double explained_fraction = 0.0;  // of the residual's variance, by its mean per bin, chance subtracted
};
struct WorstRegime {
  std::string signal;
  std::string axis;
  Split split = Split::kTraining;
  double share = 0.0;       // of the error energy
  double time_share = 0.0;  // of the samples
  std::string sentence;
};
// One signal of one run, for tables per run.
struct RunError {
  int run = 0;
  std::string signal;
  double rmse = 0.0;
  double mean_absolute = 0.0;
  double bias = 0.0;
};

struct Comparison {
  std::vector<SignalError> errors;
  std::vector<RegimeError> regimes;
  std::vector<WorstRegime> worst;     // the worst first
  std::vector<RunError> runs;         // in the order of the runs
  std::vector<std::string> diverged;  // runs in which the model stopped being finite
  // sqrt(mean over signals of in_sigmas^2): 1 is perfect; infinite where a run diverged
  double pooled(Split split) const;
  const SignalError* error(Split split, std::string_view signal) const;
};

Comparison compare(const Predictor& predictor, const Candidate& candidate);

// From predictions that are there already, one per run; `with_regimes` false: errors alone, much faster.
Comparison compare(const Predictor& predictor, const Candidate& candidate,
                   std::span<const Prediction> predictions, bool with_regimes = true);

}  // namespace omnihil
