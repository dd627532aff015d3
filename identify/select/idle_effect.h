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
#pragma once
#include <string>

#include "identify/select/acceptance.h"

namespace omnihil {

Candidate with_idle_effect(const Candidate& model, const std::string& name);

// Residuals of the fit runs, whitened: with the effect, and with it idle.
std::string gain_not_its_own(const WhitenedResiduals& training, const Eigen::VectorXd& with,
                             const Eigen::VectorXd& idle);
std::string gain_not_its_own(const WhitenedResiduals& training, const Fitted& with, const std::string& name,
                             int jobs);

}  // namespace omnihil
