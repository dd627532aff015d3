// `omnihil check`: recordings, one command, one verdict.
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>

#include "hil/check/check_history.h"
#include "hil/check/check_page.h"
#include "hil/check/check_recording.h"
#include "hil/check/check_report.h"
#include "hil/check/compare_versions.h"
#include "hil/check/explain_difference.h"
#include "hil/recording/recording_header.h"
#include "hil/recording/recording_reader.h"
#include "hil/recording/replay_report.h"
#include "hil/text/dataset_files.h"
#include "hil/text/text_file.h"
#include "hil/text/today.h"
#include "tools/command_line.h"
#include "tools/exit_codes.h"
#include "tools/format_argument.h"
#include "tools/guarded.h"
#include "tools/options/replay_words.h"
#include "tools/program_commit.h"
#include "tools/progress_line.h"
#include "tools/verbs/verbs.h"

namespace omnihil {
namespace {

namespace fs = std::filesystem;

struct CheckWords {
  ReplayWords replay, versus;
  std::vector<std::string> paths;
  std::vector<std::string> tolerances;  // KEY=VALUE, a file, or "default"
  std::string junit, json, html, summary, history, label;
  bool exact = false;
  bool quiet = false;
  bool explain = false;

  bool has_versus() const {
    return versus.firmware.names_any() || !versus.robot.empty() || !versus.with.empty();
  }
};

void read_tolerance_file(const std::string& path, const RadioFormat* format, Tolerances& tolerances,
                         std::vector<std::string>& problems) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::system_error(std::make_error_code(std::errc::no_such_file_or_directory), path);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  tolerances.read_file(text, path, format, problems);
}

// `reason` says how tolerances were chosen.
Tolerances choose_tolerances(const CheckWords& words, const Recording& recording,
                             const ReplayOptions& options, const RadioFormat* format, std::string& reason) {
  Tolerances tolerances;
  std::vector<std::string> problems;
  if (words.exact && !words.tolerances.empty())
    problems.push_back("--exact and --tolerance: only one of them");
  for (const std::string& word : words.tolerances) {
    if (word == "default") continue;
    if (word.find('=') != std::string::npos) {
      tolerances.read(word, "--tolerance", format, problems);
    } else {
      read_tolerance_file(word, format, tolerances, problems);
    }
  }
  if (!problems.empty()) throw BadRecording(problems);
  const bool same_program =
      recording.header.commit == program_commit() && recording.header.commit != "unknown";
  const bool as_recorded = same_session(recording.header, options);
  tolerances.exact = words.exact || (words.tolerances.empty() && same_program && as_recorded);
  reason = words.exact                 ? "exact, as asked"
           : !words.tolerances.empty() ? "as given, over the defaults"
           : tolerances.exact          ? "exact: recorded by this same commit"
           : !as_recorded
               ? "defaults: not everything is as recorded"
               : std::string("defaults: recorded by another commit than this one, ") + program_commit();
  return tolerances;
}

// Files as given, and those of folders below them, by name.
std::vector<std::string> recordings_of(const std::vector<std::string>& paths) {
  std::vector<std::string> files;
  for (const std::string& path : paths) {
    if (!fs::is_directory(path)) {
      files.push_back(path);
      continue;
    }
    std::vector<std::string> found;
    for (const auto& entry : fs::recursive_directory_iterator(path)) {
      if (entry.is_regular_file() && entry.path().extension() == ".omnirec")
        found.push_back(entry.path().string());
    }
    if (found.empty()) throw std::invalid_argument(path + ": no file NAME.omnirec in this folder");
    std::ranges::sort(found);
    files.insert(files.end(), found.begin(), found.end());
  }
  return files;
}

CheckOutcome checked(const CheckWords& words, const std::string& file) {
  const Recording recording = load_recording(fs::path(file));
  CheckOptions options;
  ConsoleKeeper console;
  ReplayWords replay = words.replay;
  replay.firmware.all.listeners.on_line = console.listener();
  options.console = &console;
  options.replay = replay_options(replay, recording.header);
  options.replay.observer = &console;
  const RadioFormat* format = find_radio_format(recording.header.radio_format);
  if (format == nullptr) {
    throw std::invalid_argument(fmt::format("radio format '{}' is not known: name its file with --format",
                                            recording.header.radio_format));
  }
  options.tolerances = choose_tolerances(words, recording, options.replay, format, options.tolerance_reason);
  options.charts = words.html.empty() ? 0 : kPageCharts;
  CheckOutcome outcome = check_recording(file, recording, *format, options);
  if (words.explain && !outcome.comparison.agrees()) {
    ProgressLine progress;
    outcome.explained = explained_text(
        explain_difference(recording, *format, options.replay, [&](std::size_t done, std::size_t all) {
          progress.show("trying changes of the model", static_cast<double>(done) / static_cast<double>(all));
        }));
  }
  return outcome;
}

// Of several recordings one that cannot be used does not keep the others from their verdict.
CheckOutcome checked_or_why_not(const CheckWords& words, const std::string& file) {
  CheckOutcome out;
  out.file = file;
  const auto because = [&out](CheckFault fault, const std::exception& error) {
    out.fault = fault;
    out.fault_text = error.what();
  };
  try {
    return checked(words, file);
  } catch (const BadRecording& error) {
    because(CheckFault::kBadInput, error);
  } catch (const std::invalid_argument& error) {
    because(CheckFault::kBadInput, error);
  } catch (const std::system_error& error) {
    because(CheckFault::kIo, error);
  } catch (const std::exception& error) {
    because(CheckFault::kDiverged, error);
  }
  return out;
}

int exit_code_of(const CheckOutcome& o) {
  switch (o.fault) {
    case CheckFault::kNone:
      return o.passed() ? kExitOk : kExitDiffers;
    case CheckFault::kBadInput:
      return kExitBadInput;
    case CheckFault::kIo:
      return kExitIo;
    case CheckFault::kDiverged:
      return kExitDiverged;
    case CheckFault::kFirmware:
      return kExitFirmware;
  }
  return kExitOk;
}

// In CI the commit under test; else the day.
std::string label_of(const CheckWords& words) {
  if (!words.label.empty()) return words.label;
  const char* commit = std::getenv("GITHUB_SHA");  // docs.github.com, default environment variables
  return commit != nullptr && *commit != 0 ? std::string(commit).substr(0, 7) : today_utc();
}

void write_reports(const CheckWords& words, const std::vector<CheckOutcome>& outcomes) {
  const std::string program = std::string("omnihil ") + program_commit();
  if (!words.junit.empty()) replace_file(words.junit, check_junit(outcomes));
  if (!words.json.empty()) replace_file(words.json, check_json(outcomes, program));
  if (!words.summary.empty()) append_text_file(words.summary, check_markdown(outcomes));
  if (!words.history.empty()) append_history(words.history, outcomes, label_of(words), today_utc());
  if (words.html.empty()) return;
  const CheckHistory history = words.history.empty() ? CheckHistory{} : load_history(words.history);
  if (history.lines_not_understood > 0)
    fmt::print("note: {}: {} lines not understood\n", words.history, history.lines_not_understood);
  replace_file(words.html, check_page(outcomes, history, program));
}

// Two builds or models against each other, for every recording; differing is no failure, it is what was asked.
int run_versus(const CheckWords& words, const std::vector<std::string>& files) {
  for (const std::string& file : files) {
    const Recording recording = load_recording(fs::path(file));
    ReplayWords other = words.versus;
    other.physics = words.replay.physics;
    other.seed = words.replay.seed;
    if (!other.firmware.names_any()) other.firmware = words.replay.firmware;
    if (other.robot.empty()) other.robot = words.replay.robot;
    const ReplayOptions a = replay_options(words.replay, recording.header);
    const ReplayOptions b = replay_options(other, recording.header);
    const RadioFormat* format = find_radio_format(recording.header.radio_format);
    std::string reason;
    const Tolerances tolerances = choose_tolerances(words, recording, a, format, reason);
    const VersionsComparison both = compare_versions(recording, *format, a, b, tolerances);
    fmt::print("recording  {}: {}\nA          {}\nB          {}\n", file, recording_line(recording),
               replay_line(recording, both.a), replay_line(recording, both.b));
    for (const std::string& change : session_changes(both.a.answer.header, b))
      fmt::print("B against A {}\n", change);
    fmt::print("\n{}\n", versions_table(both));
    if (both.first) fmt::print("B leaves A first at {}\n", both.first->text());
    for (const ReplayRun* run : {&both.a, &both.b}) {
      if (run->firmware_failure.empty()) continue;
      fmt::print(stderr, "omnihil check: {}\n", run->firmware_failure);
      return kExitFirmware;
    }
  }
  return kExitOk;
}

int run_check(const CheckWords& words) {
  if (!words.replay.format_file.empty() && format_file_or_complain(words.replay.format_file) == nullptr)
    return kExitBadInput;
  const std::vector<std::string> files = recordings_of(words.paths);
  if (words.has_versus()) return run_versus(words, files);
  std::vector<CheckOutcome> outcomes;
  if (files.size() == 1) {
    outcomes.push_back(checked(words, files.front()));
    fmt::print("{}", check_text(outcomes.front(), !words.quiet));
  } else {
    for (const std::string& file : files) {
      outcomes.push_back(checked_or_why_not(words, file));
      fmt::print("{}", check_line(outcomes.back()));
      std::fflush(stdout);
    }
    fmt::print("{}", check_summary(outcomes));
  }
  write_reports(words, outcomes);
  int worst = kExitOk;
  for (const CheckOutcome& outcome : outcomes) worst = std::max(worst, exit_code_of(outcome));
  return worst;
}

void add_report_options(Verb& verb, CheckWords& words) {
  verb.add_option("--junit", words.junit, "write JUnit XML to this file");
  verb.add_option("--json", words.json, "write all figures as JSON to this file");
  verb.add_option("--html", words.html, "write one page with plots of what differs to this file");
  verb.add_option("--summary", words.summary,
                  "append a Markdown table to this file, such as $GITHUB_STEP_SUMMARY");
  verb.add_option("--history", words.history,
                  "append a line per recording to this file; the page shows the trend");
  verb.add_option("--label", words.label,
                  "what this run is called in the history (default: $GITHUB_SHA, else the day)");
}

void add_versus_options(Verb& verb, CheckWords& words) {
  verb.add_option("--versus-firmware", words.versus.firmware.all.file,
                  "a second build: both against the recording and each other, in one table");
  verb.add_option("--versus-board", words.versus.firmware.all.board, "its board file");
  verb.add_option("--versus-robot", words.versus.robot, "a second model, the same way");
  verb.add_option("--versus-with", words.versus.with, "effects of the second model");
}

}  // namespace

void add_verb_check(Verb& program, VerbResult& result) {
  auto words = std::make_shared<CheckWords>();
  Verb verb =
      program.add_subcommand("check", "replays recordings and compares the answers; the verdict for CI");
  verb.add_option("RECORDING", words->paths,
                  "files that serve --record wrote, or folders of them (*.omnirec)")
      .required();
  add_replay_options(verb, words->replay);
  verb.add_option("--tolerance", words->tolerances,
                  "KEY=VALUE, a file of such lines, or 'default'; may be given several times");
  verb.add_flag("--exact", words->exact, "bytes and samples must be identical in every bit");
  verb.add_flag("--explain", words->explain,
                "where it differs, search which parameter or effect of the model would explain it");
  verb.add_flag("--quiet", words->quiet, "without the table of signals");
  add_report_options(verb, *words);
  add_versus_options(verb, *words);
  verb.footer(
      "Exact when the recording was made by this same commit and nothing else is changed, else within "
      "tolerances,\n"
      "which are absolute and in the signal's unit. KEY is a column of the recording (with or without its "
      "wheel "
      "number),\n"
      "MESSAGE.FIELD of the radio format, unit:UNIT, or packet_time_s; the most particular holds.\n" +
      default_tolerance_text() +
      ".\nA packet's field may besides differ by one step of its resolution; flags, ids and counters may "
      "not.\n"
      "Exit codes: 0 agrees, 1 differs (the first difference is named: time, robot, field, both values, "
      "tolerance),\n"
      "2 unusable recording or arguments, 3 a file could not be read, 6 the firmware crashed or hung; of "
      "several\n"
      "recordings the greatest.");
  verb.callback([words, &result] { result.exit_code = guarded("check", [&] { return run_check(*words); }); });
}

}  // namespace omnihil
