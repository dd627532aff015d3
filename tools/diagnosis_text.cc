#include "tools/diagnosis_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <ranges>

#include "identify/select/confidence.h"

namespace omnihil {
namespace {

constexpr std::size_t kRankingLines = 8;

std::vector<std::string> signals_of(const Comparison& comparison) {
  std::vector<std::string> names;
  for (const SignalError& e : comparison.errors) {
    if (std::find(names.begin(), names.end(), e.signal) == names.end()) names.push_back(e.signal);
  }
  return names;
}

const char* split_word(Split split) {
  return split == Split::kValidation ? "held out" : split_name(split).data();
}

std::string findings_text(const Diagnosis& d) {
  static constexpr const char* kGrades[] = {"note", "doubt", "FAULT"};
  std::string out;
  for (const DataFinding& f : d.findings) {
    out += fmt::format("  {:5}  {}\n", kGrades[static_cast<int>(f.grade)], f.sentence);
  }
  return out.empty() ? "" : "Data\n" + out + "\n";
}

// "constant_load or friction_asymmetry": an effect and those that these data cannot tell from it.
std::string with_confounded(const Diagnosis& d, const std::string& effect) {
  for (const ConfoundedSet& set : d.confounded) {
    if (set.members.front() == effect && is_of_effects(set))
      return fmt::format("{}", fmt::join(set.members, " or "));
  }
  return effect;
}

std::string verdict_text(const Diagnosis& d) {
  std::string out = fmt::format("Verdict: {}", outcome_name(d.outcome));
  auto [likely, unlikely] = names_by_likelihood(d);
  for (std::string& e : likely) e = with_confounded(d, e);
  for (std::string& e : unlikely) e = with_confounded(d, e);
  if (!d.effects.empty()) out += ": ";
  out += fmt::format("{}", fmt::join(likely, ", "));
  if (!unlikely.empty())
    out += fmt::format("{}perhaps {}", likely.empty() ? "" : "; ", fmt::join(unlikely, ", perhaps "));
  const bool faulty = d.outcome == Outcome::kNotSearched && first_fault(d.findings) != nullptr;
  if (!d.not_searched.empty()) out += fmt::format(" ({})", d.not_searched);
  out += "\n";
  if (faulty) out += "  Mend the data, or search all the same with --anyway.\n";
  if (!d.searched_despite.empty()) {
    out += fmt::format("  Searched past a fault of the data; what was found may be that fault: {}\n",
                       d.searched_despite);
  }
  if (!d.complete) out += "  Interrupted: this is what was known by then.\n";
  if (!d.unknown.sentence.empty() && d.not_searched.empty()) out += "  " + d.unknown.sentence + "\n";
  if (const std::string how_sure = confidence_sentence(d); !how_sure.empty()) out += "  " + how_sure + "\n";
  for (const ConfoundedSet& set : d.confounded) out += "  " + set.sentence + "\n";
  return out + "\n";
}

std::string ladder_text(const Diagnosis& d) {
  std::string out = "Error, step by step\n";
  for (const LadderStep& step : d.ladder) {
    out += "  " + step.added + "\n";
    std::string errors = errors_text(step.comparison);
    for (std::size_t at = 0; at < errors.size();) {
      const std::size_t end = errors.find('\n', at);
      out += "  " + errors.substr(at, end - at + 1);
      at = end + 1;
    }
  }
  return out + "\n";
}

// "98 %" of the draws; "prior", "noise": no gain decided, so no share of draws tells anything.
std::string selection_text(const RankedEffect& r) {
  if (r.accepted_by == AcceptedBy::kPrior || r.accepted_by == AcceptedBy::kNoise)
    return std::string(accepted_by_name(r.accepted_by));
  return fmt::format("{:.0f} %", 100.0 * r.selection_frequency);
}

// Of each further iteration, what was refitted: why it was taken or not.
std::string later_rankings(const Diagnosis& d) {
  std::string out;
  for (const LadderStep& step : steps_after_first_ranking(d)) {
    if (step.ranking.empty()) continue;
    out += fmt::format("After {}\n", step.added);
    for (const RankedEffect& r : step.ranking) {
      if (!r.refitted) continue;
      out += fmt::format("  {:>5}  {:26}  held-out error x {:.3f}  {}\n", selection_text(r), r.effect,
                         r.holdout_error_ratio, r.why);
    }
  }
  return out;
}

std::string ranking_text(const Diagnosis& d) {
  if (d.ranking.empty()) return "";
  std::string out =
      "First ranking (share of bootstrap draws that select it; prior, noise: accepted by that)\n";
  for (std::size_t i = 0; i < d.ranking.size() && i < kRankingLines; ++i) {
    const RankedEffect& r = d.ranking[i];
    out += fmt::format("  {:>5}  {:26}  held-out error x {:.3f}  {}\n", selection_text(r), r.effect,
                       r.holdout_error_ratio, r.why);
  }
  return out + later_rankings(d) + "\n";
}

std::string where_text(const Diagnosis& d) {
  if (d.where.empty()) return "";
  std::string out = d.verdict == Verdict::kUnknown ? "What the residual depends on\n"
                                                   : "What the base model's error depends on\n";
  for (const Where& w : d.where) {
    out += fmt::format("  {} against {}: {:.0f} %{}\n", w.signal, w.against, 100.0 * w.explained_fraction,
                       w.order > 0.0 ? fmt::format(", order {:g} stands out", w.order) : "");
  }
  return out + "\n";
}

}  // namespace

std::string errors_text(const Comparison& comparison) {
  std::string out;
  for (const std::string& signal : signals_of(comparison)) {
    std::string line;
    for (const SignalError& e : comparison.errors) {
      if (e.signal != signal) continue;
      if (line.empty()) line = fmt::format("  {:20} {:6}", signal, e.unit);
      line += fmt::format("  {} {:.4g} ({:.2f} %)", split_word(e.split), e.rmse, e.nrmse_percent);
    }
    out += line + "\n";
  }
  return out;
}

std::string errors_change_text(const Comparison& before, const Comparison& after) {
  std::string out;
  for (const std::string& signal : signals_of(before)) {
    std::string line;
    for (const SignalError& e : before.errors) {
      const SignalError* now = after.error(e.split, signal);
      if (e.signal != signal || now == nullptr) continue;
      if (line.empty()) line = fmt::format("  {:20} {:6}", signal, e.unit);
      line += fmt::format("  {} {:.4g} -> {:.4g}", split_word(e.split), e.rmse, now->rmse);
    }
    out += line + "\n";
  }
  return out;
}

std::string parameters_text(const std::vector<ParameterEstimate>& parameters,
                            const std::vector<ParameterEstimate>& of_file) {
  std::string out;
  for (const ParameterEstimate& p : parameters) {
    out += fmt::format("  {:40} {:.5g} +- {:.2g} {}", p.path, p.value, p.sigma, p.unit);
    const bool given = std::any_of(of_file.begin(), of_file.end(),
                                   [&](const ParameterEstimate& f) { return f.path == p.path; });
    if (given && p.prior_sigma > 0.0 && p.prior_mean != 0.0) {
      out += fmt::format("  ({:+.1f} % of the belief, {:+.1f} sigma)", 100.0 * (p.value / p.prior_mean - 1.0),
                         p.prior_deviation_sigmas);
    }
    out += p.sentence.empty() ? "\n" : "  " + p.sentence + "\n";
  }
  return out;
}

std::string diagnosis_text(const Diagnosis& d) {
  std::string out = findings_text(d) + verdict_text(d) + ladder_text(d) + ranking_text(d) + where_text(d);
  out += "Parameters of the last model\n" + parameters_text(d.final_fit.parameters, d.baseline.parameters) +
         "\n";
  if (!d.unknown.expression_toml.empty()) {
    out += "A formula for the residual, to paste into the model\n" + d.unknown.expression_toml + "\n";
  }
  if (!d.next_experiment.what.empty()) out += "Next: " + d.next_experiment.what + "\n";
  if (!d.next_experiment.command.empty()) out += "  " + d.next_experiment.command + "\n";
  return out;
}

}  // namespace omnihil
