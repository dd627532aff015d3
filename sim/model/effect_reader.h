// Effects of a model file, and effects added on a command line.
//
//   std::vector<ModelProblem> problems;
//   std::vector<EffectUse> uses = read_effects(document, {.drive = &drive}, problems);
//   std::string fault = add_override("cogging.amplitude_Nm=0.004", {.drive = &drive}, uses);   // what is wrong, or ""
//
// [effects.ID] holds numbers, bare, believed or fitted (fitted_number.h). Strengths that are not given are
// neutral, shapes start from the motor at hand where they can. A linear axis has _N, _m in place of _Nm, _rad. A number
// of a wheel that the robot has not is a problem. All problems are reported, each with file, line and column; the effects
// come in alphabetical order.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "sim/law/effect_set.h"
#include "sim/law/param_range.h"
#include "sim/model/model_document.h"

namespace omnihil {

struct EffectContext {
  const DriveParams<double>* drive = nullptr;  // for start values; may be null
  bool linear = false;
  std::size_t wheels = kAllWheels;  // of the robot
};

std::vector<EffectUse> read_effects(const ModelDocument& document, const EffectContext& context,
                                    std::vector<ModelProblem>& problems);

// "ID.param=value", or "ID" for its typical size. Adds the effect if it is not there, else changes it.
std::string add_override(std::string_view text, const EffectContext& context, std::vector<EffectUse>& uses);

// [effects.ID] sections as text of a model file, numbers with as many digits as give the same double back.
std::string write_effects(std::span<const EffectUse> uses, bool linear);

}  // namespace omnihil
