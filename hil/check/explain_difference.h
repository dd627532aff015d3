// What of the model explains that the robot answers the same commands otherwise: its parameters and the catalogue's
// effects, one at a time, each run over the recording again; and where the best is certain, a second one beside it
// (explain_pair.h).
//
//   const DifferenceExplained all = explain_difference(recording, format, options);
//   all.headline;      // "found: motor.torque_constant_Nm_per_A 0.0245 -> 0.0257 Nm/A (+5.02 % +- 0.14 %); …", 95 %
//
// Method. r = measured - model, weighted by the white noise of each series (from second differences). A
// candidate's sensitivity j is the difference that a small change makes, same seed; its size by Gauss-Newton,
// a += <z, r> / <z, j> with a second sensitivity z as the instrument, each step run again, and where that ends from
// runs round it, with the standard error (explain_size.h). Found: removes a tenth of the squared difference at least, and its size is
// beyond chance by Student's t over all candidates (Bonferroni); perhaps: it only has smaller squared errors, block by
// block, than the model as it stands (paired t test; Diebold and Mariano 1995). Two candidates that the same test does
// not tell apart are both named.
// The firmware is told of a changed parameter as it is at a start: one that takes its constants from its code alone
// is not touched by that. Cannot: find two causes of which neither is seen alone, or a law that is not in the catalogue
// (what is left says so).
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "hil/check/explain_candidates.h"
#include "hil/check/explain_search.h"
#include "hil/recording/replay_run.h"
#include "protocols/radio_format.h"

namespace omnihil {

struct ExplainedBy {
  std::string name;  // "motor.torque_constant_Nm_per_A", "battery_sag.resistance_ohm"
  std::string unit;
  bool is_effect = false;
  double was = 0.0, is = 0.0;       // an effect was at its neutral value
  double sigma = 0.0;               // standard error of `is`; +- kExplainT of them: 95 %. Infinite: not known
  double share = 0.0;               // of the weighted squared difference that it removes, run again with it
  std::vector<double> block_error;  // weighted squared difference of each block of time, with it
};

struct DifferenceExplained {
  std::string headline;
  std::string why_not;             // not searched; empty: it was
  std::vector<ExplainedBy> found;  // the best, then what these data cannot tell from it
  std::vector<ExplainedBy>
      second;                   // a second cause, both refitted together, then what cannot be told from it
  bool second_certain = false;  // else it is a perhaps
  std::size_t tried = 0;
  double error_over_noise = 0.0;    // RMS of the difference by the noise, of the model as it stands
  double left_over_noise = 0.0;     // with the best, or with both
  std::vector<std::string> series;  // what was compared
};

// One candidate by itself: `j` its sensitivity, `r0` the difference to the model as it stands, both by the weights of
// `search`. Nothing where no size of it is closer.
std::optional<ExplainedBy> explained_by(const ExplainSearch& search, const ExplainCandidate& candidate,
                                        const Weighted& j, const Weighted& r0);

// `progress` is told of each candidate; may be empty. Throws as run_again does for the model as it stands.
DifferenceExplained explain_difference(
    const Recording& recording, const RadioFormat& format, const ReplayOptions& options,
    const std::function<void(std::size_t done, std::size_t all)>& progress = {});

// Several lines: the headline, what cannot be told from it, what was compared.
std::string explained_text(const DifferenceExplained& explained);

}  // namespace omnihil
