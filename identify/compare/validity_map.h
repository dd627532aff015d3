// Where a model was held against data, and how far off it was there: one signal's error over two axes.
//
//   const auto axes = validity_axes(predictor, candidate);              // {"speed", "abs_current"}
//   ValidityMap map = validity_map(predictor, candidate, predictions, "velocity", axes);
//   map.at(3, 2).unseen;                 // samples of runs that are no fit runs, in column 3 of row 2
//   map.at(3, 2).rmse;                   // of those, in the signal's unit; NaN: too few to say
//
// Cells are of equal size between the 0.5 % and the 99.5 % quantile of each axis; what lies farther out is
// counted, not drawn. A cell with fewer than kLeastSamples unseen samples has no error. The error is that of
// comparison.h: model minus measurement, of a coarse speed as a mean over its averaging time.
// Cannot: say anything of a cell without data; tell two causes apart that lie in the same cell.
#pragma once
#include <array>
#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "identify/predict/predictor.h"

namespace omnihil {

struct ValidityCell {
  std::size_t fitted = 0;                                  // samples of runs of use "fit"
  std::size_t unseen = 0;                                  // samples of the other runs
  double rmse = std::numeric_limits<double>::quiet_NaN();  // of the unseen ones, in the signal's unit
  double bias = std::numeric_limits<double>::quiet_NaN();  // mean of model minus measurement, of the same
};

struct ValidityAxis {
  std::string name;           // RegimeTrack::name; empty: there is none
  std::string unit;           // of the edges
  std::vector<double> edges;  // one more than cells, ascending
};

struct ValidityMap {
  std::string signal;
  std::string unit;
  ValidityAxis x, y;
  std::vector<ValidityCell> cells;  // rows of y, in each the columns of x
  double spread = 0.0;              // standard deviation of the measured signal over all runs, in its unit
  std::size_t samples = 0;          // in the map
  std::size_t outside = 0;          // beyond the quantiles, or with an axis that is not known

  std::size_t columns() const { return x.edges.empty() ? 0 : x.edges.size() - 1; }
  std::size_t rows() const { return y.edges.empty() ? 0 : y.edges.size() - 1; }
  const ValidityCell& at(std::size_t column, std::size_t row) const {
    return cells[row * columns() + column];
  }
};

inline constexpr std::size_t kLeastSamples = 10;  // a choice: an rms of 10 is known to 22 % (1 / sqrt(2 n))

// Speed and current where there are both; else the first two axes along which the data vary. Empty names: fewer
// than two.
std::array<std::string, 2> validity_axes(const Predictor& predictor, const Candidate& candidate);

// `predictions`: one per run; runs that diverged are left out. No cells where the signal or an axis is unknown.
ValidityMap validity_map(const Predictor& predictor, const Candidate& candidate,
                         std::span<const Prediction> predictions, const std::string& signal,
                         const std::array<std::string, 2>& axes);

}  // namespace omnihil
