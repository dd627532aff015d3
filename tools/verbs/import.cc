// omnihil import LOG…: what a real robot's radio was heard to say, as a recording that `check` takes; or logs of numbers, as a
// dataset.
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "hil/logs/log_table.h"
#include "hil/loop/effect_overrides.h"
#include "hil/loop/session_checks.h"
#include "hil/recording/capture_import.h"
#include "hil/recording/log_import.h"
#include "hil/recording/recording_writer.h"
#include "hil/recording/session_setup.h"
#include "hil/text/program_files.h"
#include "hil/text/text_file.h"
#include "tools/command_line.h"
#include "tools/exit_codes.h"
#include "tools/format_argument.h"
#include "tools/guarded.h"
#include "tools/options/capture_options.h"
#include "tools/options/import_dataset.h"
#include "tools/program_commit.h"
#include "tools/verbs/verbs.h"

namespace omnihil {
namespace {

struct ImportWords {
  std::string log, robot = "omni_default", radio, format_file, robots = "0-5", team = "blue", out;
  CaptureWords capture;
  ImportDatasetWords dataset;
};

SessionSetup setup_of(const ImportWords& words) {
  SessionSetup setup;
  std::vector<std::string> problems;
  const StoredModel stored = load_robot_model(words.robot, {data_folder("models")});
  for (const ModelProblem& problem : stored.problems) problems.push_back(problem.text());
  throw_problems(problems);
  setup.model = stored.bundle;
  setup.radio_format = !words.radio.empty() ? words.radio : stored.model->radio;
  setup.robot_ids = parse_robot_list(words.robots, problems);
  setup.team = words.team == "blue" ? Team::kBlue : Team::kYellow;
  throw_problems(problems);
  return setup;
}

struct ImportedLog {
  LogImport log;
  std::uint64_t epoch_ms = 0;  // 0: its times are none of Unix
  std::vector<std::string> notes;
};

ImportedLog capture_log(const ImportWords& words, const SessionSetup& setup) {
  const CaptureFilter filter = capture_filter(words.capture);
  const RadioFormat* format = find_radio_format(setup.radio_format);  // session_config() has found it
  CaptureImport capture =
      import_capture(load_capture(words.log, filter), filter, *format, words.log, setup.step_ns);
  ImportedLog out;
  out.notes = std::move(capture.notes);
  out.log.chunks = std::move(capture.chunks);
  out.log.end_ns = (out.log.chunks.back().now_ns / setup.step_ns + 2) * setup.step_ns;
  out.log.most_moved_ns = put_off_to_steps(out.log.chunks, setup.step_ns);
  out.log.first_s = static_cast<double>(capture.start_ns) / 1e9;
  if (capture.unix_time) out.epoch_ms = static_cast<std::uint64_t>(capture.start_ns / 1'000'000);
  return out;
}

ImportedLog text_log(const ImportWords& words, const SessionSetup& setup) {
  std::string error_text;
  const std::string text = read_text_file(words.log, error_text);
  if (!error_text.empty())
    throw std::system_error(std::make_error_code(std::errc::io_error), words.log + ": " + error_text);
  ImportedLog out;
  out.log = parse_radio_log(text, words.log, setup.step_ns);
  constexpr double kUnixFrom_s = 1e9;  // September 2001: what is less counts from the start of something
  if (out.log.first_s >= kUnixFrom_s) out.epoch_ms = static_cast<std::uint64_t>(out.log.first_s * 1e3);
  return out;
}

int run_import(ImportWords words) {
  if (words.dataset.any() ||
      (!is_capture_file(words.dataset.files.front()) && looks_like_log(words.dataset.files.front()))) {
    words.dataset.out = words.out;
    return import_dataset(words.dataset);
  }
  if (words.dataset.files.size() > 1)
    throw std::invalid_argument(words.dataset.files[1] +
                                ": a recording is made of one log; several make a dataset, with --model");
  words.log = words.dataset.files.front();
  if (!words.format_file.empty()) {
    const RadioFormat* format = format_file_or_complain(words.format_file);
    if (format == nullptr) return kExitBadInput;
    words.radio = format->id;
  }
  const SessionSetup setup = setup_of(words);
  session_config(setup);  // says what is wrong with it
  const auto [log, epoch_ms, notes] =
      is_capture_file(words.log) ? capture_log(words, setup) : text_log(words, setup);
  if (std::filesystem::exists(words.out)) throw FileExists(words.out + ": is there already");
  RecordingHeader header = recording_header(setup, "imported");
  header.firmware = "as on the robot";
  // Packets that carry a time carry the log's.
  if (epoch_ms != 0) header.epoch_ms = epoch_ms;
  std::error_code error;
  const auto writer = RecordingWriter::open(words.out, std::move(header), error);
  if (!writer) throw std::system_error(error, words.out);
  std::size_t host = 0, back = 0;
  for (const RecordedChunk& chunk : log.chunks) {
    if (chunk.kind == RecordedChunk::Kind::kHostBytes) {
      writer->host_bytes(chunk.now_ns, chunk.bytes);
      ++host;
    } else {
      writer->dongle_bytes(chunk.now_ns, chunk.bytes);
      ++back;
    }
  }
  writer->finish({.now_ns = log.end_ns, .wall_s = 0.0, .counters = {}});
  if (writer->error()) throw std::system_error(writer->error(), words.out);
  print_notes(notes);
  fmt::print(
      "{}: {:.3f} s from {:.3f} s on, {} writes of the host, {} of the robots; host put off by {:.3f} ms "
      "at most\n",
      words.out, static_cast<double>(log.end_ns) / 1e9, log.first_s, host, back,
      static_cast<double>(log.most_moved_ns) / 1e6);
  return kExitOk;
}

}  // namespace

void add_verb_import(Verb& program, VerbResult& result) {
  auto words = std::make_shared<ImportWords>();
  Verb verb = program.add_subcommand(
      "import", "logs as what omnihil takes: radio as a recording, numbers as a dataset");
  verb.add_option(
          "LOG", words->dataset.files,
          "radio: candump, asc, pcap, pcapng, CSV of time and hex, or text, a line each: TIME_S > HEX (host) "
          "or TIME_S < HEX (robots); numbers: CSV (also of ODrive, moteus, VESC, SimpleFOC), .mat, wpilog, "
          "ULog, MCAP, rosbag2")
      .required();
  verb.add_option("--robot", words->robot, "robot model: a name or a .toml file").capture_default_str();
  verb.add_option("--radio", words->radio, "radio format (default: the robot model's own)");
  verb.add_option("--format", words->format_file, "radio format from this file");
  verb.add_option("--robots", words->robots, "robot ids that were on the field: 0-5 or 0,2,7")
      .capture_default_str();
  verb.add_option("--team", words->team, "team colour").one_of({"blue", "yellow"}).capture_default_str();
  verb.add_option("--out", words->out,
                  "recording, or folder of the dataset, to make; what is there is never overwritten")
      .required();
  add_capture_options(verb, words->capture);
  add_import_dataset_options(verb, words->dataset);
  verb.footer(
      "`check RECORDING --explain` then has the model answer the same commands and says what of it differs.\n"
      "Times may begin anywhere (Unix time). What of a capture was left out or taken for granted is said in "
      "notes.\n"
      "A dataset is what `compare` and `diagnose` take; in doubt over a column it is not written and the "
      "flags to give are said.\n"
      "Exit codes: 1 the dataset was written, but has a fault of the data; 2 a line that cannot be used, all "
      "named; 3 a file.");
  verb.callback(
      [words, &result] { result.exit_code = guarded("import", [&] { return run_import(*words); }); });
}

}  // namespace omnihil
