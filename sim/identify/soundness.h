// Are the numbers that an addition was fitted with such as a drive can have?
//
//   std::string why = unsound(parent.fit, child.fit, "cogging", false);   // empty: nothing against it
//
// Against it: a shape at its bound, a sign that is not physical, a strength that is not told from zero (one
// by one or together, Wald), a base parameter pushed out of the tolerance that the model file states.
#pragma once
#include <string>

#include "sim/identify/fit.h"

namespace omnihil {

// `plain`: the addition takes so much that its strength is no question, however it trades against its shapes.
std::string unsound(const FitResult& parent, const FitResult& child, const std::string& name, bool plain);

}  // namespace omnihil
