// `omnihil play`: a recorded host's stream into a serial device at its own times, as the host sent it.
#include <fmt/format.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "hil/recording/stream_file.h"
#include "hil/serve/stream_player.h"
#include "hil/wire/open_wire.h"
#include "tools/command_line.h"
#include "tools/exit_codes.h"
#include "tools/guarded.h"
#include "tools/verbs/verbs.h"

namespace omnihil {
namespace {

constexpr int kWait_s = 30;

struct PlayWords {
  std::string stream;
  std::string session;
  std::string device = "./dongle";
  std::string radio;
  bool wait = false;
  PlayOptions options;
};

volatile std::sig_atomic_t g_stop = 0;
void ask_to_stop(int) { g_stop = 1; }

constexpr std::string_view kBarePath = "serial";

std::unique_ptr<ByteWire> open_device(const PlayWords& words) {
  using Clock = std::chrono::steady_clock;
  const auto deadline = Clock::now() + std::chrono::seconds(words.wait ? kWait_s : 0);
  const WireUrl url = read_wire_url(words.device, kBarePath);
  const std::vector<std::string> wrong = wire_problems(url, WireForm::kBytes);
  if (!wrong.empty()) throw std::invalid_argument(fmt::format("--device: {}", fmt::join(wrong, "\n")));
  WireProblem problem;
  for (;;) {
    if (auto wire = open_byte_wire(url, {}, problem)) return wire;
    const bool may_come = problem.code == std::errc::no_such_file_or_directory ||
                          problem.code == std::errc::io_error ||
                          problem.code == std::errc::connection_refused;
    if (!may_come || g_stop != 0 || Clock::now() >= deadline) break;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  if (!problem.code) problem.code = std::make_error_code(std::errc::io_error);
  throw std::system_error(problem.code, problem.what);
}

int run_play(PlayWords& words) {
  if (!words.radio.empty()) {
    words.options.format = find_radio_format(words.radio);
    if (words.options.format == nullptr) {
      std::string known;
      for (const RadioFormat* format : radio_formats())
        known += (known.empty() ? "" : ", ") + std::string(format->id);
      throw std::invalid_argument(fmt::format("--radio: found '{}', allowed: {}", words.radio, known));
    }
  }
  const HostStream stream = load_stream(words.stream, words.session);
  std::signal(SIGINT, ask_to_stop);
  std::signal(SIGTERM, ask_to_stop);
  const auto wire = open_device(words);
  fmt::print("playing {} writes, {} bytes, {:.2f} s{} into {}\n", stream.chunks.size(), stream.byte_count(),
             static_cast<double>(stream.duration_ns()) / 1e9 / words.options.speed,
             words.options.loop ? ", again and again," : "", words.device);
  std::fflush(stdout);
  const PlaySummary summary = play_stream(stream, *wire, words.options, g_stop);
  fmt::print("{}", summary.text());
  if (summary.error) throw std::system_error(summary.error, words.device);
  return summary.stopped && !words.options.loop ? kExitInterrupted : kExitOk;
}

}  // namespace

void add_verb_play(Verb& program, VerbResult& result) {
  auto words = std::make_shared<PlayWords>();
  PlayWords& w = *words;
  Verb verb =
      program.add_subcommand("play", "plays a recorded host's packets into a serial device, as a client");
  verb.add_option("STREAM", w.stream,
                  "text stream (TIME_S HEX), JSON stream, or a recording: its host's bytes")
      .required();
  verb.add_option("--device", w.device, "serial device to open, or a wire's URL (omnihil wires)")
      .capture_default_str();
  verb.add_option("--radio", w.radio, "decode what comes back as this radio format, and count it");
  verb.add_option("--session", w.session, "which session of a JSON stream (default: the only one)");
  verb.add_option("--speed", w.options.speed, "times as fast as recorded")
      .range(0.001, 1000.0)
      .capture_default_str();
  verb.add_option("--linger", w.options.linger_s, "listen this long after the last write, in s")
      .range(0.0, 3600.0)
      .capture_default_str();
  verb.add_flag("--loop", w.options.loop, "again from the start until Ctrl-C");
  verb.add_flag("--wait", w.wait, fmt::format("wait for the device to appear, {} s at most", kWait_s));
  verb.footer("Opens the device raw, at 115200 baud unless its URL says otherwise.");
  verb.callback([words, &result] { result.exit_code = guarded("play", [&] { return run_play(*words); }); });
}

}  // namespace omnihil
