// What `omnihil acquire` does with a plan of one axis: opens the bus or the board, drives the runs, writes the measurement.
//
//   if (of_axis(plan.drive)) exit_code = acquire_axis(words, plan, plan_text);
#pragma once
#include <string>

#include "hil/acquire/acquire_plan.h"

namespace omnihil {

struct AxisAcquireWords {
  std::string device, bus, model, out, shaft = "rotor", q_values = "amplitude";
  int id = -1;  // -1: the bus's own first
  int runs = 0;
  bool dry_run = false, resume = false, confirm = false;
};

// Exit code. Throws std::invalid_argument, std::system_error.
int acquire_axis(const AxisAcquireWords& words, const AcquirePlan& plan, const std::string& plan_text);

// Waits for Enter before a run; false: the input has ended.
bool confirm_run(const PlanRun& run, const char* what);
std::string text_hash(std::string_view text);

}  // namespace omnihil
