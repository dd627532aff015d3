// What `omnihil acquire` does with a plan of one axis: opens the bus or the board, drives the runs, writes the measurement.
//
//   if (of_axis(plan.drive)) exit_code = acquire_axis(words, axis, plan, plan_text);
#pragma once
#include <string>

#include "tools/options/acquire_runs.h"

namespace omnihil {

struct AxisAcquireWords {
  std::string bus, shaft = "rotor", q_values = "amplitude";
  int id = -1;  // -1: the bus's own first
};

// Exit code. Throws std::invalid_argument, std::system_error.
int acquire_axis(const AcquireWords& words, const AxisAcquireWords& axis, const AcquirePlan& plan,
                 const std::string& plan_text);

}  // namespace omnihil
