// A fit as a table for people, and as JSON for programs.
#pragma once
#include <string>

#include "identify/compare/comparison.h"
#include "identify/estimate/fit.h"

namespace omnihil {

struct FitReport {
  std::string dataset;
  std::string model;  // as asked for; empty: the dataset's own
  FitResult fit;
  Comparison before, after;
  double elapsed_s = 0.0;
};

std::string fit_text(const FitReport& report);
// Parameters and errors as in "omnihil-diagnosis/1", old and new: format "omnihil-fit/1".
std::string fit_json(const FitReport& report);

}  // namespace omnihil
