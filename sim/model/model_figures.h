// What follows from a model's numbers: the figures by which a person recognises a motor or a robot.
//
//   for (const ModelFigure& f : model_figures(model)) std::cout << f.name << f.value << f.unit << f.formula;
//
// Steady-state and static formulas (eq. 7, friction, gear, statics); no simulation is run. Top speeds hold
// for the nominal bus voltage and leave out tyre slip and roller drag.
#pragma once
#include <string>
#include <vector>

#include "sim/model/model_file.h"

namespace omnihil {

struct ModelFigure {
  std::string name;
  double value = 0.0;
  std::string unit;
  std::string formula;
};

// Of the motor at a voltage: friction is part of the no-load figures.
std::vector<ModelFigure> motor_figures(const MotorParams& motor, double voltage_V);
std::vector<ModelFigure> robot_figures(const RobotModel& robot);

// Those that apply to the model's rig.
std::vector<ModelFigure> model_figures(const ModelFile& model);

}  // namespace omnihil
