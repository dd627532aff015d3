// One row of a ranking: what the selection found out about one effect.
//
//   const Diagnosis diagnosis;   // see diagnosis.h
//   for (const RankedEffect& r : diagnosis.ranking) {
//     r.selection_frequency;  // 0.98: it leaves the least error in 98 % of the draws
//     accepted_by_name(r.accepted_by);  // "gain", "prior", "noise"; "": refused
//   }
//
// Cannot: none of these numbers is the probability that the effect is present. The selection frequency
// (Sauerbrei, Schumacher 1992) says how stable the choice among the candidates is when the held-out blocks
// are drawn again.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "identify/estimate/evidence.h"
#include "identify/estimate/fit.h"

namespace omnihil {

// What an effect was accepted for.
enum class AcceptedBy : std::uint8_t {
  kNone,   // refused
  kGain,   // it lowers the error of the held-out runs
  kPrior,  // little gain, but with it a base parameter returns to its prior (plausibility.h)
  kNoise,  // it explains where the residual's variance is large, not its mean (noise_effect.h)
};
std::string_view accepted_by_name(AcceptedBy by);  // "", "gain", "prior", "noise"

// Could these data have shown the effect at its typical size?
enum class Visibility : std::uint8_t {
  kVisible,
  kAliased,     // no: a base parameter produces the same signal
  kBelowNoise,  // no: its gain would be within what the simulated null gives
  kUnresolved,  // no: the rows lie too far apart to know the angle that it depends on
  kNotTried,    // not known: interrupted, or the model diverged with it
};

struct RankedEffect {
  std::string effect;
  // Share of the bootstrap's draws in which no candidate leaves less error (those that leave as little share
  // the draw); at most 1 in sum. 0 where it was not refitted.
  double selection_frequency = 0.0;
  AcceptedBy accepted_by = AcceptedBy::kNone;
  double noise_share = 0.0;  // of the variance above the sensors' noise, by bins; 0: not accepted as noise
  double score = 0.0;        // of the screening: share of the residual's energy, that of the null subtracted
  double fit_error_ratio = 1.0;  // pooled error with the effect over that of the refitted baseline
  double holdout_error_ratio = 1.0;
  double extrapolation_error_ratio = 1.0;
  bool refitted = false;  // false: screening alone
  Visibility visibility = Visibility::kVisible;
  std::string why;                            // for people: why it was accepted or refused
  std::vector<ParameterEstimate> parameters;  // of the effect
  bool plausible = true;                      // refitted: its numbers and those of the base (plausibility.h)
  double signal_to_null = 0.0;                // of the screening: gain over the largest in the simulated null
  double share_of_base = 0.0;  // refitted: what it removes of the base model's energy above the noise
  Evidence evidence{};         // refitted: what standard rules of selection say

  bool accepted() const { return accepted_by != AcceptedBy::kNone; }
};

}  // namespace omnihil
