// What single bounds cannot say: conditions between several numbers of a model.
#pragma once
#include <string>
#include <vector>

#include "sim/model/params.h"

namespace omnihil {

struct ModelConflict {
  const Parameter* at = nullptr;  // the number to point at
  std::string what;
  std::string allowed;
};

// `rig`: one RigBit. Only for tables in which every needed row is there and within its bounds.
std::vector<ModelConflict> model_conflicts(const ParameterTable& table, std::uint32_t rig);

}  // namespace omnihil
