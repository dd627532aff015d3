// Does an addition's gain need the base numbers that it moves out of what is known of them?
//
//   if (auto held = accepted_at_belief(task, setup, parent, fitted, acceptance, "quadratic_drag")) acceptance = *held;
//
// The form of a law is never quite a drive's, and where what that leaves is seen, a fit trades it for a base number that the same
// rows tell (a drag of the air for the viscous friction, which went to zero: -3.3 sigma, for 2 % of the gain). The addition is
// fitted once more with those numbers held at what is believed of them, and tested as any other. Numbers that it needs (a
// constant of the motor that it stands in for) take the gain with them.
#pragma once
#include <optional>
#include <string>

#include "identify/select/selection_iteration.h"

namespace omnihil {

// What an addition that keeps this share of its gain with the numbers held does not need them for: a choice.
inline constexpr double kGainKept = 0.9;  // a choice

// Of an addition refused for moved numbers alone, by a decisive gain. Empty: it is not that, or its gain needs them.
std::optional<AcceptanceResult> accepted_at_belief(const SelectionTask& task, const RefitSetup& setup,
                                                   const Fitted& parent, const Fitted& child,
                                                   const AcceptanceResult& refused, const std::string& name,
                                                   double signal_to_null);

}  // namespace omnihil
