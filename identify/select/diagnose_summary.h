// The lists of a diagnosis: confounded sets, lost commands, and the variables that explain the residual.
#pragma once
#include "identify/estimate/heard_commands.h"
#include "identify/select/selection_iteration.h"

namespace omnihil {

// Adds the set of the chosen effect with the candidates that are confounded with it, and that of the effect
// with the base parameter that its signal is aliased with.
void note_confounded(const Iteration& iteration, Diagnosis& diagnosis);

// An effect that was accepted for the variance it explains, in the first ranking; the only one found goes first there.
void note_noise_effect(const std::string& name, double explained, std::vector<ParameterEstimate> parameters,
                       Diagnosis& diagnosis);

// The simpler of two nested laws takes the richer one's place. They leave the same error, so the richer one is among
// what cannot be told apart from it.
void replace_in_answer(const std::string& richer, const std::string& simpler, Diagnosis& diagnosis);

// At the end: sets of an effect that was removed again go, and from the others the members that are in the answer
// themselves, since a later iteration decided for both. Where losses before the winding were not searched
// (hides_losses_before_winding) each law of the shaft may be one; where the motion is a reported speed (takes_speed_as_reported)
// a lag of command or shaft may be that of its low pass.
void settle_confounded(const Dataset& dataset, Diagnosis& diagnosis);

// The variables that explain most of a comparison's residual, the largest fraction first; `order`: dominant
// in the residual along the rotor's angle, 0: none.
std::vector<Where> where_of(const Comparison& comparison, double order);

inline constexpr const char* kInterrupted = "interrupted before any effect was tried";
// Why no effect was tried; "": one was. misleading: a fault of the data kept the search from beginning.
std::string reason_not_searched(const Diagnosis& diagnosis, bool misleading, bool stopped);

// A note per run that lost some.
std::vector<DataFinding> lost_commands(const HeardCommands& heard);

}  // namespace omnihil
