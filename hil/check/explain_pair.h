// A second cause of a difference, where the first one leaves more than noise: searched round the model that has the first,
// both fitted together.
//
//   const auto pair = explain_second(search, best, others, slopes);
//   if (pair && pair->certain) …      // pair->first, pair->second: their sizes with the other beside them
//
// Method. Every other candidate is screened by what its sensitivity, of the first round, explains of what the first leaves
// (Frisch and Waugh 1933: both with the first projected out). The best are fitted together with it, noise weighed anew by
// what is left: two sizes by two instruments, as one by one in explain_difference.h. Then the first is put in question:
// every other candidate that was near it takes its place beside the second; the best pair is kept. Certain: the second
// removes a tenth of what the first leaves, the blocks of time agree that it is better, and both sizes are beyond chance
// by Student's t over the candidates of both rounds (Bonferroni).
// Cannot: two causes of which neither is seen alone; a third one (what is left says so).
#pragma once
#include <optional>
#include <vector>

#include "hil/check/explain_candidates.h"
#include "hil/check/explain_difference.h"
#include "hil/check/explain_search.h"

namespace omnihil {

// A candidate of the first round, and its size by itself.
struct FittedCandidate {
  const ExplainCandidate* candidate = nullptr;
  double value = 0.0;
};

// What a candidate changes, by the weights of the first round.
struct CandidateSlope {
  const ExplainCandidate* candidate = nullptr;
  Weighted j;
};

struct ExplainedPair {
  ExplainedBy first,
      second;  // shares: of the second, of what the first alone leaves; of the first, not computed
  std::vector<double> block_error;
  double left_over_noise = 0.0;
  bool certain = false;              // else: perhaps
  std::vector<ExplainedBy> instead;  // of the second, what these data do not tell from it
};

// Nothing where no second one makes it better. `search` is weighed anew. `others`: of the first round, beside the best.
std::optional<ExplainedPair> explain_second(ExplainSearch& search, const FittedCandidate& best,
                                            const std::vector<FittedCandidate>& others,
                                            const std::vector<CandidateSlope>& slopes);

}  // namespace omnihil
