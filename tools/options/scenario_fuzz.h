// omnihil scenario fuzz: the verb's options and what it prints. The work is in hil/scenario/chip_fuzz.h.
#pragma once
#include "tools/command_line.h"
#include "tools/verbs/verbs.h"

namespace omnihil {

void add_scenario_fuzz(Verb& scenario, VerbResult& result);

}  // namespace omnihil
