#include "hil/check/check_history.h"

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <sstream>
#include <system_error>

#include "hil/text/json_text.h"
#include "hil/text/text_file.h"

namespace omnihil {
namespace {

constexpr double kMost = 1e6;  // a flag that may not differ has a tolerance of zero: no number by it

std::optional<HistoryRun> run_of(const nlohmann::ordered_json& json) {
  if (!json.is_object()) return std::nullopt;
  HistoryRun run;
  const auto text = [&json](const char* key, std::string& value) {
    const auto at = json.find(key);
    if (at == json.end() || !at->is_string()) return false;
    value = at->get<std::string>();
    return true;
  };
  const auto passed = json.find("passed"), over = json.find("over_tolerance");
  if (!text("label", run.label) || !text("date", run.date) || !text("file", run.file) ||
      !text("signal", run.signal))
    return std::nullopt;
  if (passed == json.end() || !passed->is_boolean() || over == json.end() || !over->is_number())
    return std::nullopt;
  run.passed = passed->get<bool>();
  run.over_tolerance = over->get<double>();
  return run;
}

}  // namespace

std::vector<HistoryRun> CheckHistory::runs_of(const std::string& file) const {
  std::vector<HistoryRun> found;
  std::ranges::copy_if(runs, std::back_inserter(found),
                       [&](const HistoryRun& run) { return run.file == file; });
  return found;
}

HistoryRun history_run(const CheckOutcome& outcome, const std::string& label, const std::string& date) {
  HistoryRun run{label, date, outcome.file, outcome.passed(), "", 0.0};
  for (const SignalSummary& signal : outcome.comparison.signals) {
    const double over = std::min(kMost, signal.over_tolerance());
    if (over <= run.over_tolerance) continue;
    run.over_tolerance = over;
    run.signal = signal.name;
  }
  return run;
}

void append_history(const std::string& path, std::span<const CheckOutcome> outcomes, const std::string& label,
                    const std::string& date) {
  std::string lines;
  for (const CheckOutcome& outcome : outcomes) {
    const HistoryRun run = history_run(outcome, label, date);
    lines += json_text({{"label", run.label},
                        {"date", run.date},
                        {"file", run.file},
                        {"passed", run.passed},
                        {"signal", run.signal},
                        {"over_tolerance", run.over_tolerance}}) +
             "\n";
  }
  append_text_file(path, lines);
}

CheckHistory parse_history(const std::string& text) {
  CheckHistory history;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line.empty()) continue;
    if (auto run = run_of(json_of(line))) {
      history.runs.push_back(std::move(*run));
    } else {
      ++history.lines_not_understood;
    }
  }
  return history;
}

CheckHistory load_history(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file && !std::filesystem::exists(path)) return {};
  if (!file) throw std::system_error(std::make_error_code(std::errc::permission_denied), path);
  return parse_history({std::istreambuf_iterator<char>(file), {}});
}

}  // namespace omnihil
