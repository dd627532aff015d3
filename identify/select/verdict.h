// Residual energy above the simulated null once no effect is accepted any more, and what it means.
//
//   ResidualExcess e = residual_excess_of(predictor, channels, baseline, last, seed, jobs);
//   structure_remains(e, effects_added);  residual_sentence(e, effects_added);
//
// Structure remains where the residual's energy is above the null by several standard deviations of its
// replicates AND by a share that matters; beside an added effect also more than a share of what the baseline
// left has to remain. The shares are tuned (verdict.cc), held by the hidden-effect tests.
#pragma once
#include <string>

#include "identify/select/acceptance.h"
#include "identify/select/diagnosis.h"

namespace omnihil {

// Of the channel where the excess is largest, in unweighted energy.
struct ResidualExcess {
  double excess = 0.0;         // energy over the null's mean, less 1
  double excess_before = 0.0;  // the same of the refitted baseline
  double spread = 0.0;         // standard deviation of the null's replicates, over their mean
  double unexplained = 0.0;    // fraction of the baseline's excess that remains, mean over all channels
  std::string signal{};
  double rms = 0.0;  // of that signal's residual, in its unit
  std::string unit{};
  bool held_out = false;  // on held-out runs; else on the fit runs
};

// On held-out runs, else on fit runs.
ResidualExcess residual_excess_of(const Predictor& predictor, const ComparedChannels& channels,
                                  const Candidate& baseline, const Candidate& last, std::uint64_t seed,
                                  int jobs);

bool structure_remains(const ResidualExcess& excess, bool effects_added);
// The same question of a whitened residual: what a coarse sensor's noise hides in the unweighted one may show
// there.
bool structure_in(const WhitenedResiduals& residuals, const NullModel& null, const ComparedChannels& channels,
                  const Eigen::VectorXd& residual);
std::string residual_sentence(const ResidualExcess& excess, bool effects_added);

}  // namespace omnihil
