#include "hil/check/check_page.h"

#include <fmt/format.h>

#include <numeric>

#include "hil/check/check_report.h"
#include "hil/report/report_assets.h"
#include "hil/text/markup.h"

namespace omnihil {
namespace {

constexpr std::size_t kLeastTrend = 2;  // runs: a trend of one is a number

std::string overview(std::span<const CheckOutcome> outcomes) {
  std::string html =
      "<table class=\"wide\"><caption>Recordings</caption>\n<tr><th>recording</th><th>verdict</th>"
      "<th>first difference</th></tr>\n";
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    const CheckOutcome& o = outcomes[i];
    const std::string verdict = o.passed()                     ? "agrees"
                                : o.fault == CheckFault::kNone ? "differs"
                                                               : "no verdict";
    const std::string what = !o.fault_text.empty() ? o.fault_text
                             : o.comparison.first  ? o.comparison.first->text()
                                                   : "";
    html += fmt::format("<tr><th scope=\"row\"><a href=\"#r{}\">{}</a></th><td>{}</td><td>{}</td></tr>\n", i,
                        escaped(o.file), verdict, escaped(what));
  }
  return html + "</table>\n";
}

std::string signals_table(const CheckOutcome& o) {
  std::string html =
      "<table class=\"wide\"><tr><th>signal</th><th>values</th><th>beyond</th><th>largest</th><th>RMS</th>"
      "<th>tolerance</th><th>unit</th><th>at</th></tr>\n";
  for (const SignalSummary& s : o.comparison.signals) {
    html += fmt::format(
        "<tr{}><th scope=\"row\">{}</th><td>{}</td><td>{}</td><td>{:.3g}</td><td>{:.3g}</td><td>{:.3g}</td>"
        "<td>{}</td><td>{:.3f} s{}</td></tr>\n",
        s.beyond > 0 ? " class=\"accepted\"" : "", escaped(s.name), s.values, s.beyond, s.largest, s.rms(),
        s.tolerance, escaped(s.unit), static_cast<double>(s.largest_ns) / 1e9,
        s.largest_robot < 0 ? "" : fmt::format(", robot {}", s.largest_robot));
  }
  return html + "</table>\n";
}

// How far the worst signal was from its tolerance, run by run.
std::string trend(const CheckOutcome& o, const CheckHistory& history) {
  const std::vector<HistoryRun> runs = history.runs_of(o.file);
  if (runs.size() < kLeastTrend) return "";
  LineChart chart{.title = "largest difference by its tolerance, run by run; above 1 a check fails",
                  .x = std::vector<double>(runs.size()),
                  .x_label = fmt::format("runs, {} ({}) to {} ({})", runs.front().label, runs.front().date,
                                         runs.back().label, runs.back().date),
                  .panels = {},
                  .shade = {},
                  .mark = {}};
  std::iota(chart.x.begin(), chart.x.end(), 1.0);
  std::vector<double> over;
  for (const HistoryRun& run : runs) over.push_back(run.over_tolerance);
  chart.panels.push_back({"1", {{"worst signal", over}, {"limit", std::vector<double>(runs.size(), 1.0)}}});
  return "<figure>" + line_chart(chart) + "</figure>\n";
}

std::string section(const CheckOutcome& o, std::size_t place, const CheckHistory& history) {
  std::string html = fmt::format("<section id=\"r{}\">\n<details{}><summary><h2>{}</h2></summary>\n", place,
                                 o.passed() ? "" : " open", escaped(o.file));
  html += "<pre>" + escaped(check_text(o, false)) + "</pre>\n";
  for (const LineChart& chart : o.charts) html += "<figure>" + line_chart(chart) + "</figure>\n";
  if (!o.field.empty()) html += "<figure>" + o.field + "</figure>\n";
  html += trend(o, history);
  if (!o.comparison.signals.empty()) html += signals_table(o);
  return html + "</details>\n</section>\n";
}

}  // namespace

std::string check_page(std::span<const CheckOutcome> outcomes, const CheckHistory& history,
                       const std::string& program) {
  std::string html = fmt::format(
      "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src "
      "'unsafe-inline'\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>omnihil "
      "check</title>\n"
      "<style>\n{}\nfigure svg {{ max-width: 100%; height: auto; }}\n</style>\n</head>\n<body>\n<main>\n",
      report_style());
  const std::string summary = check_summary(outcomes);
  html += fmt::format("<h1>omnihil check</h1>\n<p class=\"sentence\">{}</p>\n", escaped(summary));
  html += overview(outcomes);
  for (std::size_t i = 0; i < outcomes.size(); ++i) html += section(outcomes[i], i, history);
  html += fmt::format("<p><small>{}</small></p>\n", escaped(program));
  return html + "</main>\n</body>\n</html>\n";
}

}  // namespace omnihil
