// The selection once more by the innovations: where nothing more is accepted by the plain residual, whose slow part that no law
// explains hides what is fast.
//
//   const Innovations view(task, parent);
//   test_by_innovations(task, parent, child, "cogging").why;    // the same gates: "by the innovations: held-out error …"
//   choice_by_innovations(task, refit_setup, parent, iteration);    // an effect that is accepted so, in the iteration's candidates
//
// Method: all residuals are flattened by the spectrum that the parent's has on the fit runs (residual_spectrum.h), the null's as
// well; screening and acceptance test are those of selection_iteration.h on what comes out. The fits are those of the plain
// residual: their optimum is where it was, less sharp than the innovations would have it.
// Limits: one spectrum for all runs; the null's level of other runs is that of the fit runs, in the proportion of their
// plain energies; what the answer reports are the numbers and sigmas of the plain fit, wider than the innovations have them.
#pragma once
#include <optional>
#include <string>

#include "identify/estimate/residual_spectrum.h"
#include "identify/select/selection_iteration.h"

namespace omnihil {

class Innovations {
 public:
  // What `task` has by reference outlives it.
  Innovations(const SelectionTask& task, const Fitted& parent);
  Innovations(const Innovations&) = delete;
  Innovations& operator=(const Innovations&) = delete;

  const AcceptanceContext& context() const { return task_.acceptance_context; }
  const SelectionTask& task() const { return task_; }
  const Fitted& parent() const { return parent_; }
  Fitted of(const Fitted& model) const;
  // Does the model leave less by as much as is asked of the fit runs? Others need no sigmas.
  bool is_worth(const Fitted& model) const;
  // The same with the sigmas that its numbers have by the innovations (posterior, as fit.h).
  Fitted with_sigmas(const Fitted& model) const;
  // The screened effects with the gains that they have here, base parameters free.
  std::vector<Screened> screened(const std::vector<Screened>& plain) const;

 private:
  SelectionTask task_;
  ResidualSpectrum spectrum_;
  NullModel null_;
  Residuals base_;
  Fitted parent_;
};

// Of an addition that the plain residual refuses.
AcceptanceResult test_by_innovations(const SelectionTask& task, const Fitted& parent, const Fitted& child,
                                     const std::string& name);

struct InnovationChoice {
  Iteration iteration;  // its residuals are the innovations
  Fitted fitted;        // the chosen one's, to convergence; its residuals are the plain ones
};
// None: nothing is accepted by the innovations either. `thorough`: of the fit of the chosen one.
std::optional<InnovationChoice> choice_by_innovations(const SelectionTask& task, const RefitSetup& thorough,
                                                      const Fitted& parent, const Iteration& plain);

}  // namespace omnihil
