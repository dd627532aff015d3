#include "identify/estimate/fit_note.h"

#include <cmath>

namespace omnihil {
namespace {

bool is_base(const FitResult& fit, std::string_view path) {
  return fit.model.file.parameters.find(path) != nullptr && !path.starts_with("effects.");
}

}  // namespace

Candidate with_fit_noted(const FitResult& fit, const FittedTo& to) {
  Candidate out = fit.model;
  for (const ParameterEstimate& p : fit.parameters) {
    FittedNumber note{.sigma = {}, .data = to.data, .date = to.date, .believed = {}, .believed_sigma = {}};
    if (std::isfinite(p.sigma) && p.sigma > 0.0) note.sigma = p.sigma;
    // A base number moves only where it has a tolerance, if one of zero; an effect's may have a flat prior.
    const bool base = is_base(fit, p.path);
    if (base || p.prior_sigma > 0.0) note.believed = p.prior_mean;
    if (!base && p.prior_sigma > 0.0) note.believed_sigma = p.prior_sigma;
    note_fit(out, p.path, note);
  }
  return out;
}

}  // namespace omnihil
