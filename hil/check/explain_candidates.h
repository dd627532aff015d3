// The changes of a robot's model that may explain a difference: each uncertain parameter, each effect of the catalogue
// that acts on a robot and is not in the model.
//
//   for (const ExplainCandidate& c : explain_candidates(model)) try_it(*c.model(c.to));
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "hil/loop/model_store.h"

namespace omnihil {

struct ExplainCandidate {
  std::string name;  // path of the parameter, or ID.parameter of the effect's first strength
  std::string unit;
  bool is_effect = false;
  double value = 0.0;  // now; an effect's neutral value
  double from = 0.0,
         to = 0.0;  // for a difference: 1 sigma of a parameter both ways, an effect from nearly nothing
  double lower = 0.0, upper = 0.0;
  // The whole model with that value; nothing when it cannot be read.
  std::function<std::optional<ModelBundle>(double value)> model;
};

// Empty for a model that cannot be read. Parameters that the file calls exact are not candidates.
std::vector<ExplainCandidate> explain_candidates(const ModelBundle& model);

}  // namespace omnihil
