
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sim/bench/axis_dataset.h"
#include "sim/bench/axis_signal.h"
#include "sim/law/effect_registry.h"
#include "sim/law/random.h"
#include "tools/benches/virtual_bench.h"

namespace omnihil {
namespace {

std::optional<CommandKind> kind_of(const BenchOptions& options, const AxisModel& model,
                                   std::vector<std::string>& faults) {
  constexpr CommandKind kKinds[] = {CommandKind::kDuty, CommandKind::kMotorVoltage,
                                    CommandKind::kMotorCurrent, CommandKind::kMotorTorque,
                                    CommandKind::kPositionTarget};
  if (options.drive.empty()) {
    return model.has_servo ? CommandKind::kPositionTarget
                           : (model.has_electrics ? CommandKind::kDuty : CommandKind::kMotorTorque);
  }
  for (const CommandKind kind : kKinds) {
    if (command_name(kind) != options.drive) continue;
    if (kind == CommandKind::kPositionTarget && !model.has_servo) {
      faults.push_back("--drive position_target: the model has no [servo] kp_duty_per_rad");
    } else if (kind != CommandKind::kMotorTorque && !model.has_electrics) {
      faults.push_back(
          fmt::format("--drive {}: the model has no resistance and torque constant; allowed: motor_torque",
                      options.drive));
    }
    return kind;
  }
  faults.push_back(
      fmt::format("--drive {}: allowed are duty, motor_voltage, motor_current, motor_torque, position_target",
                  options.drive));
  return std::nullopt;
}

// Time of the first sample that is not finite, or nothing.
std::string divergence(const AxisBenchRun& run) {
  for (const AxisSample<double>& s : run.samples) {
    if (std::isfinite(s.omega_rotor_rad_s) && std::isfinite(s.theta_rotor_rad) &&
        std::isfinite(s.motor_current_A))
      continue;
    return fmt::format("run {}: the state is not finite at {:.6f} s (speed {:g} rad/s, current {:g} A)",
                       run.name, s.time_s, s.omega_rotor_rad_s, s.motor_current_A);
  }
  return "";
}

}  // namespace

std::optional<VirtualBench> make_axis_bench(const BenchOptions& options, std::vector<std::string>& faults) {
  const std::optional<BenchAxis> opened = open_axis(options, faults);
  if (!opened) return std::nullopt;
  const auto& [model, effects] = *opened;
  const std::optional<CommandKind> kind = kind_of(options, model, faults);
  if (!faults.empty()) return std::nullopt;
  const auto excited = [&](Excitation e, double scale, std::uint64_t seed) {
    return bench_rows(options, [&](double t) {
      const double pattern = excitation_at(e, t, {.duration_s = options.duration_s, .seed = seed});
      return std::vector<double>{options.amplitude * scale * pattern};
    });
  };
  const auto runs = bench_runs(options, faults, excited, [&](const std::string& path) {
    constexpr std::size_t kOne[] = {1};
    return read_bench_rows(path, kOne, "what is asked", faults);
  });
  if (!faults.empty()) return std::nullopt;
  AxisBench bench{
      .title = "simulated: " + options.model, .model = model, .runs = {}, .noise_scale = options.noise_scale};
  bench.has_temperature = std::any_of(effects.begin(), effects.end(), [](const EffectUse& u) {
    const EffectEntry* read = find_effect(u.entry->info->needs);
    return ((u.entry->info->claims | (read != nullptr ? read->info->claims : 0u)) & kWarmsWinding) != 0;
  });
  const EffectSet<double> set(effects);
  VirtualBench out;
  std::uint64_t seed = options.seed;
  for (const BenchRun& planned : runs) {
    AxisBenchRun& run = bench.runs.emplace_back();
    run.name = planned.name;
    run.use = planned.use;
    run.excitation = planned.excitation;
    for (const BenchRow& row : planned.input) {
      run.input.time_s.push_back(row.time_s);
      run.input.command.push_back(row.values[0]);
    }
    run.seed = mix_bits(seed++);
    run.input.kind = *kind;
    if (*kind != CommandKind::kPositionTarget) run.input.command_before = 0.0;  // it begins at rest
    run.input.encoder_counts_per_turn = model.encoder_counts_per_turn;
    run.input.noise_seed = run.seed;
    run.samples = run_axis(model.drive, set, run.input, {.step_s = options.step_s});
    if (out.diverged.empty()) out.diverged = divergence(run);
    out.rows += run.samples.size();
  }
  out.runs = bench.runs.size();
  out.files = {{"dataset.toml", dataset_text(bench)}, {"model.toml", axis_model_text(bench.model)}};
  for (const AxisBenchRun& run : bench.runs) out.files.push_back({run.name + ".csv", run_csv(bench, run)});
  return out;
}

}  // namespace omnihil
