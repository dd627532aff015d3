#include "hil/report/report_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "identify/select/confidence.h"

namespace omnihil {
namespace {

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0) text += i + 1 == words.size() ? " and " : ", ";
    text += words[i];
  }
  return text;
}

// "the held-out error falls from 12.1 to 1.3 times the noise (−89 %)"
std::string error_change(const Comparison& before, const Comparison& after) {
  const Split split = judging_split(before);
  const double from = before.pooled(split), to = after.pooled(split);
  if (!std::isfinite(from) || !std::isfinite(to)) return "its error cannot be stated";
  return fmt::format("the {} error {} from {} to {} times the noise ({})",
                     split == Split::kValidation ? "held-out" : "fitted", to <= from ? "falls" : "rises",
                     figure(from), figure(to), change_percent(from, to));
}

// "cogging and perhaps grease_drag"
std::string names_of(const Diagnosis& d) {
  const auto [likely, unlikely] = names_by_likelihood(d);
  if (unlikely.empty()) return joined(likely);
  return fmt::format("{}perhaps {}", likely.empty() ? "" : joined(likely) + " and ", joined(unlikely));
}

}  // namespace

std::string figure(double value) {
  if (std::isnan(value)) return "–";
  if (std::isinf(value)) return value > 0 ? "∞" : "−∞";
  return fmt::format("{}{:.3g}", value < 0 ? "−" : "", std::fabs(value));
}

std::string change_percent(double from, double to) {
  if (!(std::fabs(from) > 0.0) || !std::isfinite(from) || !std::isfinite(to)) return "–";
  const double percent = 100.0 * (to / from - 1.0);
  return fmt::format("{}{:.0f} %", percent < 0 ? "−" : "+", std::fabs(percent));
}

bool has_split(const Comparison& comparison, Split split) {
  return std::ranges::any_of(comparison.errors,
                             [split](const SignalError& e) { return e.split == split && e.samples > 0; });
}

bool has_model(const FitResult& fit) { return !fit.model.file.rig.empty(); }

Split judging_split(const Comparison& comparison) {
  return has_split(comparison, Split::kValidation) ? Split::kValidation : Split::kTraining;
}

std::vector<LadderStep> ladder_shown(const Diagnosis& d) {
  if (!d.ladder.empty()) return d.ladder;
  std::vector<LadderStep> steps;
  if (!d.nominal_comparison.errors.empty()) steps.push_back({"nominal", d.nominal_comparison, {}, {}});
  if (!d.baseline_comparison.errors.empty()) {
    steps.push_back({"base parameters refitted", d.baseline_comparison, d.baseline.parameters, {}});
  }
  return steps;
}

std::string verdict_sentence(const Diagnosis& d) {
  std::string text;
  if (d.outcome == Outcome::kNotSearched) {
    text = d.not_searched.empty() ? "No effect was searched for."
                                  : fmt::format("Not searched: {}", d.not_searched);
  } else if (d.verdict == Verdict::kEffect) {
    text = fmt::format("The model lacks {}: with {} {}.", names_of(d), d.effects.size() > 1 ? "them" : "it",
                       error_change(d.baseline_comparison, d.final_comparison));
  } else if (d.verdict == Verdict::kAdequate) {
    text = "The model is adequate: no known effect lowers the error by more than chance.";
  } else {
    text = d.unknown.sentence.empty() ? "The model lacks something that no known effect explains."
                                      : d.unknown.sentence;
    if (!d.effects.empty()) {
      text += fmt::format(" Of the known effects {} did help: {}.", names_of(d),
                          error_change(d.baseline_comparison, d.final_comparison));
    }
  }
  if (!d.searched_despite.empty()) {
    text = fmt::format("Searched past a fault of the data ({}); what was found may be that fault. {}",
                       d.searched_despite, text);
  } else if (first_fault(d.findings) != nullptr) {
    text = "The data have faults that can mislead; mend them first. " + text;
  }
  if (!d.complete) text = "Interrupted: what follows is true as far as it goes. " + text;
  return text;
}

}  // namespace omnihil
