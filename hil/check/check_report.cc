#include "hil/check/check_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "hil/loop/console_json.h"
#include "hil/recording/replay_report.h"
#include "hil/text/json_text.h"
#include "hil/text/markup.h"

namespace omnihil {
namespace {

constexpr std::size_t kNamedSignals = 5;  // in one failure's text; the page and the JSON have all

bool has_verdict(const CheckOutcome& o) { return o.fault == CheckFault::kNone; }

std::string fault_word(CheckFault fault) {
  switch (fault) {
    case CheckFault::kNone:
      return "";
    case CheckFault::kBadInput:
      return "unusable";
    case CheckFault::kIo:
      return "unreadable";
    case CheckFault::kDiverged:
      return "not finite";
    case CheckFault::kFirmware:
      return "firmware failed";
  }
  return "";
}

// What the boards said last, and where they first said something else than was recorded.
std::string console_text(const CheckOutcome& o, std::string_view said, std::string_view differs) {
  std::string text;
  for (const ConsoleLine& line : o.console) text += fmt::format("{}{}\n", said, line.words());
  if (!o.console_difference.empty()) text += fmt::format("{}{}\n", differs, o.console_difference);
  return text;
}

// Everything a reader of a CI log needs of a failure, several lines.
std::string failure_text(const CheckOutcome& o) {
  std::string text;
  if (!has_verdict(o)) text += fault_word(o.fault) + ": " + o.fault_text + "\n";
  if (o.comparison.first) text += "first: " + o.comparison.first->text() + "\n";
  if (o.drive) text += "drive: " + o.drive->text() + "\n";
  for (const std::string& change : o.cause) text += "cause: " + change + "\n";
  for (const std::string& change : o.changed) text += "changed: " + change + "\n";
  text += console_text(o, "said: ", "console: ");
  text += o.explained;
  const std::vector<SignalSummary> beyond = signals_beyond(o.comparison);
  for (std::size_t i = 0; i < std::min(kNamedSignals, beyond.size()); ++i) {
    text += fmt::format("{}: {:.3g} {} at {:.3f} s, tolerance {:.3g}\n", beyond[i].name, beyond[i].largest,
                        beyond[i].unit, static_cast<double>(beyond[i].largest_ns) / 1e9, beyond[i].tolerance);
  }
  return text;
}

std::string headline(const CheckOutcome& o) {
  if (!has_verdict(o)) return fault_word(o.fault) + ": " + o.fault_text;
  return o.comparison.first ? "differs first at " + o.comparison.first->text() : "agrees";
}

nlohmann::ordered_json signal_json(const SignalSummary& s) {
  return {{"name", s.name},           {"unit", s.unit},
          {"values", s.values},       {"beyond", s.beyond},
          {"largest", s.largest},     {"rms", s.rms()},
          {"tolerance", s.tolerance}, {"at_s", static_cast<double>(s.largest_ns) / 1e9},
          {"robot", s.largest_robot}};
}

// "|" would end a cell of a Markdown table.
std::string cell(std::string text) {
  for (std::size_t at = 0; (at = text.find('|', at)) != std::string::npos; at += 2) text.insert(at, "\\");
  std::ranges::replace(text, '\n', ' ');
  return text;
}

}  // namespace

std::string check_text(const CheckOutcome& o, bool table) {
  std::string text;
  if (!o.recording.empty()) text += "recording  " + o.recording + "\nreplayed   " + o.replayed + "\n";
  for (const std::string& change : o.changed) text += "changed    " + change + "\n";
  if (!o.tolerance_reason.empty()) text += "tolerances " + o.tolerance_reason + "\n";
  if (table) text += "\n" + comparison_table(o.comparison) + "\n";
  const RecordingComparison& c = o.comparison;
  for (const std::string& column : c.not_compared)
    text += fmt::format("not compared: column '{}', which this program does not have\n", column);
  text += fmt::format("compared   {} values: {} samples, {} packets; bytes {}, samples {}\n", c.values(),
                      c.samples, c.packets, c.bytes_identical ? "identical" : "not identical",
                      c.samples == 0        ? "not recorded"
                      : c.samples_identical ? "identical"
                                            : "not identical");
  if (o.drive) text += "drive      " + o.drive->text() + "\n";
  for (const std::string& change : o.cause) text += "cause      " + change + "\n";
  text += console_text(o, "said       ", "console    ");
  text += o.explained;
  if (!has_verdict(o)) text += fmt::format("{:<10} {}\n", fault_word(o.fault), o.fault_text);
  if (c.agrees()) return text + (has_verdict(o) ? "agrees\n" : "");
  return text + "differs    first at " + c.first->text() + "\n";
}

std::string check_line(const CheckOutcome& o) {
  std::string text = fmt::format("{}  {}: ", o.passed() ? "ok  " : "FAIL", o.file);
  if (o.passed()) return text + fmt::format("{:.3f} s, {} values\n", o.simulated_s, o.comparison.values());
  text += headline(o) + "\n";
  if (o.drive) text += "      drive: " + o.drive->text() + "\n";
  for (const std::string& change : o.cause) text += "      cause: " + change + "\n";
  for (const std::string& change : o.changed) text += "      changed: " + change + "\n";
  return text;
}

std::string check_summary(std::span<const CheckOutcome> outcomes) {
  const auto without = std::ranges::count_if(outcomes, [](const auto& o) { return !has_verdict(o); });
  const auto failed =
      std::ranges::count_if(outcomes, [](const auto& o) { return has_verdict(o) && !o.passed(); });
  return fmt::format("{} recordings: {} agree, {} differ, {} without a verdict\n", outcomes.size(),
                     static_cast<std::ptrdiff_t>(outcomes.size()) - failed - without, failed, without);
}

std::string check_junit(std::span<const CheckOutcome> outcomes) {
  const auto errors = std::ranges::count_if(outcomes, [](const auto& o) { return !has_verdict(o); });
  const auto failures =
      std::ranges::count_if(outcomes, [](const auto& o) { return has_verdict(o) && !o.passed(); });
  std::string out = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";
  const std::string counts =
      fmt::format("tests=\"{}\" failures=\"{}\" errors=\"{}\"", outcomes.size(), failures, errors);
  out += fmt::format("<testsuites name=\"omnihil check\" {}>\n  <testsuite name=\"recordings\" {}>\n", counts,
                     counts);
  for (const CheckOutcome& o : outcomes) {
    out += fmt::format("    <testcase classname=\"check\" name=\"{0}\" file=\"{0}\" time=\"{1:.3f}\"",
                       escaped(o.file), o.wall_s);
    if (o.passed()) {
      out += "/>\n";
      continue;
    }
    const char* element = has_verdict(o) ? "failure" : "error";
    out += fmt::format(">\n      <{0} message=\"{1}\">{2}</{0}>\n    </testcase>\n", element,
                       escaped(headline(o)), escaped(failure_text(o)));
  }
  return out + "  </testsuite>\n</testsuites>\n";
}

std::string check_json(std::span<const CheckOutcome> outcomes, const std::string& program) {
  nlohmann::ordered_json all{{"format", "omnihil-check/1"}, {"program", program}};
  all["recordings"] = nlohmann::ordered_json::array();
  for (const CheckOutcome& o : outcomes) {
    nlohmann::ordered_json one{{"file", o.file}, {"passed", o.passed()}};
    one["verdict"] = !has_verdict(o) ? fault_word(o.fault) : o.passed() ? "agrees" : "differs";
    if (!o.fault_text.empty()) one["fault"] = o.fault_text;
    one["tolerances"] = o.tolerance_reason;
    one["changed"] = o.changed;
    one["simulated_s"] = o.simulated_s;
    one["wall_s"] = o.wall_s;
    if (o.comparison.first) one["first_difference"] = o.comparison.first->text();
    if (o.drive) one["drive_difference"] = o.drive->text();
    if (!o.cause.empty()) one["cause"] = o.cause;
    if (!o.console.empty()) one["console"] = console_json(o.console);
    if (!o.console_difference.empty()) one["console_difference"] = o.console_difference;
    if (!o.explained.empty()) one["model"] = o.explained;
    one["signals"] = nlohmann::ordered_json::array();
    for (const SignalSummary& signal : o.comparison.signals) one["signals"].push_back(signal_json(signal));
    all["recordings"].push_back(std::move(one));
  }
  return json_text(all) + "\n";
}

std::string check_markdown(std::span<const CheckOutcome> outcomes) {
  std::string text = "### omnihil check\n\n| recording | verdict | first difference |\n|---|---|---|\n";
  for (const CheckOutcome& o : outcomes) {
    std::string what = o.passed() ? "" : headline(o);
    if (o.drive) what += "; drive: " + o.drive->text();
    text += fmt::format("| {} | {} | {} |\n", cell(o.file),
                        o.passed()        ? "agrees"
                        : !has_verdict(o) ? fault_word(o.fault)
                                          : "**differs**",
                        cell(what));
  }
  return text + "\n" + check_summary(outcomes);
}

}  // namespace omnihil
