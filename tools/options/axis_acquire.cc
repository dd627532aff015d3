#include "tools/options/axis_acquire.h"

#include <fmt/format.h>

#include <cmath>
#include <memory>

#include "hil/acquire/axis_dataset.h"
#include "hil/acquire/open_axis.h"
#include "hil/acquire/remote_axis.h"
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

struct OpenedModel {
  AxisModel model;
  std::string text;  // a file that stands alone as it is, else with its motor in one
};

OpenedModel open_model(const std::string& name) {
  const StoredModel stored = load_model(name, {data_folder("models")});
  if (stored.bundle.robot_text.empty()) throw std::invalid_argument(lines_of(stored.problems));
  AxisReading reading = read_axis_bundle(stored.bundle);
  if (!reading.model) throw std::invalid_argument(lines_of(reading.problems));
  const bool alone = stored.bundle.motor_text.empty() && reading.model->file.rig == "axis";
  std::string text = alone ? stored.bundle.robot_text : axis_model_text(*reading.model);
  return {std::move(*reading.model), std::move(text)};
}

struct OpenedEnd {
  std::unique_ptr<AxisEnd> end;
  double counts_per_turn = 0.0;
  int id = 0;
};

OpenedEnd open_bus(const AxisAcquireWords& w, const std::string& device, const AcquirePlan& plan,
                   double gear_ratio) {
  const BusAxisChoice choice{.bus = w.bus,
                             .device = device,
                             .id = w.id,
                             .at_rotor = w.shaft == "rotor",
                             .amplitudes = w.q_values == "amplitude"};
  return {open_bus_axis(choice, plan.drive, gear_ratio), 0.0, axis_id(choice)};
}

OpenedEnd open_board(const AxisAcquireWords& w, const std::string& device, double gear_ratio) {
  const int motor = std::max(0, w.id);
  if (motor >= RemoteAxis::kMotors) throw std::invalid_argument("--id: a board has motors 0 to 3");
  auto end =
      std::make_unique<RemoteAxis>(BufferedWire(open_end(device, "serial", "--device"), kQueue_bytes), motor);
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

DrivenRun drive_one(AxisAcquirer& acquirer, const AcquirePlan& plan, const PlanRun& run,
                    const std::string& started) {
  AxisRunEnd done = acquirer.run(run, [] { return StopSignals::requested(); });
  if (!done.problem.empty()) return {.problem = done.problem, .wire_lost = done.wire_lost};
  const RunRows rows = axis_rows(done.samples, plan.drive);
  return {.csv = rows_csv(rows),
          .packets = std::move(done.packets),
          .note = axis_run_note(run, done, rows, started),
          .words = fmt::format(
              "{} demands, {} samples{}", done.asked, rows.time_s.size(),
              done.left_out > 0 ? fmt::format("; {} demands left out, this computer was late", done.left_out)
                                : "")};
}

}  // namespace

int acquire_axis(const AcquireWords& words, const AxisAcquireWords& w, const AcquirePlan& plan,
                 const std::string& text) {
  if (const std::string why = axis_host_problem(w.bus, plan.drive); !why.empty())
    throw std::invalid_argument(fmt::format("--bus {}: {}", w.bus.empty() ? "\"\"" : w.bus, why));
  const OpenedModel opened = open_model(words.model);
  if (words.dry_run) {
    fmt::print("{}", axis_plan_words(plan, opened.model));
    return kExitOk;
  }
  if (words.out.empty()) throw std::invalid_argument("--out: needed, but for --dry-run");
  const double gear_ratio = opened.model.drive.gear_ratio;
  const OpenedEnd axis = w.bus == kShimBus ? open_board(w, words.device, gear_ratio)
                                           : open_bus(w, words.device, plan, gear_ratio);
  AcquireFolder folder(words.out, text, opened.text, words.resume);
  AxisAcquirer acquirer(*axis.end, plan);
  const auto one = [&](const PlanRun& run, const std::string& started) {
    return drive_one(acquirer, plan, run, started);
  };
  if (const auto ended = drive_runs(words, plan, folder, "make the axis ready", one)) return *ended;
  const AxisAbout about{.device = std::string(axis.end->name()),
                        .bus = w.bus,
                        .commit = program_commit(),
                        .plan_sha256 = sha256_of(text),
                        .model_sha256 = sha256_of(opened.text),
                        .id = axis.id,
                        .device_clock = axis.end->device_clock()};
  return finish_measurement(plan, folder, [&](const auto& runs, const auto& notes) {
    return Described{axis_dataset_text(plan, runs, axis.counts_per_turn),
                     axis_readme_text(about, plan, notes)};
  });
}

}  // namespace omnihil
