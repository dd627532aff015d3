// A residual that no known effect explains: the variables that it depends on, as curves, and a formula.
//
//   UnknownStructure u = unknown_structure(task, last, comparison, {});
//   u.expression_toml;   // [effects.expression.residual] …, ready to paste
//   // empty: no formula passes the acceptance test
//
// A library of physical terms (constant, sign, size, squares and products of speed, torque, current, back-EMF
// and duty; sine and cosine of the residual's strongest orders, also those of the output's turn) is added to
// the model one by one as a formula; each term's signal comes from a simulation, so no record is
// differentiated. Orthogonal forward selection (Chen, Billings, Luo 1989) against the simulated null takes up
// to four terms of one place (torque or voltage); the formula is then refitted as an effect and takes the
// acceptance test like any other.
// Cannot: memory (hysteresis, delays), functions of time or temperature, more than four terms; of the motor's torque where the
// motion is imposed.
#pragma once
#include <functional>

#include "identify/select/selection_iteration.h"

namespace omnihil {

UnknownStructure unknown_structure(const SelectionTask& task, const Fitted& last,
                                   const Comparison& comparison, const std::function<bool()>& stop);

}  // namespace omnihil
