// Are the numbers that an addition was fitted with such as a drive can have?
//
//   std::string why = unsound(parent.fit, child.fit, "cogging", false);   // empty: nothing against it
//
// Against it: a shape at its bound, a sign that is not physical, a strength that is not told from zero (one
// by one or together, Wald), a base parameter pushed out of the tolerance that the model file states.
#pragma once
#include <string>
#include <string_view>

#include "identify/estimate/fit.h"

namespace omnihil {

// How far the base model is from what its file says: the largest drift of a parameter of motor, load or
// supply that the data determine, in its tolerances.
struct PriorDeviation {
  double sigmas = 0.0;
  std::string path;
};
PriorDeviation largest_prior_deviation(const FitResult& fit);

// Above kBent a base parameter stands for something else: nobody's data sheet is that wrong. What lets it
// come back within kStraight, at no more error than kNoMore of its energy, has a claim to be what it stood
// for.
inline constexpr double kImplausible_sigmas = 4.0;
inline constexpr double kRestored_sigmas = 2.0;
inline constexpr double kMostEnergyRise = 0.01;

// Where data cannot part an effect from a base parameter (a payload from the mass), beliefs do. Above
// kDisbelieved (a normal error is that large one way once in a hundred) it is the effect, if the squares of
// all numbers' distances from their beliefs, the effect's own included, fall by as much.
inline constexpr double kPriorRejected_sigmas = 2.33;

// Tolerances between a base parameter and what its file says; 0: no such, or no tolerance.
double prior_deviation(const FitResult& fit, std::string_view path);

// Does the child hold what the parent bent most, and all else, within kStraight; or is it easier to believe,
// in the parameter that the effect stands for (Screened::aliased_parameter; empty: none)? The path of what came
// back; empty: no.
std::string restores_prior(const FitResult& parent, const FitResult& child,
                           std::string_view aliased_parameter = {});

// Is an effect's time (a delay, an inductance) so far below what its page calls visible at this rate that a
// model's sub-steps and a clock's last digits make as much? Empty: no.
std::string below_time_resolution(const FitResult& child, const std::string& name, double rate_Hz);

// `plain`: the addition takes so much that its strength is no question, however it trades against its shapes.
std::string implausibility(const FitResult& parent, const FitResult& child, const std::string& name,
                           bool decisive);

}  // namespace omnihil
