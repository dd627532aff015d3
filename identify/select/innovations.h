// The selection once more by the innovations: where nothing more is accepted by the plain residual, whose slow part that no law
// explains hides what is fast.
//
//   test_by_innovations(task, parent, child, "cogging").why;    // the same gates: "by the innovations: held-out error …"
//   choice_by_innovations(task, setup, parent, iteration);      // the effect that is accepted so, fitted; none: none is
//
// Method: all residuals are flattened by the spectrum that the parent's has on the fit runs (residual_spectrum.h), the null's as
// well; screening and acceptance test are those of selection_iteration.h on what comes out. The fits are those of the plain
// residual; the numbers of an effect that is accepted so are fitted once more to the innovations, the others held.
// Limits: one spectrum for all runs; the null's level of other runs is that of the fit runs, in the proportion of their
// plain energies; base parameters stay those of the plain fit.
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
  // gain_not_its_own() of an effect of the model.
  std::string not_its_own(const Candidate& model, const std::string& name) const;
  // Does the model leave less by as much as is asked of the fit runs? Others need no sigmas.
  bool is_worth(const Fitted& model) const;
  // The same with the sigmas that its numbers have by the innovations (posterior, as fit.h).
  Fitted with_sigmas(const Fitted& model) const;
  // Weighted least squares in the unknowns `own` (indices of FitResult::unknowns), the others held: Gauss-Newton, at most a few
  // steps, none that leaves more. The residual is the plain one.
  Fitted refitted(Fitted model, const std::vector<Eigen::Index>& own) const;
  // The screened effects with the gains that they have here, base parameters free.
  std::vector<Screened> screened(const std::vector<Screened>& plain) const;

 private:
  struct Linearised {
    Eigen::MatrixXd jacobian, information;  // n x p, p x p, per unit of the unknowns' scales
  };
  Linearised linearised(const FitResult& fit) const;

  SelectionTask task_;
  ResidualSpectrum spectrum_;
  NullModel null_;
  Residuals base_;
  Fitted parent_;
};

// Of an addition that the plain residual refuses.
AcceptanceResult test_by_innovations(const SelectionTask& task, const Fitted& parent, const Fitted& child,
                                     const std::string& name);

// The model with the numbers of these effects as the innovations have them, the others as they are: a plain sum of squares
// leaves to chance what only the innovations show. No effects: the model itself.
Fitted numbers_by_innovations(const SelectionTask& task, Fitted model,
                              const std::vector<std::string>& effects);

struct InnovationChoice {
  Iteration iteration;  // its residuals are the innovations
  Fitted fitted;        // the chosen one's, to convergence; its residuals are the plain ones
};
// None: nothing is accepted by the innovations either. `thorough`: of the fit of the chosen one.
std::optional<InnovationChoice> choice_by_innovations(const SelectionTask& task, const RefitSetup& thorough,
                                                      const Fitted& parent, const Iteration& plain);

}  // namespace omnihil
