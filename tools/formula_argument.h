// A user's formula on the command line: "TARGET += FORMULA; a = 2e-8, b = 0.1".
//
//   std::vector<std::string> faults;
//   EffectUse use = formula_argument("torque_Nm += -a*omega_rotor_rad_s; a = 2e-6", false, faults);
//
// Every name that is no signal needs a value to start from; a fit may move it a thousand times that far,
// either way. The effect is called expression.added.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "sim/law/effect_set.h"

namespace omnihil {

// Without an entry when there are faults; all of them are said.
EffectUse formula_argument(std::string_view text, bool linear, std::vector<std::string>& faults);

}  // namespace omnihil
