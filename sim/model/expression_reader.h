// The formulas of a model file: [effects.expression.NAME].
//
//   std::vector<EffectUse> uses;
//   read_expressions(document, *document.table["effects"]["expression"].node(), false, uses, problems);
#pragma once
#include <vector>

#include "sim/law/expression.h"
#include "sim/model/model_document.h"

namespace omnihil {

// All of [effects.expression]; problems name file, line, column and the position in the formula.
void read_expressions(const ModelDocument& document, const toml::node& section, bool linear,
                      std::vector<EffectUse>& uses, std::vector<ModelProblem>& problems);

}  // namespace omnihil
