// Where a model is worst, in a sentence.
//
//   std::optional<WorstRegime> w = worst_of(regime);
//   w->sentence;           // "62 % of the error energy of velocity is below 3 rad/s (11 % of the time)"
//
// Of all ranges of an axis the one is taken whose share of the squared error exceeds its share of the time by
// most (largest sum of successive terms: J. Bentley, Comm. ACM 27(9), 1984). None where the error is spread
// as the time is.
#pragma once
#include <optional>
#include <vector>

#include "identify/compare/comparison.h"

namespace omnihil {

std::optional<WorstRegime> worst_of(const RegimeError& regime);

// The worst range of each signal and split over all axes, the worst first.
std::vector<WorstRegime> worst_regimes(const std::vector<RegimeError>& regimes);

}  // namespace omnihil
