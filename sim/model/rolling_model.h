// The robot that rolls (rolling_robot.h) as a model file gives it.
//
//   RollingParams<double> p = rolling_params(model.parameters);
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "sim/model/params.h"
#include "sim/rolling/rolling_params.h"

namespace omnihil {

// Numbers that the table lacks stay at the struct's defaults; a tyre is there when the file gives one.
RollingParams<double> rolling_params(const ParameterTable& table);

// As many as the robot has places for; a table without any is of four.
std::size_t wheel_count(const ParameterTable& table);

// {"duty_1", "duty_2", …}
std::vector<std::string> per_wheel(std::string_view signal, std::size_t wheels);

}  // namespace omnihil
