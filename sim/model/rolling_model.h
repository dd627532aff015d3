// The robot that rolls (rolling_robot.h) as a model file gives it.
//
//   RollingParams<double> p = rolling_params(model.parameters);
#pragma once
#include "sim/model/params.h"
#include "sim/robot/rolling_params.h"

namespace omnihil {

// Numbers that the table lacks stay at the struct's defaults; a tyre is there when the file gives one.
RollingParams<double> rolling_params(const ParameterTable& table);

}  // namespace omnihil
