// Residual energy above the simulated null once no effect is accepted any more, and what it means.
//
//   ResidualExcess e = ResidualExcesses(context, baseline, model, seed, jobs).alike();
//   structure_remains(e, effects_added);  residual_sentence(e, effects_added);
//
// Structure remains where the residual's energy is above the null by several standard deviations of its
// replicates AND by a share that matters; beside an added effect also more than a share of what the baseline
// left has to remain. The shares are tuned (verdict.cc), held by the hidden-effect tests. What is above the null on
// runs of another kind (extrapolation) may be parameters that the fit runs do not tell: it is structure when a fit to all runs
// leaves it, too.
#pragma once
#include <functional>
#include <string>

#include "identify/select/acceptance.h"
#include "identify/select/diagnosis.h"
#include "identify/select/refit.h"
#include "identify/select/selection_context.h"

namespace omnihil {

// Excess of each channel's mean square over the null's, as a share of that: [channel]; 0 as chance leaves it, -1 nothing. A
// measured bus is an input of the model, whose residual is no structure of the drive: of it nothing is left.
Eigen::VectorXd excess_of(const WhitenedResiduals& residuals, const NullModel& null,
                          const ComparedChannels& channels, const Eigen::VectorXd& residual);

// Of the channel where the excess is largest, in unweighted energy.
struct ResidualExcess {
  double excess = 0.0;         // energy over the null's mean, less 1
  double excess_before = 0.0;  // the same of the refitted baseline
  double spread =
      0.0;  // standard deviation of the null's replicates over their mean, and of the noise's level
  double unexplained = 0.0;        // fraction of the baseline's excess that remains, mean over all channels
  double noise_level_sigma = 0.0;  // ComparedSignal; part of spread
  std::string signal{};
  double rms = 0.0;  // of that signal's residual, in its unit
  std::string unit{};
  Split split = kTraining;  // the runs
};
// Of a model, above the null that is simulated of it; the runs themselves when they are asked for.
class ResidualExcesses {
 public:
  // What `context` has by reference outlives it.
  ResidualExcesses(const SelectionContext& context, const Candidate& baseline, Candidate model,
                   std::uint64_t seed, int jobs);
  ResidualExcess alike() const;    // on held-out runs, of the fit runs' kind; without any on the fit runs
  ResidualExcess fitted() const;   // on fit runs
  ResidualExcess another() const;  // on extrapolation runs; without any no excess

 private:
  ResidualExcess on(Split split) const;

  const SelectionContext& context_;
  const Candidate& baseline_;
  Candidate model_;
  int jobs_;
  NullModel null_;
};

// The model with its numbers fitted to all runs, those of another kind included, from where it is. setup: of the dataset.
Candidate fitted_to_all_runs(const Dataset& dataset, const RefitSetup& setup, const Candidate& model);

bool structure_remains(const ResidualExcess& excess, bool effects_added);
// The same question of a whitened residual: what a coarse sensor's noise hides in the unweighted one may show
// there.
bool structure_in(const WhitenedResiduals& residuals, const NullModel& null, const ComparedChannels& channels,
                  const Eigen::VectorXd& residual);
std::string residual_sentence(const ResidualExcess& excess, bool effects_added);
// Against an effect that draws random numbers, of the model that has it: its noise is not in the record. Empty: it may be.
std::string too_noisy(const ResidualExcess& excess);

// Where structure shows: on held-out runs; on fit runs, since those may lack the motion that shows it; on runs of another kind,
// unless a fit to all runs does not leave it there. Nowhere: the held-out runs' excess.
struct Remaining {
  ResidualExcess excess;
  std::string of_parameters;  // for people: an excess that other numbers of this model explain; empty: none
};
std::string sentence_of(const Remaining& left, bool effects_added);
inline constexpr const char* kSearchInterrupted =
    "Structure remains, and the search was interrupted: not every effect was tried.";
Outcome outcome_of(bool searched, bool effects_added, bool remains);
// alike: excesses.alike(); another_of_all: on extrapolation runs, of the model fitted to all runs.
Remaining remaining(const ResidualExcesses& excesses, const ResidualExcess& alike, bool effects_added,
                    const std::function<ResidualExcess()>& another_of_all);

}  // namespace omnihil
