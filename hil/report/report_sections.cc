#include "hil/report/report_sections.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "hil/report/report_text.h"
#include "identify/select/confidence.h"

namespace omnihil {
namespace {

constexpr Split kAllSplits[] = {Split::kTraining, Split::kValidation, Split::kExtrapolation};

std::string list_of(const std::vector<std::string>& lines, const char* none) {
  if (lines.empty()) return fmt::format("<p>{}</p>\n", none);
  std::string html = "<ul>\n";
  for (const std::string& line : lines) html += fmt::format("<li>{}</li>\n", escaped(line));
  return html + "</ul>\n";
}

std::string names(const std::vector<std::string>& all) {
  std::string html;
  for (const std::string& name : all)
    html += fmt::format("{}<code>{}</code>", html.empty() ? "" : ", ", escaped(name));
  return html;
}

std::string error_of(const Comparison& comparison, Split split, const std::string& signal) {
  const SignalError* e = comparison.error(split, signal);
  return e == nullptr ? "<td>–</td>"
                      : fmt::format("<td title=\"{} % of the signal's spread\">{}</td>",
                                    figure(e->nrmse_percent), figure(e->rmse));
}

const char* verdict_class(const Diagnosis& d) {
  return d.verdict == Verdict::kAdequate ? "adequate" : d.verdict == Verdict::kEffect ? "effect" : "unknown";
}

// "gain", "prior", "noise (93 %)"; empty: refused.
std::string acceptance_cell(const RankedEffect& r) {
  const std::string_view by = accepted_by_name(r.accepted_by);
  return r.accepted_by == AcceptedBy::kNoise ? fmt::format("{} ({:.0f} %)", by, 100.0 * r.noise_share)
                                             : std::string(by);
}

}  // namespace

std::string verdict_section(const ReportInput& input) {
  const Diagnosis& d = input.diagnosis;
  std::string html = fmt::format(
      "<section id=\"verdict\" class=\"verdict {}\">\n<h1>{}</h1>\n<p class=\"sentence\">{}</p>\n",
      verdict_class(d), escaped(input.title.empty() ? d.dataset : input.title), escaped(verdict_sentence(d)));
  if (d.verdict != Verdict::kUnknown && !d.unknown.sentence.empty()) {
    html += fmt::format("<p>{}</p>\n", escaped(d.unknown.sentence));
  }
  if (!d.confidence.empty()) html += fmt::format("<p>{}</p>\n", escaped(confidence_sentence(d)));
  if (!d.baseline_comparison.worst.empty()) {
    html += fmt::format("<p>Before: {}</p>\n", escaped(d.baseline_comparison.worst.front().sentence));
  }
  if (!d.effects.empty() && !d.final_comparison.worst.empty()) {
    html += fmt::format("<p>Residual: {}</p>\n", escaped(d.final_comparison.worst.front().sentence));
  }
  if (!d.next_experiment.what.empty()) {
    html += fmt::format("<p>Next: {}</p>\n", escaped(d.next_experiment.what));
  }
  return html + "</section>\n";
}

std::string ladder_section(const Diagnosis& d) {
  std::string html =
      "<p>Error of the model over the sensors' noise (1 is perfect), pooled over all signals, as the model "
      "is "
      "mended step by step.</p>\n<div class=\"chart\" data-chart=\"ladder\"></div>\n"
      "<table><caption>Error over noise after each step</caption>\n<thead><tr><th scope=\"col\">step</th>"
      "<th scope=\"col\">fit</th><th scope=\"col\">holdout</th><th "
      "scope=\"col\">extrapolation</th></tr></thead><tbody>\n";
  for (const LadderStep& step : ladder_shown(d)) {
    html += fmt::format("<tr><th scope=\"row\">{}</th>", escaped(step.added));
    for (const Split split : kAllSplits) {
      html += fmt::format("<td>{}</td>",
                          has_split(step.comparison, split) ? figure(step.comparison.pooled(split)) : "–");
    }
    html += "</tr>\n";
  }
  return html + "</tbody></table>\n";
}

std::string errors_table(const Diagnosis& d) {
  std::string html =
      "<table><caption>Root mean square error per signal</caption>\n<thead><tr><th scope=\"col\">signal</th>"
      "<th scope=\"col\">use</th><th scope=\"col\">unit</th><th scope=\"col\">noise</th><th "
      "scope=\"col\">nominal</th>"
      "<th scope=\"col\">refitted</th><th scope=\"col\">final</th><th "
      "scope=\"col\">change</th></tr></thead><tbody>\n";
  const auto value = [](const Comparison& comparison, const SignalError& like) {
    const SignalError* e = comparison.error(like.split, like.signal);
    return e == nullptr ? std::nan("") : e->rmse;
  };
  for (const SignalError& e : d.baseline_comparison.errors) {
    html += fmt::format("<tr><th scope=\"row\">{}</th><td>{}</td><td>{}</td><td>{}</td>", escaped(e.signal),
                        split_name(e.split), escaped(e.unit), figure(e.noise_sigma));
    html += error_of(d.nominal_comparison, e.split, e.signal) +
            error_of(d.baseline_comparison, e.split, e.signal) +
            error_of(d.final_comparison, e.split, e.signal);
    html += fmt::format("<td>{}</td></tr>\n", change_percent(e.rmse, value(d.final_comparison, e)));
  }
  return html + "</tbody></table>\n";
}

constexpr const char* kRankingHead =
    "<table class=\"wide\"><caption>Effects</caption>\n"
    "<thead><tr><th scope=\"col\">effect</th><th scope=\"col\">selected</th><th scope=\"col\">accepted "
    "by</th><th "
    "scope=\"col\">fit</th><th scope=\"col\">"
    "holdout</th><th scope=\"col\">extrapolation</th><th scope=\"col\">parameters (±1 σ)</th><th "
    "scope=\"col\">confounded with</th><th scope=\"col\">why</th></tr></thead><tbody>\n";

std::string ranking_rows(const Diagnosis& d, const std::vector<RankedEffect>& ranking) {
  std::string html;
  for (const RankedEffect& r : ranking) {
    std::string parameters, confounded;
    for (const ParameterEstimate& p : r.parameters) {
      parameters += fmt::format("{}<code>{}</code> {} ± {} {}", parameters.empty() ? "" : "<br>",
                                escaped(p.path), figure(p.value), figure(p.sigma), escaped(p.unit));
    }
    for (const ConfoundedSet& set : d.confounded) {
      if (std::ranges::find(set.members, r.effect) == set.members.end()) continue;
      std::vector<std::string> others;
      std::ranges::copy_if(set.members, std::back_inserter(others),
                           [&](const std::string& m) { return m != r.effect; });
      confounded += (confounded.empty() ? "" : "; ") + names(others);
    }
    const auto ratio = [&](double value) { return r.refitted ? figure(value) : "–"; };
    html += fmt::format(
        "<tr{}><th scope=\"row\"><code>{}</code>{}</th><td><span class=\"bar\" "
        "style=\"width:{:.0f}px\"></span> {:.0f} %</td><td>{}</td>"
        "<td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n",
        r.accepted() ? " class=\"accepted\"" : "", escaped(r.effect), r.accepted() ? " ✓" : "",
        60.0 * std::clamp(r.selection_frequency, 0.0, 1.0), 100.0 * r.selection_frequency, acceptance_cell(r),
        ratio(r.fit_error_ratio), ratio(r.holdout_error_ratio), ratio(r.extrapolation_error_ratio),
        parameters, confounded, escaped(r.why));
  }
  return html;
}

std::string ranking_section(const Diagnosis& d) {
  if (d.ranking.empty()) return "<p>No effect was ranked.</p>\n";
  std::string html =
      "<p>First iteration, best first. Selected: the share of bootstrap draws of the held-out runs in which "
      "no candidate "
      "leaves less error; it says how stable the choice among these effects is, not how probable it is that "
      "one is "
      "present. Accepted by: gain, a lower held-out error; prior, a base parameter that returns to what the "
      "model file "
      "says; noise, the share of the variance above the sensors' noise that the effect explains. Ratios are "
      "the error "
      "with the effect over that of the refitted nominal model: below 1 is better. Effects that were "
      "screened only carry "
      "no ratio.</p>\n";
  html += kRankingHead;
  html += ranking_rows(d, d.ranking) + "</tbody></table>\n";
  for (const LadderStep& step : steps_after_first_ranking(d)) {
    std::vector<RankedEffect> refitted;
    std::ranges::copy_if(step.ranking, std::back_inserter(refitted),
                         [](const RankedEffect& r) { return r.refitted; });
    if (refitted.empty()) continue;
    html += fmt::format("<h3>After {}: what was fitted</h3>\n", escaped(step.added)) + kRankingHead +
            ranking_rows(d, refitted) + "</tbody></table>\n";
  }
  if (d.confounded.empty()) return html;
  html += "<h3>Confounded effects</h3>\n<ul>\n";
  for (const ConfoundedSet& set : d.confounded) {
    html += fmt::format("<li>{}: {}</li>\n", names(set.members), escaped(set.sentence));
  }
  return html + "</ul>\n";
}

std::string data_section(const ReportInput& input) {
  std::string html;
  if (input.diagnosis.findings.empty()) {
    html += "<p>Nothing was found wrong with the data.</p>\n";
  } else {
    html += "<ul class=\"findings\">\n";
    for (const DataFinding& f : input.diagnosis.findings) {
      const char* grade = f.grade == DataFinding::Grade::kFault   ? "fault"
                          : f.grade == DataFinding::Grade::kDoubt ? "doubt"
                                                                  : "note";
      std::string where = f.run.empty() ? "all runs" : f.run;
      if (!f.signal.empty()) where += ", " + f.signal;
      html += fmt::format("<li class=\"{}\"><b>{}</b> <code>{}</code> ({}): {}</li>\n", grade, grade,
                          escaped(f.kind), escaped(where), escaped(f.sentence));
    }
    html += "</ul>\n";
  }
  if (!input.notes.empty()) html += "<h3>Left out or assumed</h3>\n" + list_of(input.notes, "");
  std::vector<std::string> diverged;
  for (const std::string& run : input.diagnosis.final_comparison.diverged) {
    diverged.push_back("the model stopped being finite in " + run);
  }
  if (!diverged.empty()) html += "<h3>Diverged</h3>\n" + list_of(diverged, "");
  return html;
}

std::string invisible_section(const Diagnosis& d) {
  return "<p>Effects that these data could not have shown, however large: not found is not absent.</p>\n" +
         list_of(d.not_visible, "Every effect that applies to this rig could have been seen.");
}

std::string next_section(const Diagnosis& d) {
  const NextExperiment& next = d.next_experiment;
  if (next.what.empty()) return "<p>None is proposed.</p>\n";
  std::string html = fmt::format("<p class=\"sentence\">{}</p>\n", escaped(next.what));
  if (!next.command.empty()) html += fmt::format("<p><code>{}</code></p>\n", escaped(next.command));
  if (!next.separates.empty()) html += fmt::format("<p>It separates {}.</p>\n", names(next.separates));
  if (next.expected_sigmas > 0.0) {
    html += fmt::format("<p>Simulated, it sets them {} standard deviations apart.</p>\n",
                        figure(next.expected_sigmas));
  }
  return html;
}

std::string unknown_section(const Diagnosis& d) {
  std::string html;
  if (!d.unknown.sentence.empty())
    html += fmt::format("<p class=\"sentence\">{}</p>\n", escaped(d.unknown.sentence));
  const std::vector<Where>& where = d.unknown.where.empty() ? d.where : d.unknown.where;
  if (!where.empty()) {
    html +=
        "<table><caption>What the residual depends on</caption>\n<thead><tr><th scope=\"col\">signal</th><th "
        "scope=\"col\">against"
        "</th><th scope=\"col\">share explained</th><th scope=\"col\">order</th></tr></thead><tbody>\n";
    for (const Where& w : where) {
      html += fmt::format("<tr><th scope=\"row\">{}</th><td>{}</td><td>{:.0f} %</td><td>{}</td></tr>\n",
                          escaped(w.signal), escaped(w.against), 100.0 * w.explained_fraction,
                          w.order > 0.0 ? figure(w.order) : "–");
    }
    html += "</tbody></table>\n";
  }
  if (!d.unknown.formula.empty())
    html += fmt::format("<p>A formula for it: <code>{}</code></p>\n", escaped(d.unknown.formula));
  if (!d.unknown.expression_toml.empty()) {
    html += fmt::format("<p>Ready to paste into the model file:</p>\n<pre><code>{}</code></pre>\n",
                        escaped(d.unknown.expression_toml));
  }
  return html.empty() ? "<p>No residual is left above the noise.</p>\n" : html;
}

}  // namespace omnihil
