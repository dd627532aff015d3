// Words and figures of a report: numbers as a reader wants them, the verdict in a sentence.
//
//   figure(0.0012345);                   // "0.00123"
//   verdict_sentence(diagnosis);         // "The model lacks cogging: with it the held-out error of …"
#pragma once
#include <string>
#include <string_view>

#include "hil/text/markup.h"
#include "identify/select/diagnosis.h"

namespace omnihil {

// Three significant digits; "∞" and "–" for what is not a number.
std::string figure(double value);
// "−62 %": how much smaller (or larger) `to` is than `from`.
std::string change_percent(double from, double to);

// The use by which a model is judged: holdout where there is one, else fit.
Split judging_split(const Comparison& comparison);
std::string verdict_sentence(const Diagnosis& diagnosis);

// The ladder as a report shows it: that of the diagnosis, or of an early end what there is of it.
std::vector<LadderStep> ladder_shown(const Diagnosis& diagnosis);

// Whether a use was compared at all.
bool has_split(const Comparison& comparison, Split split);

// Whether the fit got as far as a model.
bool has_model(const FitResult& fit);

}  // namespace omnihil
