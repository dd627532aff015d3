// omnihil acquire PLAN: drives a robot by its own radio as a plan says, and writes what came of it as a measurement.
#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hil/acquire/acquire_folder.h"
#include "hil/acquire/acquire_loop.h"
#include "hil/acquire/acquire_report.h"
#include "hil/acquire/acquired_dataset.h"
#include "hil/dataset/dataset_model.h"
#include "hil/dataset/dataset_reader.h"
#include "hil/dataset/radio_export.h"
#include "hil/loop/model_store.h"
#include "hil/loop/session_checks.h"
#include "hil/serve/serve_signals.h"
#include "hil/text/program_files.h"
#include "hil/text/text_file.h"
#include "sim/model/rolling_model.h"
#include "tools/command_line.h"
#include "tools/exit_codes.h"
#include "tools/format_argument.h"
#include "tools/guarded.h"
#include "tools/options/axis_acquire.h"
#include "tools/options/open_end.h"
#include "tools/options/vision_options.h"
#include "tools/program_commit.h"
#include "tools/verbs/verbs.h"

namespace omnihil {
namespace {

struct AcquireWords {
  std::string plan, device = "./dongle", radio, format_file, model = "omni_default", team = "blue", out;
  AxisAcquireWords axis;
  VisionWords vision;
  int robot = 0, runs = 0;
  bool reference = false, dry_run = false, resume = false, confirm = false;
};

std::string all_of(const std::vector<ModelProblem>& problems) {
  std::string text;
  for (const ModelProblem& p : problems) text += (text.empty() ? "" : "\n") + p.text();
  return text;
}

// A dataset's model: a file that stands alone as it is, else the robot's and its motor's in one.
std::string model_text(const StoredModel& stored, bool reference) {
  std::string text =
      stored.bundle.motor_text.empty() ? stored.bundle.robot_text : dataset_model_text(*stored.model);
  if (reference) text += reference_controller_text(*stored.model->robot);
  return text;
}

// Runs that are whole, in the plan's order.
std::vector<AcquiredRun> runs_there(const AcquirePlan& plan, const AcquireFolder& folder) {
  std::vector<AcquiredRun> runs;
  for (const PlanRun& run : plan.runs) {
    if (folder.has(run.name)) runs.push_back({&run, rows_from_csv(folder.csv(run.name), run.name + ".csv")});
  }
  return runs;
}

int finish(const AcquirePlan& plan, AcquireFolder& folder, const RadioFormat& format,
           const AcquireAbout& about) {
  const std::vector<AcquiredRun> runs = runs_there(plan, folder);
  std::vector<std::string> notes;
  for (const PlanRun& run : plan.runs) notes.push_back(folder.note(run.name));
  folder.describe(acquired_dataset_text(plan, runs, steady_noise(plan, runs, wheel_speed_step_rad_s(format))),
                  readme_text(about, plan, notes));
  const DatasetReading reading = read_dataset(folder.making().string(), "");
  if (!reading.dataset) {
    fmt::print(stderr, "omnihil acquire: what was measured cannot be used; it is kept in {}\n{}\n",
               folder.making().string(), all_of(reading.problems));
    return kExitDiffers;
  }
  folder.finish();
  std::size_t rows = 0;
  for (const AcquiredRun& run : runs) rows += run.rows.time_s.size();
  fmt::print("{}: {} runs, {} rows\n", folder.path().string(), runs.size(), rows);
  return kExitOk;
}

// Exit code of a run that was stopped.
int stopped(const PlanRun& run, const RunEnd& end, const AcquireFolder& folder) {
  fmt::print(stderr, "omnihil acquire: {}: stopped: {}\n", run.name, end.problem);
  fmt::print(stderr, "what is whole is in {}; --resume goes on\n", folder.making().string());
  if (end.wire_lost) return kExitIo;
  return StopSignals::requested() ? kExitInterrupted : kExitDiffers;
}

int drive(const AcquireWords& words, const AcquirePlan& plan, const RadioFormat& format, const CommandTo& to,
          AcquireFolder& folder, const AcquireAbout& about) {
  const std::unique_ptr<ByteWire> wire = open_end(words.device, "serial", "--device");
  std::optional<UdpPort> vision = open_vision(words.vision);
  const StopSignals signals;
  Acquirer acquirer({.wire = *wire, .format = format, .to = to, .vision = vision ? &*vision : nullptr}, plan);
  int driven = 0;
  for (const PlanRun& run : plan.runs) {
    if (folder.has(run.name)) continue;
    if (words.runs > 0 && driven == words.runs) {
      fmt::print("{} runs driven; --resume goes on with {}\n", driven, run.name);
      return kExitOk;
    }
    if (words.confirm && !confirm_run(run, "put the robot in its place")) return kExitInterrupted;
    const std::string started = utc_now();
    const RunEnd end = acquirer.run(run, [] { return StopSignals::requested(); });
    if (!end.problem.empty()) return stopped(run, end, folder);
    const RunRows rows = run_rows(end.log, plan.drive);
    folder.add_run(run.name, rows_csv(rows), end.packets, run_note(run, end, rows, started));
    ++driven;
    fmt::print(
        "{}: {} packets, {} answers, {} frames{}\n", run.name, end.log.sent.size(), end.log.told.size(),
        end.log.seen.size(),
        end.left_out > 0 ? fmt::format("; {} packets left out, this computer was late", end.left_out) : "");
    std::fflush(stdout);
  }
  fmt::print("{}", clock_words(acquirer.cameras(), acquirer.unix_start_s()));
  return finish(plan, folder, format, about);
}

int run_axis_plan(const AcquireWords& words, const AcquirePlan& plan, const std::string& text) {
  AxisAcquireWords axis = words.axis;
  axis.device = words.device;
  axis.model = words.model;
  axis.out = words.out;
  axis.runs = words.runs;
  axis.dry_run = words.dry_run, axis.resume = words.resume, axis.confirm = words.confirm;
  return acquire_axis(axis, plan, text);
}

int run(const AcquireWords& words) {
  std::string error;
  const std::string text = read_text_file(words.plan, error);
  if (!error.empty()) throw std::invalid_argument(words.plan + ": " + error);
  const PlanReading reading = read_acquire_plan(text, words.plan);
  if (!reading.plan) throw std::invalid_argument(all_of(reading.problems));
  const AcquirePlan& plan = *reading.plan;
  if (of_axis(plan.drive)) return run_axis_plan(words, plan, text);
  const StoredModel stored = load_robot_model(words.model, {data_folder("models")});
  if (!stored.model) throw std::invalid_argument(all_of(stored.problems));
  const RadioFormat* format = format_or_complain(
      !words.radio.empty() || !words.format_file.empty() ? words.radio : stored.model->radio,
      words.format_file);
  if (format == nullptr) return kExitBadInput;
  const CommandTo to{.robot_id = words.robot, .team = words.team == "blue" ? Team::kBlue : Team::kYellow};
  throw_problems(plan_problems(plan, *format, to));
  const RollingParams<double> robot = rolling_params(stored.model->parameters);
  if (words.dry_run) {
    fmt::print("{}", plan_words(plan, robot, *format, !words.vision.group.empty()));
    return kExitOk;
  }
  if (words.out.empty()) throw std::invalid_argument("--out: needed, but for --dry-run");
  if (plan.drive != PlanDrive::kWheelDuty && !robot.has_controller && !words.reference)
    throw std::invalid_argument(words.model +
                                ": has no [controller], which says what the firmware makes of commands "
                                "(docs/radio-driven.md); --reference-firmware: that of the bench's own");
  const std::string model = model_text(stored, words.reference);
  AcquireFolder folder(words.out, text, model, words.resume);
  return drive(words, plan, *format, to, folder,
               {.device = words.device,
                .team = words.team,
                .commit = program_commit(),
                .plan_sha256 = text_hash(text),
                .model_sha256 = text_hash(model),
                .format = format,
                .robot = words.robot});
}

}  // namespace

void add_verb_acquire(Verb& program, VerbResult& result) {
  auto words = std::make_shared<AcquireWords>();
  AcquireWords& w = *words;
  Verb verb = program.add_subcommand("acquire",
                                     "drives a robot by its own radio, or one axis by its motor bus, as a "
                                     "plan says; what came of it is a measurement");
  verb.add_option("PLAN", w.plan, "what `experiment --write` wrote (docs/acquire.md)").required();
  verb.add_option("--device", w.device, "the dongle: a serial device, or a wire by URL")
      .capture_default_str();
  verb.add_option("--radio", w.radio, "radio format (default: the robot model's own)");
  verb.add_option("--format", w.format_file, "radio format from this file");
  verb.add_option("--robot", w.robot, "that is driven").range(0, 15).capture_default_str();
  verb.add_option("--team", w.team, "team colour").one_of({"blue", "yellow"}).capture_default_str();
  verb.add_option("--model", w.model, "robot model that goes with the data: a name or a .toml file")
      .capture_default_str();
  verb.add_flag("--reference-firmware", w.reference,
                "the robot runs the bench's own firmware: its [controller] is written into the model");
  add_vision_options(verb, w.vision);
  verb.add_option("--bus", w.axis.bus,
                  "of one axis: its motor bus (odrive, moteus), or shim: a board with remote_plant.h");
  verb.add_option("--id", w.axis.id,
                  "of one axis: its node on the bus, its motor on the board (default: the first)")
      .range(0, 126);
  verb.add_option("--shaft", w.axis.shaft, "of one axis: what a turn on the bus is a turn of")
      .one_of({"rotor", "output"})
      .capture_default_str();
  verb.add_option("--q-values", w.axis.q_values,
                  "of one axis: currents and voltages on the bus are amplitudes of a phase, or as data "
                  "sheets have them")
      .one_of({"amplitude", "dc"})
      .capture_default_str();
  verb.add_option("--out", w.out, "new folder of the measurement; OUT.part while it grows");
  verb.add_flag("--dry-run", w.dry_run, "say what would happen and how much floor it takes; nothing is sent");
  verb.add_option("--runs", w.runs, "this many runs, then end; --resume goes on").not_negative();
  verb.add_flag("--resume", w.resume, "go on with the runs that OUT.part does not have yet");
  verb.add_flag("--confirm", w.confirm, "before each run wait for Enter");
  verb.footer(
      "The robot is asked to stand before and behind each run, and whenever a limit of the plan is passed, "
      "on Ctrl-C, SIGTERM and "
      "any fault.\n"
      "Exit codes: 1 stopped by a limit, or data that cannot be used; 2 bad words or plan; 3 the device went "
      "away; 130 "
      "interrupted.");
  verb.callback([words, &result] { result.exit_code = guarded("acquire", [&] { return run(*words); }); });
}

}  // namespace omnihil
