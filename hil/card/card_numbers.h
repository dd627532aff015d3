// The numbers of a model as a card lists them: value, unit, interval, origin.
//
//   std::vector<CardNumber> numbers = card_numbers(candidate);      // the base parameters
//   std::vector<CardEffect> effects = card_effects(candidate);      // in the order of candidate.effects
//
// The interval is 95 % of a normal distribution: value +- 1.96 sigma (of the fit), or value (1 +- 1.96 tolerance) (of the
// belief). A number without a tolerance is said to be taken as exact, which is a claim of the model's author.
#pragma once
#include <vector>

#include "hil/card/model_card.h"
#include "identify/predict/candidate.h"

namespace omnihil {

inline constexpr double kSigmasOf95Percent = 1.96;  // normal distribution, two-sided

std::vector<CardNumber> card_numbers(const Candidate& candidate);
std::vector<CardEffect> card_effects(const Candidate& candidate);  // without evidence

}  // namespace omnihil
