// Effects of a model file, and effects added on a command line.
//
//   std::vector<ModelProblem> problems;
//   std::vector<EffectUse> uses = read_effects(document, {.drive = &drive}, problems);
//   std::string fault = add_override("cogging.amplitude_Nm=0.004", {.drive = &drive}, uses);   // "" or what
//   is wrong
//
// [effects.ID] holds numbers, bare or { value, tolerance, source }. Strengths that are not given are neutral,
// shapes start from the motor at hand where they can. A linear axis has _N, _m in place of _Nm, _rad. All
// problems are reported, each with file, line and column; the effects come in alphabetical order.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "sim/core/effect_set.h"
#include "sim/core/model_document.h"

namespace omnihil {

struct EffectContext {
  const DriveParams<double>* drive = nullptr;  // for start values; may be null
  bool linear = false;
};

std::vector<EffectUse> read_effects(const ModelDocument& document, const EffectContext& context,
                                    std::vector<ModelProblem>& problems);

// "ID.param=value", or "ID" for its typical size. Adds the effect if it is not there, else changes it.
std::string add_override(std::string_view text, const EffectContext& context, std::vector<EffectUse>& uses);

// "amplitude_Nm" -> "amplitude_N" where the axis is linear; phases are kept.
std::string param_key(const EffectParam& row, bool linear);

// Bounds and prior scale; forces of a linear axis may be a thousand times what torques of a motor may be,
// its speeds in m/s a thousandth of theirs in rad/s.
struct ParamRange {
  double lower = 0.0;
  double upper = 0.0;
  double prior_scale = 0.0;
  double scale = 1.0;  // over the row's own numbers (linear_scale.h)
};
ParamRange param_range(const EffectParam& row, bool linear);

// "0 to 10 N m"; "0 to 10000 N" where the axis is linear
std::string allowed_range(const EffectParam& row, bool linear);

// [effects.ID] sections as text of a model file, numbers with as many digits as give the same double back.
std::string write_effects(std::span<const EffectUse> uses, bool linear);

}  // namespace omnihil
