// What is left when no effect earns its place any more: nothing, or structure; and what that means.
//
//   ResidualExcess rest = residual_excess_of(uses, null, baseline, last);
//   Verdict v = verdict_of(rest, effects_added);
//
// Structure remains where the error energy that no addition took is above the simulated null by more than its
// replicates scatter AND by a size that matters. Both are said in words. Limits (our choice, held by the
// hidden-effect tests): kStructure above the floor; of what was there at first, kUnexplained of it.
#pragma once
#include <string>

#include "identify/select/acceptance.h"
#include "identify/select/diagnosis.h"

namespace omnihil {

struct ResidualExcess {
  double excess = 0.0;           // error energy over the null's, less 1: of the signal where it is largest
  double excess_before = 0.0;    // the same of the refitted baseline
  double spread = 0.0;           // of the null's replicates, relative, that signal
  double relative_error = 0.0;   // root mean square over the standard deviation of the signal, that signal
  double unexplained = 0.0;      // share of the baseline's excess that is left, mean over the signals
  double autocorrelation = 1.0;  // samples that say one thing: of that signal's residual over the null's
  std::string signal;
};

// Counted in signals as they are seen, not whitened: how large it is to somebody who looks.
ResidualExcess residual_excess_of(const Predictor& predictor, const ComparedChannels& channels,
                                  const Candidate& baseline, const Candidate& last, std::uint64_t seed,
                                  int jobs);

bool structure_remains(const ResidualExcess& rest, bool effects_added);
// The same question of a whitened residual: what a coarse sensor's noise hides from the eye may stand out
// there.
bool structure_in(const WhitenedResiduals& residuals, const NullModel& null, const ComparedChannels& channels,
                  const Eigen::VectorXd& residual);
std::string residual_sentence(const ResidualExcess& rest, bool effects_added);

}  // namespace omnihil
