#include "tools/options/axis_acquire.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <iostream>
#include <memory>
#include <optional>

#include "hil/acquire/acquire_folder.h"
#include "hil/acquire/acquire_report.h"
#include "hil/acquire/axis_dataset.h"
#include "hil/acquire/open_axis.h"
#include "hil/acquire/remote_axis.h"
#include "hil/dataset/dataset_reader.h"
#include "hil/loop/model_store.h"
#include "hil/serve/serve_signals.h"
#include "hil/text/program_files.h"
#include "hil/text/sha256.h"
#include "sim/bench/axis_dataset.h"
#include "tools/exit_codes.h"
#include "tools/options/open_end.h"
#include "tools/program_commit.h"

namespace omnihil {
namespace {

constexpr std::size_t kQueue_bytes = 4096;

std::string all_of(const std::vector<ModelProblem>& problems) {
  std::string text;
  for (const ModelProblem& p : problems) text += (text.empty() ? "" : "\n") + p.text();
  return text;
}

struct OpenedModel {
  AxisModel model;
  std::string text;  // a file that stands alone as it is, else with its motor in one
};

OpenedModel open_model(const std::string& name) {
  const StoredModel stored = load_model(name, {data_folder("models")});
  if (stored.bundle.robot_text.empty()) throw std::invalid_argument(all_of(stored.problems));
  AxisReading reading =
      read_axis_model(stored.bundle.robot_text, stored.bundle.robot_file, [&](const std::string&) {
        return MotorFileText{
            .shown_name = stored.bundle.motor_file, .text = stored.bundle.motor_text, .error = ""};
      });
  if (!reading.model) throw std::invalid_argument(all_of(reading.problems));
  const bool alone = stored.bundle.motor_text.empty() && reading.model->file.rig == "axis";
  std::string text = alone ? stored.bundle.robot_text : axis_model_text(*reading.model);
  return {std::move(*reading.model), std::move(text)};
}

struct OpenedEnd {
  std::unique_ptr<AxisEnd> end;
  double counts_per_turn = 0.0;
  int id = 0;
};

OpenedEnd open_bus(const AxisAcquireWords& w, const AcquirePlan& plan, double gear_ratio) {
  const BusAxisChoice choice{.bus = w.bus,
                             .device = w.device,
                             .id = w.id,
                             .at_rotor = w.shaft == "rotor",
                             .amplitudes = w.q_values == "amplitude"};
  return {open_bus_axis(choice, plan.drive, gear_ratio), 0.0, axis_id(choice)};
}

OpenedEnd open_board(const AxisAcquireWords& w, double gear_ratio) {
  const int motor = std::max(0, w.id);
  if (motor >= RemoteAxis::kMotors) throw std::invalid_argument("--id: a board has motors 0 to 3");
  auto end = std::make_unique<RemoteAxis>(
      BufferedWire(open_end(w.device, "serial", "--device"), kQueue_bytes), motor);
  std::string problem;
  if (!end->greet(problem)) throw std::invalid_argument("--device: " + problem);
  const double told = end->robot().gear_ratio;
  if (!(std::abs(told - gear_ratio) <= 1e-6 * gear_ratio))
    throw std::invalid_argument(
        fmt::format("--model: a gear ratio of {:g}, where the board says {:g}", gear_ratio, told));
  if (!(end->counts_per_turn() > 0.0))
    throw std::invalid_argument("--device: the board says no encoder counts per turn");
  const double counts = end->counts_per_turn();
  return {std::move(end), counts, motor};
}

int finish(const AcquirePlan& plan, AcquireFolder& folder, double counts_per_turn, const AxisAbout& about) {
  std::vector<AcquiredRun> runs;
  std::vector<std::string> notes;
  std::size_t rows = 0;
  for (const PlanRun& run : plan.runs) {
    runs.push_back({&run, rows_from_csv(folder.csv(run.name), run.name + ".csv")});
    notes.push_back(folder.note(run.name));
    rows += runs.back().rows.time_s.size();
  }
  folder.describe(axis_dataset_text(plan, runs, counts_per_turn), axis_readme_text(about, plan, notes));
  const DatasetReading reading = read_dataset(folder.making().string(), "");
  if (!reading.dataset) {
    fmt::print(stderr, "omnihil acquire: what was measured cannot be used; it is kept in {}\n{}\n",
               folder.making().string(), all_of(reading.problems));
    return kExitDiffers;
  }
  folder.finish();
  fmt::print("{}: {} runs, {} rows\n", folder.path().string(), runs.size(), rows);
  return kExitOk;
}

// Exit code where it ended before the last run; none: all are there.
std::optional<int> drive(const AxisAcquireWords& w, const AcquirePlan& plan, AxisEnd& end,
                         AcquireFolder& folder) {
  const StopSignals signals;
  AxisAcquirer acquirer(end, plan);
  int driven = 0;
  for (const PlanRun& run : plan.runs) {
    if (folder.has(run.name)) continue;
    if (w.runs > 0 && driven == w.runs) {
      fmt::print("{} runs driven; --resume goes on with {}\n", driven, run.name);
      return kExitOk;
    }
    if (w.confirm && !confirm_run(run, "make the axis ready")) return kExitInterrupted;
    const std::string started = utc_now();
    const AxisRunEnd done = acquirer.run(run, [] { return StopSignals::requested(); });
    if (!done.problem.empty()) {
      fmt::print(stderr, "omnihil acquire: {}: stopped: {}\nwhat is whole is in {}; --resume goes on\n",
                 run.name, done.problem, folder.making().string());
      return done.wire_lost ? kExitIo : StopSignals::requested() ? kExitInterrupted : kExitDiffers;
    }
    const RunRows rows = axis_rows(done.samples, plan.drive);
    folder.add_run(run.name, rows_csv(rows), done.packets, axis_run_note(run, done, rows, started));
    ++driven;
    fmt::print(
        "{}: {} demands, {} samples{}\n", run.name, done.asked, rows.time_s.size(),
        done.left_out > 0 ? fmt::format("; {} demands left out, this computer was late", done.left_out) : "");
    std::fflush(stdout);
  }
  return std::nullopt;
}

}  // namespace

bool confirm_run(const PlanRun& run, const char* what) {
  fmt::print("{} ({:.1f} s): {} and press Enter ", run.name, run.duration_s, what);
  std::fflush(stdout);
  std::string line;
  return static_cast<bool>(std::getline(std::cin, line));
}

std::string text_hash(std::string_view text) {
  Sha256 hash;
  hash.add(text);
  return hash.hex();
}

int acquire_axis(const AxisAcquireWords& w, const AcquirePlan& plan, const std::string& text) {
  if (const std::string why = axis_host_problem(w.bus, plan.drive); !why.empty())
    throw std::invalid_argument(fmt::format("--bus {}: {}", w.bus.empty() ? "\"\"" : w.bus, why));
  const OpenedModel opened = open_model(w.model);
  if (w.dry_run) {
    fmt::print("{}", axis_plan_words(plan, opened.model));
    return kExitOk;
  }
  if (w.out.empty()) throw std::invalid_argument("--out: needed, but for --dry-run");
  const double gear_ratio = opened.model.drive.gear_ratio;
  const OpenedEnd axis = w.bus == kShimBus ? open_board(w, gear_ratio) : open_bus(w, plan, gear_ratio);
  AcquireFolder folder(w.out, text, opened.text, w.resume);
  if (const std::optional<int> ended = drive(w, plan, *axis.end, folder)) return *ended;
  return finish(plan, folder, axis.counts_per_turn,
                {.device = std::string(axis.end->name()),
                 .bus = w.bus,
                 .commit = program_commit(),
                 .plan_sha256 = text_hash(text),
                 .model_sha256 = text_hash(opened.text),
                 .id = axis.id,
                 .device_clock = axis.end->device_clock()});
}

}  // namespace omnihil
