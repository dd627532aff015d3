#include "hil/report/report_html.h"

#include <fmt/format.h>

#include "hil/report/report_assets.h"
#include "hil/report/report_charts.h"
#include "hil/report/report_sections.h"
#include "hil/report/report_text.h"

namespace omnihil {
namespace {

struct Part {
  const char* id;
  const char* title;
  std::string html;
};

std::string charts_needed() {
  if (!uplot_script().empty()) return "";
  return fmt::format(
      "<p class=\"missing\">The charts need uPlot, which was not there when this program was built ({}). "
      "Every "
      "figure is in the tables.</p>\n",
      escaped(uplot_missing()));
}

std::string fit_summary(const Diagnosis& d) {
  return fmt::format("<p>Verdict <code>{}</code>; {} effects added; seed {}.</p>\n", verdict_name(d.verdict),
                     d.effects.size(), d.seed);
}

std::string about(const ReportInput& input) {
  std::string html = "<dl>\n";
  const auto row = [&html](const char* what, const std::string& text) {
    if (!text.empty()) html += fmt::format("<dt>{}</dt><dd>{}</dd>\n", what, escaped(text));
  };
  row("dataset", input.diagnosis.dataset);
  row("nominal model", input.model);
  row("command", input.command);
  row("program", input.program);
  if (input.elapsed_s > 0.0) row("took", figure(input.elapsed_s) + " s");
  html += "</dl>\n" + fit_summary(input.diagnosis);
  if (!uplot_licence().empty()) {
    html += fmt::format(
        "<details><summary>Licence of uPlot, which draws the charts</summary><pre>{}</pre></details>\n",
        escaped(uplot_licence()));
  }
  return html;
}

std::vector<Part> parts_of(const ReportInput& input) {
  const Diagnosis& d = input.diagnosis;
  return {
      {"ladder", "Error, step by step", ladder_section(d) + errors_table(d)},
      {"where", "Where the error is",
       "<p>Mean of measured minus model along one axis, with a band of two standard errors. A curve that "
       "leaves the band "
       "around zero is structure that the model lacks. The marked range holds most error for its time.</p>\n"
       "<div data-list=\"maps\"></div>\n"},
      {"overlays", "Measured against model",
       "<p>Residual is measured minus model. Drag over a chart to zoom, double click to go back; with the "
       "keyboard: "
       "<kbd>+</kbd> <kbd>−</kbd> <kbd>←</kbd> <kbd>→</kbd>, <kbd>0</kbd> for all.</p>\n<div "
       "data-list=\"overlays\"></div>\n"},
      {"spectrum", "Against the angle",
       "<p>Amplitude of the residual per order: order 1 is once per turn. Cogging and torque ripple are "
       "lines at multiples of "
       "poles and slots, eccentricity and imbalance at order 1.</p>\n<div data-list=\"spectra\"></div>\n"},
      {"ranking", "Which effect", ranking_section(d)},
      {"parameters", "Numbers of the model", parameters_section(d)},
      {"data", "Quality of the data", data_section(input)},
      {"invisible", "Not visible in these data", invisible_section(d)},
      {"next", "Next experiment", next_section(d)},
      {"unknown", "Unknown structure", unknown_section(d)},
      {"about", "About this report", about(input)},
  };
}

}  // namespace

std::string report_html(const ReportInput& input) {
  const std::vector<Part> parts = parts_of(input);
  const std::string title =
      escaped("Diagnosis: " + (input.title.empty() ? input.diagnosis.dataset : input.title));
  std::string html =
      "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; script-src "
      "'unsafe-inline'; style-src "
      "'unsafe-inline'; img-src data:\">\n<meta name=\"viewport\" content=\"width=device-width, "
      "initial-scale=1\">\n"
      "<link rel=\"icon\" href=\"data:,\">\n";
  html += fmt::format("<title>{}</title>\n<style>\n{}\n{}\n</style>\n</head>\n<body>\n", title, uplot_style(),
                      report_style());
  html += "<a class=\"skip\" href=\"#ladder\">Skip to the results</a>\n<nav aria-label=\"Sections\"><ul>\n";
  for (const Part& part : parts)
    html += fmt::format("<li><a href=\"#{}\">{}</a></li>\n", part.id, part.title);
  html += "</ul><button type=\"button\" id=\"theme\">Dark or light</button></nav>\n<main>\n";
  html += verdict_section(input) + charts_needed();
  for (const Part& part : parts) {
    html += fmt::format(
        "<section id=\"{}\">\n<details open><summary><h2>{}</h2></summary>\n{}</details>\n</section>\n",
        part.id, part.title, part.html);
  }
  html += "</main>\n<script type=\"application/json\" id=\"report-data\">";
  html += chart_data(input);
  html += "</script>\n";
  if (!uplot_script().empty())
    html +=
        fmt::format("<script>\n{}\n</script>\n<script>\n{}\n</script>\n", uplot_script(), report_script());
  return html + "</body>\n</html>\n";
}

}  // namespace omnihil
