// Is the gain of an addition its own? Base parameters fitted beside it, or the shorter steps that its law is simulated in, gain
// as well, and would with any law that does nothing.
//
//   const Candidate idle = with_idle_effect(model, "torque_ripple");    // the same base parameters and steps
//   gain_not_its_own(training, with.residual[kTraining], training.residual(idle));    // why not; empty: it is
//   gain_not_its_own(training, with, "torque_ripple", 1);                             // the same in one
//
// Idle is a millionth of its strengths: a neutral law is left out, and its steps with it. A law without steps of its own is taken
// out (a dead band of next to nothing still lets a bridge coast at zero duty), and one with impacts, too (at next to no play it is
// its contact's compliance, another law): of a play the steps' part is not seen.
//
// And the other way round: does it need the base numbers that it moves out of what is known of them?
//
//   if (auto held = accepted_at_belief(task, setup, parent, with, refused, "quadratic_drag", ratio)) acceptance = *held;
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

Candidate with_idle_effect(const Candidate& model, const std::string& name);

// Residuals of the fit runs, whitened: with the effect, and with it idle.
std::string gain_not_its_own(const WhitenedResiduals& training, const Eigen::VectorXd& with,
                             const Eigen::VectorXd& idle);
std::string gain_not_its_own(const WhitenedResiduals& training, const Fitted& with, const std::string& name,
                             int jobs);

// What an addition that keeps this share of its gain with the numbers held does not need them for: a choice.
inline constexpr double kGainKept = 0.9;  // a choice

// Of an addition refused for moved numbers alone, by a decisive gain. Empty: it is not that, or its gain needs them.
std::optional<AcceptanceResult> accepted_at_belief(const SelectionTask& task, const RefitSetup& setup,
                                                   const Fitted& parent, const Fitted& child,
                                                   const AcceptanceResult& refused, const std::string& name,
                                                   double signal_to_null);

}  // namespace omnihil
