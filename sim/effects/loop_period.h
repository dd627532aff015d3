// Parameter of laws that firmware carries out: the period of the loop that does it.
#pragma once
#include "sim/law/effect_entry.h"

namespace omnihil {

inline constexpr EffectParam kLoopPeriodRow = {
    .name = "loop_period_s",
    .unit = "s",
    .role = ParamRole::kShape,
    .neutral = kNoNeutral,
    .typical = 0,  // continuous: a loop much faster than what is recorded
    .lower = 0,
    .upper = 0.05,         // 20 Hz
    .prior_scale = 0.002,  // control loops of 100 Hz to 20 kHz (estimate)
    .what = "period of the loop that does it in steps: each takes the newest command at once; 0: continuous",
    .how = "firmware's source: time between two calls of the filter or ramp",
    .trait = ParamTrait::kForm,
};

}  // namespace omnihil
