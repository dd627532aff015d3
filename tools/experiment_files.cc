#include "tools/experiment_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "hil/recording/stream_file.h"
#include "identify/design/experiment_menu.h"
#include "protocols/meaning.h"

namespace omnihil {

namespace {

bool by_body(const PlannedRun& run) { return run.input == "command_vx"; }
bool by_wheel_speed(const PlannedRun& run) { return run.input == "command_wheel_1"; }

// Values held from step to step, at the packets' times; only where they change.
PlanRun plan_run(std::string name, Split use, const PlannedRun& run, double packets_Hz, double factor) {
  PlanRun out{.name = std::move(name),
              .use = use,
              .excitation = run.words,
              .duration_s = run.time_s.back(),
              .steps = {}};
  double next_s = 0.0;
  for (std::size_t k = 0; k < run.time_s.size(); ++k) {
    if (run.time_s[k] < next_s - 1e-9) continue;
    next_s += 1.0 / packets_Hz;
    PlanStep step{.at_s = run.time_s[k], .value = {}};
    for (std::size_t i = 0; i < run.duty.size(); ++i) step.value[i] = factor * run.duty[i][k];
    if (out.steps.empty() || out.steps.back().value != step.value) out.steps.push_back(step);
  }
  return out;
}

PlannedRun backwards(PlannedRun run) {
  for (auto& drive : run.duty) std::reverse(drive.begin(), drive.end());
  run.words = "half as much and backwards: " + run.words;
  return run;
}

PlanRun body_run(std::string name, Split use, std::string words, const std::vector<BodyStep>& steps,
                 double duration_s) {
  PlanRun out{.name = std::move(name),
              .use = use,
              .excitation = std::move(words),
              .duration_s = duration_s,
              .steps = {}};
  for (const BodyStep& s : steps) out.steps.push_back({s.at_s, {s.value[0], s.value[1], s.value[2], 0.0}});
  return out;
}

constexpr const char* kScanWords = "out and back in twelve directions, and turns";

// Of an axis, as a plan has it; none: no such plan.
std::optional<PlanDrive> axis_drive(const PlannedRun& run) {
  if (run.duty.size() != 1) return std::nullopt;
  for (const PlanDrive drive : {PlanDrive::kMotorVoltage, PlanDrive::kMotorTorque, PlanDrive::kDuty}) {
    if (run.input == plan_drive_word(drive)) return drive;
  }
  return std::nullopt;
}

std::vector<double> even_times(double duration_s, double rate_Hz) {
  std::vector<double> out;
  for (std::size_t k = 0; static_cast<double>(k) <= duration_s * rate_Hz + 1e-9; ++k)
    out.push_back(static_cast<double>(k) / rate_Hz);
  return out;
}

// One after another, each at its share of the level.
PlannedRun in_turn(const std::vector<std::string_view>& names, double level, double duration_s,
                   double rate_Hz, std::uint64_t seed) {
  PlannedRun run{.excitation = "usual", .words = "", .input = "", .time_s = {}, .duty = {{}}};
  const std::vector<double> part_s = even_times(duration_s / static_cast<double>(names.size()), rate_Hz);
  for (const std::string_view name : names) {
    for (const MenuRun& one : axis_menu(part_s, seed)) {
      if (one.excitation != name) continue;
      run.words += (run.words.empty() ? "" : "; ") + one.words;
      for (const double v : one.drive[0]) run.duty[0].push_back(level * v);
    }
  }
  run.time_s = even_times(duration_s, rate_Hz);
  run.duty[0].resize(run.time_s.size(), 0.0);
  return run;
}

}  // namespace

std::optional<AcquirePlan> acquire_plan_of(const ExperimentPlan& plan, const ExperimentLimits& limits,
                                           double packets_Hz, const BodyDriveOptions& other,
                                           double gear_ratio) {
  if (!plan.run) return std::nullopt;
  const PlannedRun& run = *plan.run;
  const std::optional<PlanDrive> axis = axis_drive(run);
  if (run.duty.size() < 3 && !axis) return std::nullopt;
  AcquirePlan out;
  out.title = plan.next.separates.empty()
                  ? run.excitation
                  : fmt::format("to tell {} apart", fmt::join(plan.next.separates, ", "));
  out.drive = axis                  ? *axis
              : by_body(run)        ? PlanDrive::kBodyVelocity
              : by_wheel_speed(run) ? PlanDrive::kWheelSpeed
                                    : PlanDrive::kWheelDuty;
  out.packets_Hz = packets_Hz;
  (axis ? out.limits.travel_rad : out.limits.travel_m) = limits.travel;
  if (axis) out.limits.speed_rad_s = limits.speed_rad_s / gear_ratio;
  out.limits.current_A = limits.current_A;
  out.runs.push_back(plan_run("fit", Split::kTraining, run, packets_Hz, 1.0));
  out.runs.push_back(plan_run("holdout", Split::kValidation, run, packets_Hz, -1.0));
  out.runs.push_back(by_body(run)
                         ? body_run("extrapolation", Split::kExtrapolation, kScanWords,
                                    scan_body_drive(other), other.duration_s)
                         : plan_run("extrapolation", Split::kExtrapolation, backwards(run), packets_Hz, 0.5));
  return out;
}

AcquirePlan usual_plan(const BodyDriveOptions& drive, double packets_Hz) {
  AcquirePlan plan;
  plan.title = "the usual drives";
  plan.packets_Hz = packets_Hz;
  plan.limits.travel_m = drive.room_m + 0.5;
  constexpr const char* kWords = "random levels in all directions";
  BodyDriveOptions second = drive;
  second.seed = drive.seed + 1;
  plan.runs = {
      body_run("fit", Split::kTraining, kWords, random_body_drive(drive), drive.duration_s),
      body_run("holdout", Split::kValidation, kWords, random_body_drive(second), drive.duration_s),
      body_run("extrapolation", Split::kExtrapolation, kScanWords, scan_body_drive(drive), drive.duration_s)};
  return plan;
}

AcquirePlan usual_axis_plan(PlanDrive drive, double level, const ExperimentLimits& limits, double packets_Hz,
                            std::uint64_t seed) {
  AcquirePlan plan;
  plan.title = "the usual drives of an axis";
  plan.drive = drive;
  plan.packets_Hz = packets_Hz;
  plan.limits.travel_rad = limits.travel;
  plan.limits.current_A = limits.current_A;
  plan.limits.speed_rad_s = limits.speed_rad_s;
  const double s = limits.duration_s;
  plan.runs = {
      plan_run("fit", Split::kTraining, in_turn({"steps", "ramp", "chirp"}, level, s, packets_Hz, seed),
               packets_Hz, 1.0),
      plan_run("holdout", Split::kValidation,
               in_turn({"steps", "ramp", "chirp"}, 0.8 * level, s, packets_Hz, seed + 1), packets_Hz, 1.0),
      plan_run("extrapolation", Split::kExtrapolation,
               in_turn({"reversals_slow", "triangle_fast"}, 0.6 * level, s, packets_Hz, seed), packets_Hz,
               1.0)};
  return plan;
}

std::string planned_csv(const PlannedRun& run) {
  std::string text = "time_s";
  for (std::size_t i = 0; i < run.duty.size(); ++i) {
    constexpr const char* kBody[] = {",command_vx", ",command_vy", ",command_w"};
    text += run.duty.size() == 1  ? "," + run.input
            : by_body(run)        ? kBody[i]
            : by_wheel_speed(run) ? fmt::format(",command_wheel_{}", i + 1)
                                  : fmt::format(",{}_{}", run.input, i + 1);
  }
  text += '\n';
  for (std::size_t k = 0; k < run.time_s.size(); ++k) {
    text += fmt::format("{:.6f}", run.time_s[k]);
    for (const auto& drive : run.duty) text += fmt::format(",{:.6g}", drive[k]);
    text += '\n';
  }
  return text;
}

std::string planned_stream(const PlannedRun& run, const RadioFormat& format, CommandTo robot, double rate_Hz,
                           std::string& fault) {
  HostStream stream;
  const PlanDrive drive = by_body(run)          ? PlanDrive::kBodyVelocity
                          : by_wheel_speed(run) ? PlanDrive::kWheelSpeed
                                                : PlanDrive::kWheelDuty;
  const auto frames = [&](double time_s, const std::array<double, 4>& value) {
    StreamChunk chunk{.at_ns = std::llround(time_s * 1e9), .bytes = {}};
    const RobotCommand command = plan_command(drive, value);
    robot.set_up = stream.chunks.empty();
    if (!encode_drive(format, command, robot, chunk.bytes)) {
      fault = fmt::format("{} refuses what is asked at {:.3f} s", format.id, time_s);
    }
    stream.chunks.push_back(std::move(chunk));
  };
  double next_s = 0.0;
  for (std::size_t k = 0; k < run.time_s.size() && fault.empty(); ++k) {
    if (run.time_s[k] < next_s - 1e-9) continue;
    std::array<double, 4> value{};
    for (std::size_t i = 0; i < run.duty.size(); ++i) value[i] = run.duty[i][k];
    frames(run.time_s[k], value);
    next_s += 1.0 / rate_Hz;
  }
  if (!fault.empty()) return "";
  frames(run.time_s.back() + 1.0 / rate_Hz, {0.0, 0.0, 0.0, 0.0});
  return to_text(stream, fmt::format("{}: {}; {} packets a second to robot {}", format.id, run.words, rate_Hz,
                                     robot.robot_id));
}

std::string plan_text(const ExperimentPlan& plan) {
  if (!plan.run) return plan.problem + "\n";
  std::string text = plan.next.what + "\n";
  const bool has_current = plan.largest_current_A > 0.0;  // not of a bench that is asked for a motion
  text += fmt::format("Simulated: at most {}{:.4g} at the rotor, {:.3g} from the start.\n",
                      has_current ? fmt::format("{:.3g} A, ", plan.largest_current_A) : "",
                      plan.largest_speed_rad_s, plan.largest_travel);
  constexpr std::size_t kShown = 8;
  text += "Tried, best first (in one direction, refitted to first order):\n";
  std::size_t shown = 0, refused = 0;
  for (const TriedRun& t : plan.tried) {
    if (!t.refused.empty()) {
      ++refused;
    } else if (shown++ < kShown) {
      text += fmt::format("  {:>9.3g}  {} ({})\n", t.sigmas, t.excitation, t.words);
    }
  }
  if (refused > 0) {
    text += fmt::format("Refused by the limits: {} of {}\n", refused, plan.tried.size());
    for (const TriedRun& t : plan.tried) {
      if (!t.refused.empty()) text += fmt::format("  {} ({}): {}\n", t.excitation, t.words, t.refused);
    }
  }
  return text;
}

}  // namespace omnihil
