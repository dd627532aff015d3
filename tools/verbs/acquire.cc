// omnihil acquire PLAN: drives a robot by its own radio as a plan says, and writes what came of it as a measurement.
#include <fmt/format.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hil/acquire/acquire_folder.h"
#include "hil/acquire/acquire_loop.h"
#include "hil/acquire/acquire_report.h"
#include "hil/acquire/acquired_dataset.h"
#include "hil/dataset/dataset_model.h"
#include "hil/dataset/radio_export.h"
#include "hil/loop/model_store.h"
#include "hil/loop/session_checks.h"
#include "hil/serve/serve_signals.h"
#include "hil/text/program_files.h"
#include "hil/text/sha256.h"
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

struct RobotWords : AcquireWords {
  std::string plan, radio, format_file, team = "blue";
  AxisAcquireWords axis;
  VisionWords vision;
  int robot = 0;
  bool reference = false;
};

// A dataset's model: a file that stands alone as it is, else the robot's and its motor's in one.
std::string model_text(const StoredModel& stored, bool reference) {
  std::string text =
      stored.bundle.motor_text.empty() ? stored.bundle.robot_text : dataset_model_text(*stored.model);
  if (reference) text += reference_controller_text(*stored.model->robot);
  return text;
}

DrivenRun drive_one(Acquirer& acquirer, const AcquirePlan& plan, const PlanRun& run,
                    const std::string& started) {
  RunEnd end = acquirer.run(run, [] { return StopSignals::requested(); });
  if (!end.problem.empty()) return {.problem = end.problem, .wire_lost = end.wire_lost};
  const RunRows rows = run_rows(end.log, plan.drive);
  return {.csv = rows_csv(rows),
          .packets = std::move(end.packets),
          .note = run_note(run, end, rows, started),
          .words = fmt::format(
              "{} packets, {} answers, {} frames{}", end.log.sent.size(), end.log.told.size(),
              end.log.seen.size(),
              end.left_out > 0 ? fmt::format("; {} packets left out, this computer was late", end.left_out)
                               : "")};
}

int drive(const RobotWords& words, const AcquirePlan& plan, const RadioFormat& format, const CommandTo& to,
          AcquireFolder& folder, const AcquireAbout& about) {
  const std::unique_ptr<ByteWire> wire = open_end(words.device, "serial", "--device");
  std::optional<UdpPort> vision = open_vision(words.vision);
  Acquirer acquirer({.wire = *wire, .format = format, .to = to, .vision = vision ? &*vision : nullptr}, plan);
  const auto one = [&](const PlanRun& run, const std::string& started) {
    return drive_one(acquirer, plan, run, started);
  };
  if (const auto ended = drive_runs(words, plan, folder, "put the robot in its place", one)) return *ended;
  fmt::print("{}", clock_words(acquirer.cameras(), acquirer.unix_start_s()));
  return finish_measurement(plan, folder, [&](const auto& runs, const auto& notes) {
    const auto noise = steady_noise(plan, runs, wheel_speed_step_rad_s(format));
    return Described{acquired_dataset_text(plan, runs, noise, format.id), readme_text(about, plan, notes)};
  });
}

int run(const RobotWords& words) {
  std::string error;
  const std::string text = read_text_file(words.plan, error);
  if (!error.empty()) throw std::invalid_argument(words.plan + ": " + error);
  const PlanReading reading = read_acquire_plan(text, words.plan);
  if (!reading.plan) throw std::invalid_argument(lines_of(reading.problems));
  const AcquirePlan& plan = *reading.plan;
  if (of_axis(plan.drive)) return acquire_axis(words, words.axis, plan, text);
  const StoredModel stored = load_robot_model(words.model, {data_folder("models")});
  if (!stored.model) throw std::invalid_argument(lines_of(stored.problems));
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
                .plan_sha256 = sha256_of(text),
                .model_sha256 = sha256_of(model),
                .format = format,
                .robot = words.robot});
}

}  // namespace

void add_verb_acquire(Verb& program, VerbResult& result) {
  auto words = std::make_shared<RobotWords>();
  RobotWords& w = *words;
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
