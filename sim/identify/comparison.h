// How far a model is from a measurement: per signal and per use, with the regime where it is worst.
//
//   Comparison c = compare(predictor, candidate);
//   c.error(Use::kHoldout, "velocity")->rmse;
//   c.worst[0].sentence;       // "62 % of the error energy of velocity is below 3 rad/s (11 % of the time)"
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "sim/identify/predictor.h"

namespace omnihil {

struct SignalError {
  std::string signal;
  std::string unit;
  Use use = Use::kFit;
  std::size_t samples = 0;
  double rmse = 0.0;
  double mean_absolute = 0.0;
  double nrmse_percent = 0.0;  // rmse over the standard deviation of the measured signal
  double bias = 0.0;           // mean of model minus measurement
  double noise_sigma = 0.0;    // floor that no model can pass
};

// Error energy in one range of one axis.
struct RegimeBin {
  double from = 0.0, to = 0.0;
  double energy_share = 0.0;  // of the squared error of this signal and use
  double time_share = 0.0;
  double mean = 0.0;   // of the residual (measured minus model)
  double sigma = 0.0;  // standard error of the mean, from blocks (residuals are autocorrelated)
};
struct RegimeError {
  std::string signal;
  std::string axis;  // RegimeTrack::name
  std::string unit;  // of the axis
  Use use = Use::kFit;
  std::vector<RegimeBin> bins;
  double explained_fraction = 0.0;  // of the residual's energy, by its mean per bin, chance subtracted
};
struct WorstRegime {
  std::string signal;
  std::string axis;
  double share = 0.0;
  std::string sentence;
};

struct Comparison {
  std::vector<SignalError> errors;
  std::vector<RegimeError> regimes;
  std::vector<WorstRegime> worst;     // the worst first
  std::vector<std::string> diverged;  // runs in which the model stopped being finite
  // sqrt(mean over signals of mean((residual / noise)^2)): 1 is perfect
  double pooled(Use use) const;
  const SignalError* error(Use use, std::string_view signal) const;
};

Comparison compare(const Predictor& predictor, const Candidate& candidate);

}  // namespace omnihil
