// omnihil twin RECORDING: the model beside what a robot did, and alarms with a suspect where they part.
#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include "hil/dataset/dataset_reader.h"
#include "hil/recording/recording_reader.h"
#include "hil/twin/twin_feed.h"
#include "hil/twin/twin_runner.h"
#include "tools/command_line.h"
#include "tools/exit_codes.h"
#include "tools/format_argument.h"
#include "tools/guarded.h"
#include "tools/options/twin_options.h"
#include "tools/verbs/verbs.h"

namespace omnihil {
namespace {

struct Words {
  std::string data, format_file;
  TwinWords twin;
};

void watch_recording(const Words& words, TwinRunner& runner) {
  const Recording recording = load_recording(words.data);
  const RadioFormat* format = format_or_complain(recording.header.radio_format, words.format_file);
  if (format == nullptr) throw std::invalid_argument("the packets of this recording cannot be read");
  TwinFeed feed(*format, {.robot_ids = recording.header.robot_ids,
                          .team = recording.header.team,
                          .robot = twin_robot(words.twin, recording.header.robot_ids),
                          .step_ns = recording.header.step_ns});
  const auto until = [&](std::int64_t now_ns) {
    while (const std::optional<Run> piece = feed.next(now_ns)) runner.take(*piece);
  };
  for (const RecordedChunk& chunk : recording.chunks) {
    if (chunk.kind == RecordedChunk::Kind::kHostBytes) feed.host_bytes(chunk.now_ns, chunk.bytes);
    if (chunk.kind == RecordedChunk::Kind::kDongleBytes) feed.dongle_bytes(chunk.now_ns, chunk.bytes);
    until(chunk.now_ns);
  }
  until(recording.end_ns + 1'000'000'000);
}

// Its runs one after another, in pieces; times go on from run to run.
void watch_dataset(const Words& words, TwinRunner& runner) {
  const DatasetReading reading = read_dataset(words.data, words.twin.model);
  for (const ModelProblem& p : reading.problems) std::fprintf(stderr, "omnihil twin: %s\n", p.text().c_str());
  if (!reading.dataset) throw std::invalid_argument(words.data + ": cannot be used");
  if (reading.dataset->firmware)
    throw std::invalid_argument(words.data +
                                ": has a firmware library, where the twin runs the model's [controller]");
  double start_s = 0.0;
  for (const Run& run : reading.dataset->runs) {
    const double shift_s = start_s - run.time_s.front();
    for (std::size_t first = 0; first + 1 < run.time_s.size();) {
      std::size_t last = first + 1;
      while (last + 1 < run.time_s.size() && run.time_s[last] < run.time_s[first] + TwinOptions{}.window_s)
        ++last;
      Run piece;
      for (std::size_t k = first; k <= last; ++k) piece.time_s.push_back(run.time_s[k] + shift_s);
      for (const auto& [name, values] : run.signals) {
        piece.signals[name].assign(values.begin() + static_cast<std::ptrdiff_t>(first),
                                   values.begin() + static_cast<std::ptrdiff_t>(last) + 1);
      }
      runner.take(piece);
      first = last;
    }
    start_s += run.duration_s();
    runner.pause();
  }
}

int run_twin(const Words& words) {
  TwinLog log(words.twin);
  TwinRunner runner(twin_model(words.twin), card_errors(words.twin.model), twin_options(words.twin),
                    [&](const TwinEvent& event) {
                      fmt::print("{}\n", twin_text(event));
                      log.write(event);
                    });
  const bool dataset = std::filesystem::is_directory(words.data) || words.data.ends_with(".toml");
  dataset ? watch_dataset(words, runner) : watch_recording(words, runner);
  if (runner.watch().learning()) {
    fmt::print(stderr,
               "omnihil twin: only {:.0f} s of driving with telemetry, {:.0f} s are asked for to learn from "
               "(--twin-learn)\n",
               runner.watch().learned_s(), words.twin.learn_s);
    return kExitBadInput;
  }
  fmt::print("watched {:.1f} s: {} alarm{}\n", runner.watched_s(), runner.alarms(),
             runner.alarms() == 1 ? "" : "s");
  return runner.alarms() == 0 ? kExitOk : kExitDiffers;
}

}  // namespace

void add_verb_twin(Verb& program, VerbResult& result) {
  auto words = std::make_shared<Words>();
  Verb verb = program.add_subcommand(
      "twin", "the model beside a recorded robot: alarms with a suspect where they part");
  verb.add_option("RECORDING", words->data, "recording of a tap, or a dataset of radio commands").required();
  verb.add_option("--format", words->format_file, "radio format from this file");
  verb.add_option("--model", words->twin.model, "model of the robot, with [controller]").required();
  add_twin_options(verb, words->twin);
  verb.footer(
      "Live, beside a robot that plays: `omnihil tap DEVICE --twin MODEL`. Exit codes: 1 an alarm was "
      "raised; 2 "
      "bad words, too\n"
      "little driving to learn from.");
  verb.callback([words, &result] { result.exit_code = guarded("twin", [&] { return run_twin(*words); }); });
}

}  // namespace omnihil
