// The table of a report that says how every number of the model moved, and how well the data know it.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "hil/report/report_sections.h"
#include "hil/report/report_text.h"

namespace omnihil {
namespace {

constexpr double kSigmasOf90Percent = 1.645;  // normal distribution, two-sided

const ParameterEstimate* find(const std::vector<ParameterEstimate>& all, const std::string& path) {
  const auto it = std::ranges::find(all, path, &ParameterEstimate::path);
  return it == all.end() ? nullptr : &*it;
}

std::string interval(const ParameterEstimate* p) {
  if (p == nullptr) return "–";
  const double half = kSigmasOf90Percent * p->sigma;
  return fmt::format("{} <small>{} … {}</small>", figure(p->value), figure(p->value - half),
                     figure(p->value + half));
}

std::string prior(const ParameterEstimate& p) {
  if (!(p.prior_sigma > 0.0)) return "anything within bounds";
  return fmt::format("{} ± {}", figure(p.prior_mean), figure(p.prior_sigma));
}

std::string marks(const ParameterEstimate& p) {
  std::string html;
  const auto mark = [&html](bool is, const char* text) {
    if (is) html += fmt::format("<span class=\"mark\">{}</span> ", text);
  };
  mark(p.unphysical, "unphysical");
  mark(p.at_bound, "at its bound");
  mark(!p.identifiable, "not determined");
  mark(std::fabs(p.prior_deviation_sigmas) > 2.0, "left its tolerance");
  return html + escaped(p.sentence);
}

}  // namespace

std::string parameters_section(const Diagnosis& d) {
  const std::vector<ParameterEstimate>& last =
      has_model(d.final_fit) ? d.final_fit.parameters : d.baseline.parameters;
  if (last.empty()) return "<p>No number was estimated.</p>\n";
  std::string html =
      "<p>Intervals are 90 %. The prior is what the model file believed before any fit: value and "
      "tolerance. The prior "
      "deviation is how far "
      "the final value is from it, in tolerances; a missing effect hides as a deviation that goes away once "
      "the effect is "
      "in the model.</p>\n"
      "<div class=\"chart\" data-chart=\"drift\"></div>\n<table "
      "class=\"wide\"><caption>Parameters</caption>\n<thead><tr>"
      "<th scope=\"col\">parameter</th><th scope=\"col\">unit</th><th scope=\"col\">prior (±1 σ)</th><th "
      "scope=\"col\">"
      "refitted, before</th><th scope=\"col\">final</th><th scope=\"col\">prior deviation, σ</th><th "
      "scope=\"col\">remarks</th></tr></thead><tbody>\n";
  for (const ParameterEstimate& p : last) {
    html += fmt::format(
        "<tr><th "
        "scope=\"row\"><code>{}</code></th><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</"
        "td></tr>\n",
        escaped(p.path), escaped(p.unit), prior(p), interval(find(d.baseline.parameters, p.path)),
        interval(&p), p.prior_sigma > 0.0 ? figure(p.prior_deviation_sigmas) : "–", marks(p));
  }
  html += "</tbody></table>\n";
  std::vector<std::string> findings = d.baseline.findings;
  for (const std::string& f : d.final_fit.findings) {
    if (std::ranges::find(findings, f) == findings.end()) findings.push_back(f);
  }
  if (findings.empty()) return html;
  html += "<ul>\n";
  for (const std::string& f : findings) html += fmt::format("<li>{}</li>\n", escaped(f));
  return html + "</ul>\n";
}

}  // namespace omnihil
