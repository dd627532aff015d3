// All signals of a run as a table: a line per control period, a column per signal and wheel.
//
//   std::string csv = trace_csv(run.trace);       // "time_s,omega_wheel_rad_s_0,…,var:wheel[2].integral"
#pragma once
#include <string>

#include "hil/scenario/scenario_signals.h"

namespace omnihil {

std::string trace_csv(const ScenarioTrace& trace);

}  // namespace omnihil
