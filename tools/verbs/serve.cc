// `omnihil serve`: robots behind a virtual radio dongle. Options here, the work in hil/serve/serve.h.
#include "hil/serve/serve.h"

#include <chrono>
#include <cstdio>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "hil/firmware/bus_firmware.h"
#include "hil/loop/effect_overrides.h"
#include "hil/loop/model_store.h"
#include "hil/loop/thread_pool.h"
#include "hil/radio_file/radio_file.h"
#include "hil/recording/recording_header.h"
#include "hil/recording/session_setup.h"
#include "hil/serve/serve_load.h"
#include "hil/serve/serve_signals.h"
#include "hil/text/program_files.h"
#include "hil/wire/open_wire.h"
#include "protocols/radio_format.h"
#include "tools/command_line.h"
#include "tools/exit_codes.h"
#include "tools/options/air_options.h"
#include "tools/options/bench_text.h"
#include "tools/options/console_options.h"
#include "tools/options/field_options.h"
#include "tools/options/firmware_options.h"
#include "tools/options/gdb_options.h"
#include "tools/options/league_options.h"
#include "tools/options/observe_options.h"
#include "tools/options/variable_options.h"
#include "tools/program_commit.h"
#include "tools/verbs/verbs.h"

namespace omnihil {
namespace {

constexpr const char* kDefaultRadio = "ulaval-hermes";

struct Words {  // as the user gave them
  std::string robot = "omni_default";
  bool print_bench = false;
  std::string bench_text;  // of all options
  std::string bench;       // expanded before the command line is read (bench_expansion.h)
  std::string radio;
  std::string format_file;
  std::string robots = "0-5";
  std::string team = "blue";
  std::string physics = "simbody";
  std::string clock = "real";
  double duration_s = 0.0;
  double step_ms = 1.0;
  double spin_us = 0.0;
  bool no_pacing = false;
  std::int64_t baud = 0;
  int sample_every = 10;
  int threads = 0;
  std::vector<std::string> with;
  SessionSetup setup;
  ServeOptions options;
  TeamFirmwareWords firmware;
  GdbWords gdb;
  ObserveWords observe;
  std::string console;
  MotorBusChoice motor_bus;
  LeagueWords league;
  AirWords air;
  FieldWords field;
};

void complain(const std::string& lines) { std::fprintf(stderr, "omnihil serve:\n%s\n", lines.c_str()); }

// All problems of the words at once, a line each; empty when `words.setup` can be used.
std::string understand(Words& words) {
  std::vector<std::string> problems;
  SessionSetup& setup = words.setup;
  const StoredModel stored = load_robot_model(words.robot, {data_folder("models")});
  for (const ModelProblem& problem : stored.problems) problems.push_back(problem.text());
  setup.model = stored.bundle;
  if (stored.problems.empty()) add_effects(setup.model, words.with, problems);
  setup.radio_format = words.radio;
  if (!words.format_file.empty()) {
    if (!words.radio.empty()) problems.push_back("--radio and --format: a bench has one radio format");
    const RadioFile file = load_radio_file(words.format_file);
    for (const ModelProblem& problem : file.problems) problems.push_back(problem.text());
    if (file.format != nullptr) use_radio_format(*file.format);
    if (file.format != nullptr) setup.radio_format = file.format->id;
  }
  if (setup.radio_format.empty() && stored.model) setup.radio_format = stored.model->radio;
  if (setup.radio_format.empty()) setup.radio_format = kDefaultRadio;
  for (const std::string& problem :
       wire_problems(read_wire_url(words.options.device, kServeDevice), WireForm::kBytes)) {
    problems.push_back("--device: " + problem);
  }
  setup.robot_ids = parse_robot_list(words.robots, problems);
  setup.team = words.team == "blue" ? Team::kBlue : Team::kYellow;
  setup.plant.physics = *parse_physics(words.physics);
  setup.step_ns = static_cast<std::int64_t>(words.step_ms * 1e6 + 0.5);
  words.options.real_time = words.clock == "real";
  words.options.duration_ns = static_cast<std::int64_t>(words.duration_s * 1e9 + 0.5);
  words.options.pacing = !words.no_pacing;
  if (words.baud > 0) words.options.baud = words.baud;
  words.options.spin_ns = static_cast<std::int64_t>(words.spin_us * 1e3 + 0.5);
  if (words.options.spin_ns > 0 && !words.options.real_time)
    problems.push_back("--spin: of no meaning with --clock free");
  if (words.options.strict && !words.options.real_time) {
    problems.push_back("--strict: of no meaning with --clock free");
  }
  if (words.motor_bus.bus.empty() != words.motor_bus.port.empty()) {
    problems.push_back("--motor-bus and --bus-port belong together");
  }
  if (!words.motor_bus.bus.empty() && words.firmware.names_any()) {
    problems.push_back("--motor-bus and --firmware: a robot has one or the other");
  }
  words.options.firmware_file = words.firmware.all.file;
  const bool variables = !words.options.watch.empty() || !words.options.set.empty();
  if (variables && (!words.firmware.of.empty() || !words.firmware.opponents.empty())) {
    problems.push_back("--watch, --set: all robots have to run one firmware (--firmware)");
  }
  understand_air(words.air, setup.air, problems);
  understand_field(words.field, words.with, setup, problems);
  if (!words.options.opponents_device.empty()) {
    if (setup.opponent_ids.empty()) problems.push_back("--opponents-device: needs --opponents");
    setup.opponents_radio =
        words.field.opponents_radio.empty() ? setup.radio_format : words.field.opponents_radio;
    for (const std::string& problem :
         wire_problems(read_wire_url(words.options.opponents_device, kServeDevice), WireForm::kBytes))
      problems.push_back("--opponents-device: " + problem);
  }
  if (words.options.opponents_device.empty() && !words.field.opponents_radio.empty())
    problems.push_back("--opponents-radio: needs --opponents-device");
  words.options.starts = start_poses(words.field, setup, problems);
  if (setup.field.size != nullptr) words.league.options.vision.field = *setup.field.size;
  words.options.league = league_options(words.league, setup.plant.seed, setup.epoch_ms, problems);
  // Clients hold a frame's times against their own clock.
  if (words.options.league && words.options.real_time && setup.epoch_ms == SessionSetup{}.epoch_ms) {
    const auto now = std::chrono::system_clock::now().time_since_epoch();
    words.options.league->vision.epoch_ms =
        static_cast<std::uint64_t>(std::chrono::duration_cast<std::chrono::milliseconds>(now).count());
  }
  words.options.league_sync_port = words.league.sync_port;
  if (words.no_pacing && words.baud > 0) problems.push_back("--no-pacing and --baud contradict each other");
  if (!words.options.quiet) {
    for (const std::string& note : stored.notes) std::fprintf(stderr, "note: %s\n", note.c_str());
  }
  if (stored.problems.empty()) {
    SessionSetup rest = setup;  // a list of robots that was not understood has been named already
    if (!problems.empty()) {
      rest.robot_ids = {0};
      rest.others.clear();
    }
    try {
      session_config(rest);
    } catch (const std::invalid_argument& error) {
      problems.push_back(error.what());
    }
  }
  std::string text;
  for (const std::string& problem : problems) text += (text.empty() ? "" : "\n") + problem;
  return text;
}

int run(Words& words) {
  if (words.print_bench) {
    std::fputs(words.bench_text.c_str(), stdout);
    return kExitOk;
  }
  const std::string problems = understand(words);
  if (!problems.empty()) {
    complain(problems);
    return kExitBadInput;
  }
  try {
    RecordingHeader header = recording_header(words.setup, program_commit());
    header.sample_every = words.sample_every;
    if (!words.bench.empty()) header.bench = words.bench_text;
    SessionConfig config = session_config(words.setup);
    config.threads = words.threads > 0 ? words.threads : host_cores();
    words.firmware.all.virtual_time = !words.options.real_time;
    const std::unique_ptr<GdbServer> gdb = open_gdb(words.gdb, [] { return StopSignals::requested(); });
    words.options.gdb = gdb.get();
    words.firmware.all.listeners.on_line =
        [print = console_listener(words.console), record = words.options.record_console](
            std::uint32_t robot, int board, const std::string& port, const std::string& line) {
          if (print) print(robot, board, port, line);
          if (*record) (*record)(robot, board, port, line);
        };
    words.firmware.all.listeners.typed = console_input(words.console);
    words.firmware.all.listeners.on_board = gdb_listener(gdb.get());
    ImageReports reports(words.observe, words.firmware.all.file);
    words.firmware.all.observer = reports.observer();
    const TeamFirmware makers = words.motor_bus.bus.empty()
                                    ? open_team_firmware(words.firmware, config)
                                    : TeamFirmware{bus_firmware(words.motor_bus, config), {}};
    if (words.motor_bus.bus.empty()) {
      header.firmware_files = team_firmware_files(words.firmware);
    } else {
      header.firmware_files = {{words.motor_bus.bus + " on " + words.motor_bus.port, ""}};
    }
    if (words.options.real_time && !words.options.quiet) {
      const TeamFirmware measured =
          words.motor_bus.bus.empty() ? open_team_firmware_for_load(words.firmware, config) : TeamFirmware{};
      words.options.load = load_words(measured_load(config, {measured.first, measured.opponents}));
    }
    const ServeEnd end = serve(config, makers.first, std::move(header), words.options, makers.opponents);
    const std::string said = reports.write_trace("", true);
    if (!words.options.quiet) std::fputs(said.c_str(), stdout);
    switch (end) {
      case ServeEnd::kDone:
        return kExitOk;
      case ServeEnd::kIo:
        return kExitIo;
      case ServeEnd::kDiverged:
        return kExitDiverged;
      case ServeEnd::kLate:
        return kExitLate;
      case ServeEnd::kFirmware:
        return kExitFirmware;
    }
  } catch (const std::invalid_argument& error) {
    complain(error.what());
    return kExitBadInput;
  } catch (const GdbUnreachable& error) {
    complain(error.what());
    return kExitIo;
  }
  return kExitDiverged;
}

void add_bus_options(Verb& verb, MotorBusChoice& choice) {
  verb.add_option("--motor-bus", choice.bus,
                  "no firmware: the robot is its motor controllers on a bus, odrive for one "
                  "(docs/motor-buses.md)");
  verb.add_option(
      "--bus-port", choice.port,
      "the bus's wire (omnihil wires): can:vcan0, slcan:./can, pty:./motor{motor} (a wire per motor); "
      "{id} is the robot's number");
  verb.add_option("--bus-shaft", choice.shaft, "a turn on the bus is one of the rotor or the wheel")
      .capture_default_str();
  verb.add_option("--bus-order", choice.order, "wheel of the model that is motor 0, 1, 2, 3 of the bus")
      .capture_default_str();
  verb.add_option("--bus-first-id", choice.first_id, "node id of motor 0 (default: the bus's own)")
      .not_negative();
  verb.add_option("--bus-watchdog", choice.watchdog_ms,
                  "ms without a command after which a motor stops; 0: never (default: the device's own)")
      .not_negative();
}

}  // namespace

void add_verb_serve(Verb& program, VerbResult& result) {
  auto words = std::make_shared<Words>();
  Verb verb = program.add_subcommand(
      "serve", "robots behind a virtual radio dongle that an AI host opens as a serial port");
  Words& w = *words;
  verb.add_option("--bench", w.bench,
                  "a file that says what these options say (docs/bench.md); what is given here wins");
  verb.add_flag("--print-bench", w.print_bench,
                "print all options with their values as such a file, and end");
  verb.add_option("--robot", w.robot, "robot model: a name or a .toml file").capture_default_str();
  verb.add_option("--with", w.with,
                  "add an effect to every robot: ID.parameter=value, or ID for its typical size; several "
                  "allowed");
  verb.add_option("--radio", w.radio, "radio format (default: the robot model's own, else ulaval-hermes)");
  verb.add_option("--format", w.format_file, "radio format from this file (docs/radio/own-format.md)");
  verb.add_option("--device", w.options.device,
                  "name of the serial device to make, or a wire's URL (omnihil wires)")
      .capture_default_str();
  verb.add_option("--robots", w.robots, "robot ids: 0-5 or 0,2,7").capture_default_str();
  verb.add_option("--team", w.team, "team colour").one_of({"blue", "yellow"}).capture_default_str();
  add_team_firmware_options(verb, w.firmware);
  add_gdb_options(verb, w.gdb);
  add_console_option(verb, w.console);
  add_trace_options(verb, w.observe, "the run ends");
  add_bus_options(verb, w.motor_bus);
  add_variable_options(verb, w.options.watch, w.options.set);
  add_field_options(verb, w.field);
  verb.add_option(
      "--opponents-device", w.options.opponents_device,
      "the other team's own dongle, as --device (default: none, their commands come by the league's ports)");
  add_league_options(verb, w.league);
  add_air_options(verb, w.air);
  verb.add_option("--record", w.options.record, "write a recording to this file");
  verb.add_option(
      "--capture", w.options.capture,
      "Unix socket that gives passing packets as pcap; `omnihil extcap` brings them into Wireshark");
  verb.add_option("--sample-every", w.sample_every,
                  "of each robot's control ticks, record every Nth (bytes are all recorded)")
      .range(1, 1'000'000)
      .capture_default_str();
  verb.add_option("--seed", w.setup.plant.seed, "seed of everything random").capture_default_str();
  verb.add_option("--physics", w.physics,
                  "simbody, planar (closed form, fast) or simbody-free (pitch, roll, lift)")
      .one_of({"simbody", "planar", "simbody-free"})
      .capture_default_str();
  verb.add_option("--threads", w.threads,
                  "threads that emulated boards are spread over (default: as many as there are cores); no "
                  "result depends on it")
      .range(1, 256);
  verb.add_option("--clock", w.clock, "real: real time; free: virtual time as fast as it goes")
      .one_of({"real", "free"})
      .capture_default_str();
  verb.add_option("--duration", w.duration_s, "end after this much simulated time, in s (default: never)")
      .not_negative();
  verb.add_option("--step", w.step_ms, "loop step in ms").range(0.05, 100.0).capture_default_str();
  verb.add_option("--epoch-ms", w.setup.epoch_ms,
                  "Unix time in ms at simulated time 0, for packets that carry one")
      .capture_default_str();
  verb.add_flag("--no-pacing", w.no_pacing, "do not hold bytes to the carrier's rate");
  verb.add_option("--baud", w.baud, "hold bytes to this rate (8N1) instead of the carrier's")
      .range(std::int64_t{50}, std::int64_t{100'000'000});
  verb.add_flag("--strict", w.options.strict,
                "end with exit code 5 when this computer cannot keep up with real time");
  verb.add_flag("--fifo", w.options.fifo, "real-time scheduling (SCHED_FIFO) and locked memory");
  verb.add_option("--spin", w.spin_us,
                  "microseconds before each step is due in which the loop waits awake: less late, for that "
                  "share of a core")
      .range(0.0, 1000.0)
      .capture_default_str();
  verb.add_flag("--quiet", w.options.quiet, "only the ready line and errors");
  verb.callback([words, verb, &result] {
    words->bench_text = bench_text(verb.settings());
    result.exit_code = run(*words);
  });
}

}  // namespace omnihil
