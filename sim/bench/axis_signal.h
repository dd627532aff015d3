// Signals of a simulated axis by name, for plots and files.
//
//   const AxisSignal* s = find_axis_signal("velocity");
//   s->get(sample, input, k);                              // rad/s
#pragma once
#include <cstddef>
#include <string_view>

#include "sim/bench/axis_sim.h"

namespace omnihil {

struct AxisSignal {
  std::string_view name;
  std::string_view unit;
  double (*get)(const AxisSample<double>&, const AxisInput&, std::size_t);
};

const AxisSignal* find_axis_signal(std::string_view name);  // null: there is none

// The name of a drive input in a measurement: "duty", "motor_voltage", …
std::string_view command_name(CommandKind kind);

}  // namespace omnihil
