// How often a name like this one was right: the probability that a named effect, or one of those that the data cannot
// tell from it, is there.
//
//   Diagnosis d;   // finished
//   for (const NameConfidence& c : confidences(d)) print(c.effect, c.probability);
//
// Logistic regression on what the search knew when it took the effect: was it the first; which share of the base model's
// error it removes; in how many bootstrap draws it won; is it undecided; and how far above the sensors' noise the last model
// stays. Where structure remains that nothing explains, another map: what imitates it removes less than it is, so the share
// over what remains takes the place of the share and of the noise. Fitted on the open cases of the hidden-effect test
// (tests/hidden_plant/calibrate.py: coefficients, reliability of cases that were not fitted to; docs/diagnosis-statistics.md).
// Limits: calibrated on made records of one effect, of two, of none and of one beside what is in no catalogue, in the test's
// proportions. On measured records it is an extrapolation.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "identify/select/diagnosis.h"

namespace omnihil {

struct NameEvidence {
  bool later = false;         // not the first name of the answer
  bool more_remains = false;  // Outcome::kMoreRemains
  double share_of_base = 1.0;
  double selection_frequency = 1.0;
  bool undecided = false;  // a set of several
  double error_over_noise =
      1.0;  // of the last model, held-out or fit runs, whichever is more, pooled over the signals
  double remaining_share = 0.0;  // energy above the noise of the last model over the base model's, likewise
};
double probability_right(const NameEvidence& evidence);

// One per name of the answer, in its order.
std::vector<NameConfidence> confidences(const Diagnosis& diagnosis);

// For people; empty: no name.
std::string confidence_sentence(const Diagnosis& diagnosis);

// The names of the answer, in its order; unlikely: more often wrong than right.
struct NamesByLikelihood {
  std::vector<std::string> likely, unlikely;
};
NamesByLikelihood names_by_likelihood(const Diagnosis& diagnosis);

}  // namespace omnihil
