// The signals of one failed check as a self-contained SVG: what was, what was commanded, the check's window.
//
//   std::string svg = scenario_plot(title, run.trace, result);
#pragma once
#include <string>

#include "hil/scenario/scenario_check.h"

namespace omnihil {

std::string scenario_plot(const std::string& title, const ScenarioTrace& trace, const CheckResult& result);

}  // namespace omnihil
