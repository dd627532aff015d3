// `omnihil replay`: the recorded host's bytes through the loop again; says whether the same bytes come back.
#include "hil/recording/replay.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <memory>
#include <string>

#include "hil/field_view/field_page.h"
#include "hil/recording/compare_recordings.h"
#include "hil/recording/recording_reader.h"
#include "hil/recording/recording_writer.h"
#include "hil/recording/replay_report.h"
#include "hil/recording/replay_run.h"
#include "hil/recording/session_setup.h"
#include "hil/recording/snapshot_file.h"
#include "hil/text/dataset_files.h"
#include "tools/command_line.h"
#include "tools/exit_codes.h"
#include "tools/format_argument.h"
#include "tools/guarded.h"
#include "tools/options/replay_words.h"
#include "tools/program_commit.h"
#include "tools/verbs/verbs.h"

namespace omnihil {
namespace {

struct Words {
  ReplayWords replay;
  std::string recording;
  std::string out;
  std::string picture;
  std::string snapshot;  // file
  double snapshot_s = 0.0;
  bool sha256_only = false;
};

// Keeps the world as it was at an instant.
class SnapshotTaker : public SessionObserver {
 public:
  explicit SnapshotTaker(double time_s) : at_ns_(static_cast<std::int64_t>(std::llround(time_s * 1e9))) {}
  void world(std::int64_t now_ns, const World& world) override {
    if (!taken_.world.empty() || now_ns < at_ns_) return;
    taken_.at_ns = now_ns;
    taken_.world = world.save();
  }
  const Snapshot& taken() const { return taken_; }

 private:
  std::int64_t at_ns_;
  Snapshot taken_;
};

std::unique_ptr<RecordingWriter> open_out(const Words& words, const Recording& recording,
                                          const ReplayOptions& options) {
  if (words.out.empty()) return nullptr;
  std::error_code error;
  if (std::filesystem::equivalent(words.out, words.recording, error)) {
    throw std::invalid_argument("--out " + words.out + ": is the recording itself");
  }
  RecordingHeader header = replay_header(recording.header, options);
  header.commit = program_commit();
  auto writer = RecordingWriter::open(words.out, std::move(header), error);
  if (!writer) throw std::system_error(error, words.out);
  return writer;
}

// True when the bytes are those of the recording.
bool say_bytes(const Recording& recording, const Recording& answer) {
  const auto difference = first_byte_difference(recording, answer);
  std::size_t bytes = 0;
  for (const TimedBytes& chunk : dongle_bytes_of(answer)) bytes += chunk.bytes.size();
  if (difference) {
    fmt::print("bytes      differ: {}\n", difference->text());
  } else {
    fmt::print("bytes      identical: {} bytes of the dongle, with their times\n", bytes);
  }
  return !difference;
}

int run_replay(const Words& words) {
  if (!words.replay.format_file.empty() && format_file_or_complain(words.replay.format_file) == nullptr)
    return kExitBadInput;
  const Recording recording = load_recording(std::filesystem::path(words.recording));
  ReplayOptions options = replay_options(words.replay, recording.header);
  const bool as_recorded = same_session(recording.header, options);
  const auto writer = open_out(words, recording, options);
  std::unique_ptr<FieldTrace> trace;
  if (!words.picture.empty())
    trace =
        std::make_unique<FieldTrace>(session_config(session_setup(replay_header(recording.header, options))));
  ObserverList observers({});
  if (writer) observers.add(writer.get());
  if (trace) observers.add(trace.get());
  SnapshotTaker taker(words.snapshot_s);
  if (!words.snapshot.empty()) observers.add(&taker);
  options.observer = &observers;
  const ReplayRun run = run_again(recording, options);
  if (!run.firmware_failure.empty()) {
    fmt::print(stderr, "omnihil replay: {}\n", run.firmware_failure);
    return kExitFirmware;
  }
  if (writer) {
    writer->finish({.now_ns = run.answer.end_ns, .wall_s = run.wall_s, .counters = {}});
    if (writer->error()) throw std::system_error(writer->error(), words.out);
  }
  if (trace) {
    const std::string name = std::filesystem::path(words.recording).filename().string();
    write_field_picture(words.picture, *trace, name);
  }
  if (!words.snapshot.empty()) {
    Snapshot snapshot = taker.taken();
    if (snapshot.world.empty())
      throw std::invalid_argument(
          fmt::format("--snapshot-at {:g}: the run has nothing to keep there", words.snapshot_s));
    snapshot.commit = program_commit();
    snapshot.robots = fmt::format("{} and {} of {}", recording.header.robot_ids.size(),
                                  recording.header.opponent_ids.size(), recording.header.robot_model);
    write_snapshot(words.snapshot, snapshot);
  }
  if (words.sha256_only) {
    fmt::print("{}\n", run.sha256);
    return first_byte_difference(recording, run.answer) && as_recorded ? kExitDiffers : kExitOk;
  }
  fmt::print("recording  {}\n", recording_line(recording));
  fmt::print("replayed   {}\n", replay_line(recording, run));
  const bool same = say_bytes(recording, run.answer);
  fmt::print("sha256     {}\n", run.sha256);
  return same || !as_recorded ? kExitOk : kExitDiffers;
}

}  // namespace

void add_verb_replay(Verb& program, VerbResult& result) {
  auto words = std::make_shared<Words>();
  Verb verb =
      program.add_subcommand("replay", "runs a recording again; says whether the same bytes come back");
  verb.add_option("RECORDING", words->recording, "file that serve --record wrote").required();
  add_replay_options(verb, words->replay);
  verb.add_option("--out", words->out, "write the new run to this file, as a recording");
  verb.add_option("--picture", words->picture,
                  "write the field from above to this file: .svg, .png, or .html with what happened");
  verb.add_option("--snapshot", words->snapshot,
                  "write the world of an instant to this file, for serve --from: robots, motors, ball");
  verb.add_option("--snapshot-at", words->snapshot_s, "which instant, in s")
      .not_negative()
      .capture_default_str();
  verb.add_flag("--sha256", words->sha256_only,
                "print only the SHA-256 of all outputs: bytes with their times, every tick's values");
  verb.footer(
      "The host's bytes are fed at the virtual times at which they came; models are taken from the "
      "recording.\n"
      "Exit code 1: the dongle's bytes are not those of the recording, where nothing else was put in the "
      "place of "
      "what\n"
      "was recorded. Tolerances: see check.");
  verb.callback(
      [words, &result] { result.exit_code = guarded("replay", [&] { return run_replay(*words); }); });
}

}  // namespace omnihil
