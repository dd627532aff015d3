// Where an effect's parameter may lie, and what it is called, on a rotary drive and on a linear axis.
//
//   const EffectParam& row = find_effect("cogging")->info->params[0];
//   param_key(row, true);               // "amplitude_N"
//   param_range(row, true, 1.0).upper;  // in N: linear_scale.h
#pragma once
#include <string>

#include "sim/law/effect.h"

namespace omnihil {

// "amplitude_Nm" -> "amplitude_N" where the axis is linear; angles that go round (phases) are kept.
std::string param_key(const EffectParam& row, bool linear);

// Bounds and prior scale; forces of a linear axis may be a thousand times what torques of a motor may be,
// its speeds in m/s a thousandth of theirs in rad/s.
struct ParamRange {
  double lower = 0.0;
  double upper = 0.0;
  double prior_scale = 0.0;
  double scale = 1.0;  // over the row's own numbers (linear_scale.h)
};
// torque_scale: how much stronger the drive is than those that the row's numbers are of; torques and what is a torque
// per something grow with it.
ParamRange param_range(const EffectParam& row, bool linear, double torque_scale);

// The strongest drive that a model file may be of, over a robot's: 100 N m in place of 0.1. A choice.
inline constexpr double kStrongestDrive = 1000.0;

// What a model file may say: "0 to 10000 N m"; the same in N where the axis is linear
std::string allowed_range(const EffectParam& row, bool linear);

}  // namespace omnihil
