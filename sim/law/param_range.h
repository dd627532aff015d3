// Where an effect's parameter may lie, and what it is called, on a rotary drive and on a linear axis.
//
//   const EffectParam& row = find_effect("cogging")->info->params[0];
//   param_key(row, true);               // "amplitude_N"
//   param_range(row, true).upper;       // in N: linear_scale.h
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
ParamRange param_range(const EffectParam& row, bool linear);

// "0 to 10 N m"; "0 to 10000 N" where the axis is linear
std::string allowed_range(const EffectParam& row, bool linear);

}  // namespace omnihil
