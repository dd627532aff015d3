// omnihil tap DEVICE: between the AI host and its real dongle; every byte passes, and is recorded.
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hil/loop/effect_overrides.h"
#include "hil/loop/session_checks.h"
#include "hil/recording/recording_writer.h"
#include "hil/recording/replay.h"
#include "hil/recording/session_setup.h"
#include "hil/serve/serve_signals.h"
#include "hil/tap/tap_loop.h"
#include "hil/text/program_files.h"
#include "hil/twin/twin_thread.h"
#include "tools/command_line.h"
#include "tools/exit_codes.h"
#include "tools/format_argument.h"
#include "tools/guarded.h"
#include "tools/options/open_end.h"
#include "tools/options/twin_options.h"
#include "tools/options/vision_options.h"
#include "tools/program_commit.h"
#include "tools/verbs/verbs.h"

namespace omnihil {
namespace {

struct TapWords {
  std::string dongle, device = "./dongle", robot = "omni_default", radio, format_file, robots = "0-5",
                      team = "blue", out;
  VisionWords vision;
  TwinWords twin;
};

// The model beside the robot, and what it says: alarms on stderr, whatever the status line does on stdout.
class TapTwin {
 public:
  TapTwin(const TapWords& words, const SessionSetup& setup)
      : log_(words.twin),
        runner_(twin_model(words.twin), card_errors(words.twin.model), twin_options(words.twin),
                [this](const TwinEvent& event) { tell(event); }),
        feed_(*find_radio_format(setup.radio_format), {.robot_ids = setup.robot_ids,
                                                       .team = setup.team,
                                                       .robot = twin_robot(words.twin, setup.robot_ids),
                                                       .step_ns = setup.step_ns}) {}
  void start() { thread_.emplace(feed_, runner_, stdout); }
  SessionObserver* observer() { return &*thread_; }
  // Exit code; what was seen is said.
  int finish(std::int64_t end_ns) {
    thread_->finish(end_ns);
    const std::string learning = runner_.watch().learning() ? ", still learning" : "";
    fmt::print("twin: {} commands, {} answers, watched {:.1f} s{}: {} alarm{}\n", feed_.commands(),
               feed_.told(), runner_.watched_s(), learning, runner_.alarms(),
               runner_.alarms() == 1 ? "" : "s");
    if (feed_.left_out() > 0)
      fmt::print(
          "twin: {} commands are left out: to a heading, of duties, or of another kind than the first\n",
          feed_.left_out());
    if (thread_->left_out() > 0)
      fmt::print("twin: this computer could not keep up, {} bytes were not watched\n", thread_->left_out());
    return runner_.alarms() == 0 ? kExitOk : kExitDiffers;
  }

 private:
  void tell(const TwinEvent& event) {
    fmt::print(stderr, "{}\n", twin_text(event));
    log_.write(event);
  }
  TwinLog log_;
  TwinRunner runner_;
  TwinFeed feed_;
  std::optional<TwinThread> thread_;
};

SessionSetup tap_setup(const TapWords& words) {
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
  session_config(setup);  // says what is wrong with it
  return setup;
}

int run_tap_verb(TapWords words) {
  if (!words.format_file.empty()) {
    const RadioFormat* format = format_file_or_complain(words.format_file);
    if (format == nullptr) return kExitBadInput;
    words.radio = format->id;
  }
  const SessionSetup setup = tap_setup(words);
  std::optional<TapTwin> twin;
  if (!words.twin.model.empty()) twin.emplace(words, setup);
  if (!words.out.empty() && std::filesystem::exists(words.out))
    throw FileExists(words.out + ": is there already");
  std::unique_ptr<ByteWire> dongle = open_end(words.dongle, "serial", "DEVICE");
  std::unique_ptr<ByteWire> host = open_end(words.device, "pty", "--device");
  std::unique_ptr<RecordingWriter> writer;
  if (!words.out.empty()) {
    RecordingHeader header = recording_header(setup, "tapped");
    header.firmware = "as on the robot";
    std::error_code error;
    writer = RecordingWriter::open(words.out, std::move(header), error,
                                   [](const std::string& text) { fmt::print(stderr, "{}\n", text); });
    if (!writer) throw std::system_error(error, words.out);
  }
  std::optional<TapVision> vision;
  if (std::optional<UdpPort> group = open_vision(words.vision)) {
    if (words.out.empty())
      throw std::invalid_argument("--vision: needs --record, beside which its table stands");
    vision.emplace(std::move(*group), words.out + ".vision.csv");
  }
  fmt::print("{} ready, passed on to {}\n", host->name(), dongle->name());
  std::fflush(stdout);
  const StopSignals stop;
  if (twin) twin->start();
  ObserverList observers({});
  if (writer) observers.add(writer.get());
  if (twin) observers.add(twin->observer());
  Tap tap(std::move(host), std::move(dongle), &observers, setup.step_ns);
  const TapRun run = run_tap(
      tap, [] { return StopSignals::requested(); }, vision ? &*vision : nullptr);
  if (writer)
    writer->finish({.now_ns = (run.end_ns / setup.step_ns + 2) * setup.step_ns,
                    .wall_s = 1e-9 * static_cast<double>(run.end_ns),
                    .counters = {}});
  const int seen = twin ? twin->finish(run.end_ns) : kExitOk;
  const TapCounts& c = tap.counts();
  fmt::print("{:.3f} s: {} bytes to the dongle, {} to the host, {} with no host there; host left {} times\n",
             1e-9 * static_cast<double>(run.end_ns), c.to_dongle, c.to_host, c.without_host, c.host_left);
  fmt::print(
      "own delay, from bytes that wait to bytes handed on: p50 {:.0f} us, p99 {:.0f} us, at most {:.0f} us "
      "in {} passes\n",
      run.delay.p50_us, run.delay.p99_us, run.delay.most_us, run.delay.passes);
  if (vision)
    fmt::print("vision: {} frames, in {}.vision.csv on the recording's clock\n{}", vision->frames(),
               words.out, vision->finish(run.unix_start_s));
  if (writer && writer->error()) throw std::system_error(writer->error(), words.out);
  if (!run.lost) return seen;
  fmt::print(stderr, "omnihil tap: {}\n", tap.problem());
  return kExitIo;
}

}  // namespace

void add_verb_tap(Verb& program, VerbResult& result) {
  auto words = std::make_shared<TapWords>();
  Verb verb =
      program.add_subcommand("tap", "between an AI host and its real dongle: passes every byte, records it");
  verb.add_option("DEVICE", words->dongle, "the real dongle: a serial device, or a wire by URL (udp:, tcp:)")
      .required();
  verb.add_option("--device", words->device, "what the host opens instead: a path, or a wire by URL")
      .capture_default_str();
  verb.add_option("--record", words->out, "recording to make; what is there is never overwritten");
  verb.add_option("--robot", words->robot, "robot model: a name or a .toml file").capture_default_str();
  verb.add_option("--radio", words->radio, "radio format (default: the robot model's own)");
  verb.add_option("--format", words->format_file, "radio format from this file");
  verb.add_option("--robots", words->robots, "robot ids on the field: 0-5 or 0,2,7").capture_default_str();
  verb.add_option("--team", words->team, "team colour").one_of({"blue", "yellow"}).capture_default_str();
  add_vision_options(verb, words->vision);
  verb.add_option("--twin", words->twin.model,
                  "model of the robot, with [controller]: runs beside it, alarms where they part");
  add_twin_options(verb, words->twin);
  verb.footer(
      "Ctrl-C ends it; the recording is whole. `check FILE --explain` has the model answer the same "
      "commands, `dump FILE`\n"
      "prints the packets. Exit codes: 1 --twin raised an alarm; 2 bad\n"
      "words; 3 a device that cannot be opened, or that went away.");
  verb.callback(
      [words, &result] { result.exit_code = guarded("tap", [&] { return run_tap_verb(*words); }); });
}

}  // namespace omnihil
