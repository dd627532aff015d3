// `omnihil check`: one recording, one command, one verdict.
#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>

#include "hil/recording/compare_recordings.h"
#include "hil/recording/recording_header.h"
#include "hil/recording/recording_reader.h"
#include "hil/recording/replay_report.h"
#include "hil/recording/replay_run.h"
#include "tools/command_line.h"
#include "tools/exit_codes.h"
#include "tools/format_argument.h"
#include "tools/guarded.h"
#include "tools/program_commit.h"
#include "tools/verbs/verbs.h"

namespace omnihil {
namespace {

struct CheckWords {
  std::string format_file;
  std::string recording;
  std::vector<std::string> tolerances;  // KEY=VALUE, a file, or "default"
  std::string physics;
  bool exact = false;
  bool quiet = false;
};

void read_tolerance_file(const std::string& path, const RadioFormat* format, Tolerances& tolerances,
                         std::vector<std::string>& problems) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::system_error(std::make_error_code(std::errc::no_such_file_or_directory), path);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  tolerances.read_file(text, path, format, problems);
}

// `reason` says how tolerances were chosen.
Tolerances choose_tolerances(const CheckWords& words, const Recording& recording, const RadioFormat* format,
                             std::string& reason) {
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
  const bool same_physics = words.physics.empty();
  tolerances.exact = words.exact || (words.tolerances.empty() && same_program && same_physics);
  reason = words.exact                 ? "exact, as asked"
           : !words.tolerances.empty() ? "as given, over the defaults"
           : tolerances.exact          ? "exact: recorded by this same commit"
           : !same_physics
               ? "defaults: other physics than recorded"
               : std::string("defaults: recorded by another commit than this one, ") + program_commit();
  return tolerances;
}

int verdict(const RecordingComparison& comparison) {
  for (const std::string& column : comparison.not_compared) {
    fmt::print("not compared: column '{}', which this program does not have\n", column);
  }
  fmt::print("compared   {} values: {} samples, {} packets; bytes {}, samples {}\n", comparison.values(),
             comparison.samples, comparison.packets,
             comparison.bytes_identical ? "identical" : "not identical",
             comparison.samples_identical ? "identical" : "not identical");
  if (comparison.agrees() && comparison.values() == 0) {
    throw std::invalid_argument(
        "nothing to compare: the recording has neither samples nor bytes of the dongle");
  }
  if (comparison.agrees()) {
    fmt::print("agrees\n");
    return kExitOk;
  }
  fmt::print("differs    first at {}\n", comparison.first->text());
  return kExitDiffers;
}

int run_check(const CheckWords& words) {
  if (!words.format_file.empty() && format_file_or_complain(words.format_file) == nullptr)
    return kExitBadInput;
  const Recording recording = load_recording(std::filesystem::path(words.recording));
  const RadioFormat* format = find_radio_format(recording.header.radio_format);
  std::string reason;
  const Tolerances tolerances = choose_tolerances(words, recording, format, reason);
  const ReplayRun run = run_again(recording, {.physics = parse_physics(words.physics), .observer = nullptr});
  const RecordingComparison comparison = compare_recordings(recording, run.answer, *format, tolerances);
  fmt::print("recording  {}\n", recording_line(recording));
  fmt::print("replayed   {}\n", replay_line(recording, run));
  fmt::print("tolerances {}\n", reason);
  if (!words.quiet) fmt::print("\n{}\n", comparison_table(comparison));
  return verdict(comparison);
}

}  // namespace

void add_verb_check(Verb& program, VerbResult& result) {
  auto words = std::make_shared<CheckWords>();
  Verb verb =
      program.add_subcommand("check", "replays a recording and compares the answers; the verdict for CI");
  verb.add_option("RECORDING", words->recording, "file that serve --record wrote").required();
  verb.add_option("--format", words->format_file,
                  "radio format of the recording from this file, where it was made with one");
  verb.add_option("--tolerance", words->tolerances,
                  "KEY=VALUE, a file of such lines, or 'default'; may be given several times");
  verb.add_flag("--exact", words->exact, "bytes and samples must be identical in every bit");
  verb.add_option("--physics", words->physics, "instead of the recorded one: simbody, planar or simbody-free")
      .one_of({"simbody", "planar", "simbody-free"});
  verb.add_flag("--quiet", words->quiet, "without the table of signals");
  verb.footer(
      "Exact when the recording was made by this same commit, else within tolerances, which are absolute and "
      "in the\n"
      "signal's unit. KEY is a column of the recording (with or without its wheel number), MESSAGE.FIELD of "
      "the radio\n"
      "format, unit:UNIT, or packet_time_s; the most particular holds.\n" +
      default_tolerance_text() +
      ".\nA packet's field may besides differ by one step of its resolution; flags, ids and counters may "
      "not.\n"
      "Exit codes: 0 agrees, 1 differs (the first difference is named: time, robot, field, both values, "
      "tolerance),\n"
      "2 unusable recording or arguments, 3 a file could not be read.");
  verb.callback([words, &result] { result.exit_code = guarded("check", [&] { return run_check(*words); }); });
}

}  // namespace omnihil
