#include "tools/axis_bench.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "hil/loop/model_store.h"
#include "hil/text/program_files.h"
#include "sim/bench/axis_signal.h"
#include "sim/bench/excitation.h"
#include "sim/law/effect_registry.h"
#include "sim/law/random.h"
#include "sim/model/effect_reader.h"

namespace omnihil {
namespace {

constexpr double kHoldoutRatio = 1.0 / 3.0;  // of a file's time, at its end
constexpr double kHoldoutAmplitude = 0.8;    // of the fit run's

std::optional<AxisModel> open_model(const std::string& name, std::vector<std::string>& faults) {
  const StoredModel stored = load_model(name, {data_folder("models")});
  if (stored.bundle.robot_text.empty()) {
    for (const ModelProblem& p : stored.problems) faults.push_back(p.text());
    return std::nullopt;
  }
  const auto motor = [&](const std::string&) {
    return MotorFileText{
        .shown_name = stored.bundle.motor_file, .text = stored.bundle.motor_text, .error = ""};
  };
  AxisReading reading = read_axis_model(stored.bundle.robot_text, stored.bundle.robot_file, motor);
  for (const ModelProblem& p : reading.problems) faults.push_back(p.text());
  return std::move(reading.model);
}

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

bool number_in(std::string_view text, double& value) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\r')) text.remove_suffix(1);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size();
}

// "time_s,command" rows; the first line may be a header.
AxisInput read_file(const std::string& path, std::vector<std::string>& faults) {
  AxisInput in;
  std::ifstream file(path);
  if (!file) faults.push_back(fmt::format("--excite {}: cannot be read", path));
  std::string line;
  for (int number = 1; std::getline(file, line); ++number) {
    const std::size_t comma = line.find(',');
    double time = 0, command = 0;
    const bool good = comma != std::string::npos &&
                      number_in(std::string_view(line).substr(0, comma), time) &&
                      number_in(std::string_view(line).substr(comma + 1), command);
    if (!good && (number == 1 || line.find_first_not_of(" \r") == std::string::npos)) continue;
    if (!good) {
      faults.push_back(fmt::format("{}:{}: \"{}\": two numbers are needed, time in s and what is asked", path,
                                   number, line));
    } else if (!in.time_s.empty() && time <= in.time_s.back()) {
      faults.push_back(
          fmt::format("{}:{}: time {} does not come after {}", path, number, time, in.time_s.back()));
    } else {
      in.time_s.push_back(time);
      in.command.push_back(command);
    }
    if (faults.size() > 20) break;
  }
  if (in.time_s.size() < 3 && faults.empty())
    faults.push_back(fmt::format("--excite {}: fewer than three rows", path));
  return in;
}

AxisInput excited(Excitation kind, const BenchOptions& options, double scale, std::uint64_t seed) {
  AxisInput in;
  const auto count = static_cast<std::size_t>(options.duration_s * options.rate_Hz + 1e-6) + 1;
  for (std::size_t n = 0; n < count; ++n) {
    in.time_s.push_back(static_cast<double>(n) / options.rate_Hz);
    in.command.push_back(
        options.amplitude * scale *
        excitation_at(kind, in.time_s.back(), {.duration_s = options.duration_s, .seed = seed}));
  }
  return in;
}

AxisInput part_of(const AxisInput& in, std::size_t from, std::size_t to) {
  AxisInput part;
  part.time_s.assign(in.time_s.begin() + static_cast<std::ptrdiff_t>(from),
                     in.time_s.begin() + static_cast<std::ptrdiff_t>(to));
  part.command.assign(in.command.begin() + static_cast<std::ptrdiff_t>(from),
                      in.command.begin() + static_cast<std::ptrdiff_t>(to));
  return part;
}

void add_runs(const std::string& excitation, const BenchOptions& options, std::vector<AxisBenchRun>& runs,
              std::vector<std::string>& faults) {
  if (const auto kind = find_excitation(excitation)) {
    runs.push_back({excitation, "fit", excitation, excited(*kind, options, 1.0, options.seed), {}, 0});
    runs.push_back({excitation + "_holdout",
                    "holdout",
                    excitation,
                    excited(*kind, options, kHoldoutAmplitude, options.seed + 1),
                    {},
                    0});
    return;
  }
  if (excitation.find('.') == std::string::npos && !std::filesystem::exists(excitation)) {
    faults.push_back(fmt::format("--excite {}: allowed are {}, or a CSV file", excitation,
                                 fmt::join(excitation_names(), ", ")));
    return;
  }
  const AxisInput in = read_file(excitation, faults);
  if (!faults.empty()) return;
  const std::string stem = std::filesystem::path(excitation).stem().string();
  const auto cut = static_cast<std::size_t>(static_cast<double>(in.time_s.size()) * (1.0 - kHoldoutRatio));
  runs.push_back({stem, "fit", excitation, part_of(in, 0, cut), {}, 0});
  runs.push_back({stem + "_holdout", "holdout", excitation, part_of(in, cut, in.time_s.size()), {}, 0});
}

void check_numbers(const BenchOptions& o, std::vector<std::string>& faults) {
  if (!(o.duration_s > 0.0 && o.duration_s <= 3600.0))
    faults.push_back("--duration: allowed is more than 0 to 3600 s");
  if (!(o.rate_Hz >= 1.0 && o.rate_Hz <= 1e5)) faults.push_back("--rate: allowed is 1 to 100000 Hz");
  if (!(o.step_s >= 1e-7 && o.step_s <= 1e-3)) faults.push_back("--step: allowed is 1e-7 to 1e-3 s");
  if (!(o.noise_scale >= 0.0 && o.noise_scale <= 1000.0)) faults.push_back("--noise: allowed is 0 to 1000");
}

}  // namespace

std::optional<AxisBench> make_bench(const BenchOptions& options, std::vector<std::string>& faults) {
  check_numbers(options, faults);
  std::optional<AxisModel> model = open_model(options.model, faults);
  if (!model) return std::nullopt;
  const std::optional<CommandKind> kind = kind_of(options, *model, faults);
  std::vector<EffectUse> effects = model->effects;
  for (const std::string& text : options.with) {
    const std::string fault =
        add_override(text, {.drive = &model->drive, .linear = model->drive.linear}, effects);
    if (!fault.empty()) faults.push_back("--with " + fault);
  }
  AxisBench bench{.title = "simulated: " + options.model, .model = *model, .runs = {}, .noise = {}};
  if (faults.empty()) {
    for (const std::string& e : options.excitations) add_runs(e, options, bench.runs, faults);
  }
  for (std::size_t i = 0; i < bench.runs.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (bench.runs[i].name == bench.runs[j].name)
        faults.push_back(fmt::format("--excite {}: given twice", bench.runs[i].name));
    }
  }
  if (!faults.empty()) return std::nullopt;
  bench.noise.bus_voltage_V *= options.noise_scale;
  bench.noise.motor_current_A *= options.noise_scale;
  bench.noise.position_rad *= options.noise_scale;
  bench.noise.winding_K *= options.noise_scale;
  bench.has_temperature = std::any_of(effects.begin(), effects.end(), [](const EffectUse& u) {
    const EffectEntry* read = find_effect(u.entry->info->needs);
    return ((u.entry->info->claims | (read != nullptr ? read->info->claims : 0u)) & kWarmsWinding) != 0;
  });
  const EffectSet<double> set(effects);
  std::uint64_t seed = options.seed;
  for (AxisBenchRun& run : bench.runs) {
    run.seed = mix_bits(seed++);
    run.input.kind = *kind;
    run.input.encoder_counts_per_turn = model->encoder_counts_per_turn;
    run.input.noise_seed = run.seed;
    run.samples = run_axis(model->drive, set, run.input, {.step_s = options.step_s});
  }
  return bench;
}

}  // namespace omnihil
