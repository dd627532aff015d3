// A diagnosis as JSON, format "omnihil-diagnosis/1".
//
//   std::string text = diagnosis_json(diagnosis, {.elapsed_s = 12.3, .model = "model.toml"});
//
// Keys of the format come first and mean what it says; what it does not name (`findings`, `ladder`,
// `unknown`, `not_visible`, `complete`, `extrapolation`) is added for readers who want more. A number that is
// not finite is null. The order of keys is fixed, so two equal diagnoses are equal texts but for `elapsed_s`.
#pragma once
#include <string>

#include "identify/select/diagnosis.h"

namespace omnihil {

struct DiagnosisJsonOptions {
  double elapsed_s = 0.0;
  std::string model;  // where the final model was written, or its text; "" : not kept
};

std::string diagnosis_json(const Diagnosis& diagnosis, const DiagnosisJsonOptions& options);

}  // namespace omnihil
