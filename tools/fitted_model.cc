#include "tools/fitted_model.h"

#include "hil/dataset/dataset_fingerprint.h"
#include "hil/text/today.h"
#include "identify/estimate/fit_note.h"

namespace omnihil {

std::string fitted_model_text(const FitResult& fit, const std::string& dataset_path, const Dataset& dataset) {
  const FittedTo to{.data = dataset_fingerprint(dataset_path, dataset), .date = today_utc()};
  return candidate_text(with_fit_noted(fit, to));
}

}  // namespace omnihil
