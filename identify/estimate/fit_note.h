// A fitted model with a note on every number that the fit moved: how well these data tell it, and what was
// believed of it before.
//
//   Candidate mended = with_fit_noted(fit, {.data = "sha256:9f86d081884c", .date = "2026-11-23"});
//   candidate_text(mended);
//
// However often a model is fitted, the prior stays the first belief (candidate.h), so that additions one by
// one walk no farther than one fit may. Where the measurement is from is the caller's to say: nothing here
// reads a file or a clock.
#pragma once
#include <string>

#include "identify/estimate/fit.h"

namespace omnihil {

struct FittedTo {
  std::string data;  // fingerprint of the measurement
  std::string date;  // of the fit, "2026-11-23"
};

Candidate with_fit_noted(const FitResult& fit, const FittedTo& to);

}  // namespace omnihil
