#include "hil/scenario/scenario_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "hil/loop/console_json.h"
#include "hil/text/json_text.h"
#include "hil/text/markup.h"

namespace omnihil {
namespace {

std::size_t failed_of(std::span<const CheckResult> results) {
  return static_cast<std::size_t>(std::ranges::count(results, false, &CheckResult::passed));
}

std::string wheel_text(const CheckResult& r) {
  return r.wheel < 0 ? std::string() : fmt::format("wheel {}", r.wheel);
}

// A failed check of a run that broke off, or one whose numbers say it all.
std::string detail(const CheckResult& r) {
  std::string text;
  if (r.measured || r.allowed) text = fmt::format("{:<14} {}", r.measured_text(), r.allowed_text());
  if (!r.passed || !r.note.empty()) {
    if (r.measured || r.note.empty()) text += fmt::format(", at {:.3f} s", r.at_s);
    if (!r.note.empty()) text += (text.empty() ? "" : ": ") + r.note;
  }
  return text;
}

// Of a failed one, the last lines until its last failed check was decided.
std::span<const ConsoleLine> shown_console(const ScenarioOutcome& o) {
  double until_s = 0.0;
  for (const CheckResult& r : o.results) until_s = r.passed ? until_s : std::max(until_s, r.at_s);
  if (o.passed()) return {};
  return last_lines(o.console, std::llround(until_s * 1e9));
}

nlohmann::ordered_json result_json(const CheckResult& r) {
  nlohmann::ordered_json one{
      {"check", r.name}, {"line", r.line}, {"passed", r.passed}, {"reached", r.reached}};
  if (r.wheel >= 0) one["wheel"] = r.wheel;
  if (r.measured) one["measured"] = *r.measured;
  if (r.allowed) one[r.at_least ? "at_least" : "at_most"] = *r.allowed;
  if (!r.unit.empty()) one["unit"] = r.unit;
  one["at_s"] = r.at_s;
  one["from_s"] = r.from_s;
  one["to_s"] = r.to_s;
  if (!r.note.empty()) one["note"] = r.note;
  return one;
}

}  // namespace

bool ScenarioOutcome::passed() const { return failed_of(results) == 0; }

std::string scenario_text(const ScenarioOutcome& o, bool all) {
  std::string text =
      fmt::format("{}  {}: {}\n", o.passed() ? "ok  " : "FAIL", o.scenario.file, o.scenario.title);
  std::size_t missed = 0;
  for (const CheckResult& r : o.results) {
    missed += r.reached ? 0 : 1;
    if ((r.passed || !r.reached) && !all) continue;
    text +=
        fmt::format("  {}  {:<22} {:<8} {}\n", r.passed ? "ok  " : "FAIL", r.name, wheel_text(r), detail(r));
  }
  if (missed > 0 && !all) text += fmt::format("  FAIL  {} checks that it did not get to\n", missed);
  for (const ConsoleLine& line : shown_console(o)) text += fmt::format("  said  {}\n", line.words());
  if (!o.plot.empty()) text += fmt::format("  plot  {}\n", o.plot);
  return text;
}

std::string failure_line(const CheckResult& r) {
  std::string text = r.name;
  if (r.wheel >= 0) text += fmt::format(" wheel {}", r.wheel);
  text += ":";
  if (r.measured || r.allowed) text += fmt::format(" {}, {},", r.measured_text(), r.allowed_text());
  text += fmt::format(" at {:.3f} s", r.at_s);
  if (!r.note.empty()) text += ": " + r.note;
  if (r.line > 0) text += fmt::format(" (line {})", r.line);
  return text;
}

std::string summary_line(std::span<const ScenarioOutcome> outcomes) {
  std::size_t checks = 0, failed = 0, scenarios_failed = 0;
  for (const ScenarioOutcome& o : outcomes) {
    checks += o.results.size();
    failed += failed_of(o.results);
    scenarios_failed += o.passed() ? 0 : 1;
  }
  return fmt::format("{} scenarios, {} failed; {} checks, {} failed\n", outcomes.size(), scenarios_failed,
                     checks, failed);
}

std::string junit_xml(std::span<const ScenarioOutcome> outcomes) {
  std::size_t checks = 0, failed = 0;
  for (const ScenarioOutcome& o : outcomes) checks += o.results.size(), failed += failed_of(o.results);
  std::string out = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";
  out += fmt::format("<testsuites name=\"omnihil scenario\" tests=\"{}\" failures=\"{}\">\n", checks, failed);
  for (const ScenarioOutcome& o : outcomes) {
    out +=
        fmt::format("  <testsuite name=\"{}\" tests=\"{}\" failures=\"{}\" errors=\"0\" time=\"{:.3f}\">\n",
                    escaped(o.scenario.title), o.results.size(), failed_of(o.results), o.scenario.duration_s);
    out += fmt::format("    <properties><property name=\"firmware\" value=\"{}\"/></properties>\n",
                       escaped(o.firmware));
    for (const CheckResult& r : o.results) {
      const std::string name = r.wheel < 0 ? r.name : fmt::format("{} wheel {}", r.name, r.wheel);
      out += fmt::format("    <testcase classname=\"{}\" name=\"{}\" file=\"{}\" line=\"{}\" time=\"{:.3f}\"",
                         escaped(o.scenario.file), escaped(name), escaped(o.scenario.file), r.line,
                         r.to_s - r.from_s);
      if (r.passed) {
        out += "/>\n";
        continue;
      }
      const std::string line = escaped(failure_line(r));
      out += fmt::format(">\n      <failure message=\"{}\">{}</failure>\n    </testcase>\n", line, line);
    }
    std::string said;
    for (const ConsoleLine& line : shown_console(o)) said += line.words() + "\n";
    if (!said.empty()) out += fmt::format("    <system-out>{}</system-out>\n", escaped(said));
    out += "  </testsuite>\n";
  }
  return out + "</testsuites>\n";
}

std::string scenario_json(std::span<const ScenarioOutcome> outcomes, const std::string& program) {
  nlohmann::ordered_json all{{"format", "omnihil-scenario-report/1"}, {"program", program}};
  all["scenarios"] = nlohmann::ordered_json::array();
  for (const ScenarioOutcome& o : outcomes) {
    nlohmann::ordered_json one{{"file", o.scenario.file},
                               {"title", o.scenario.title},
                               {"firmware", o.firmware},
                               {"commands", o.commands},
                               {"passed", o.passed()},
                               {"firmware_failed", o.firmware_failed},
                               {"duration_s", o.scenario.duration_s}};
    if (!o.plot.empty()) one["plot"] = o.plot;
    one["checks"] = nlohmann::ordered_json::array();
    for (const CheckResult& r : o.results) one["checks"].push_back(result_json(r));
    if (const auto said = shown_console(o); !said.empty()) one["console"] = console_json(said);
    all["scenarios"].push_back(std::move(one));
  }
  return json_text(all) + "\n";
}

}  // namespace omnihil
