// Sorts errors by what the motion was like: along one axis (speed, current, angle, …) where is the error?
//
//   RegimeSamples s{.residual = …, .axis = …, .block = …};
//   RegimeError r = regime_error("speed", s);       // bins, with the mean residual and its standard error
//
// Bins: 24 of equal width, parted further at the 24ths of the samples, so that both sparse ends and
// crowded places are resolved; none with less than a thousandth of the samples. Angles are taken modulo a
// turn, in 48 bins. The standard error of a bin's mean comes from blocks of successive samples, since
// residuals are autocorrelated: var = sum_k (S_k - m n_k)^2 / (sum n_k)^2 * K / (K - 1), S_k, n_k sum and
// count of block k (ratio estimator: W. G. Cochran, Sampling Techniques, 3rd ed. 1977, sec. 6.3).
// Cannot: separate two axes that are correlated in the record.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "identify/compare/comparison.h"

namespace omnihil {

struct RegimeSamples {
  // n samples each
  std::vector<double> residual;  // measured minus model, in the signal's unit; finite
  std::vector<double> axis;      // regime variable, in its own unit; NaN: not known there
  std::vector<int> block;        // 0 to kBlocks - 1: which stretch of the record a sample belongs to
};

// Over all samples of a split: a standard error from 64 blocks is known within 9 % (1 / sqrt(2 (K - 1))).
inline constexpr int kBlocks = 64;  // a choice

// The caller fills in signal, split and unit.
RegimeError regime_error(std::string_view axis, const RegimeSamples& samples);

}  // namespace omnihil
