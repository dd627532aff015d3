// The sizes of one or two candidates, and how sure they are: by the equations of their instruments, solved among runs near
// the answer.
//
//   const auto fit = fitted_sizes(search, {.z = {&z}, .start = {value}, .half = {step}, …});
//   const double half_width = kExplainT * fit->sigma[0];   // of fit->value[0]: 95 %
//
// Method. g(a) = <z, r(a)>, z the instrument, r = measured - model by the noise; the size is where g is 0. g is taken at
// kAround places round the start, each run with a seed of its own, and a line (for two candidates a plane) is laid through
// them: the slope is the one that holds at the answer, not between -1 and +1 sigma of the parameter, and what chance is in
// the model's runs (sensors, and roundings of counted encoders that any change reshuffles) is averaged. Standard error: all
// of that again without one block of time after the other (jackknife; Künsch 1989).
// Cannot: a size whose line is flat among the runs' chance (no value then).
#pragma once
#include <functional>
#include <optional>
#include <vector>

#include "hil/check/explain_search.h"

namespace omnihil {

// A part of the step that a sensitivity is taken over: near enough for a line, far enough above what counted encoders make
// of any change. Half widths of the runs.
inline constexpr double kSizeStep = 0.2;

struct SizeQuestion {
  std::function<std::optional<ModelBundle>(const std::vector<double>& at)> model{};
  std::vector<const Weighted*> z{};  // one or two instruments
  std::vector<double> start{}, half{}, lower{}, upper{};
};

struct SizeFit {
  std::vector<double> value, sigma;
};

// Nothing where the runs do not determine it.
std::optional<SizeFit> fitted_sizes(const ExplainSearch& search, const SizeQuestion& question);

}  // namespace omnihil
