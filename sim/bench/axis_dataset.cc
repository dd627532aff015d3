#include "sim/bench/axis_dataset.h"

#include <fmt/format.h>

#include "sim/bench/axis_signal.h"
#include "sim/bench/dataset_text.h"
#include "sim/drive/sensor_chain.h"
#include "sim/model/effect_reader.h"
#include "sim/model/model_writer.h"

namespace omnihil {
namespace {

constexpr double kAmbient_degC = 25.0;

bool has_encoder(const AxisBench& bench) { return bench.model.encoder_counts_per_turn > 0.0; }

}  // namespace

std::string dataset_text(const AxisBench& bench) {
  const CommandKind kind = bench.runs.front().input.kind;
  std::string out = dataset_head(bench.title, "axis");
  out += channel_line(command_name(kind), command_name(kind));
  if (bench.model.has_electrics) {
    if (kind != CommandKind::kMotorVoltage)
      out += channel_line("bus_voltage", "bus_V", bench.noise.bus_voltage_V);
    if (kind != CommandKind::kMotorCurrent)
      out += channel_line("motor_current", "current_A", bench.noise.motor_current_A);
  }
  if (has_encoder(bench)) {
    out += channel_line(
        "encoder", "ticks", 0.0,
        fmt::format(", counts_per_rev = {:g}, shaft = \"{}\"", bench.model.encoder_counts_per_turn,
                    bench.runs.front().input.encoder_on_output ? "output" : "rotor"));
  } else {
    out += channel_line("position", "position", bench.noise.position_rad);
  }
  if (bench.has_temperature)
    out += channel_line("winding_temperature", "winding_degC", bench.noise.winding_K);
  for (const AxisBenchRun& run : bench.runs) out += run_lines(run.name + ".csv", run.use, run.excitation);
  return out;
}

std::string run_csv(const AxisBench& bench, const AxisBenchRun& run) {
  const CommandKind kind = run.input.kind;
  const bool bus = bench.model.has_electrics && kind != CommandKind::kMotorVoltage;
  const bool current = bench.model.has_electrics && kind != CommandKind::kMotorCurrent;
  std::string out =
      fmt::format("time_s,{}{}{}{}{}\n", command_name(kind), bus ? ",bus_V" : "", current ? ",current_A" : "",
                  has_encoder(bench) ? ",ticks" : ",position", bench.has_temperature ? ",winding_degC" : "");
  for (std::size_t k = 0; k < run.samples.size(); ++k) {
    const AxisSample<double>& s = run.samples[k];
    const auto read = [&](double value, double sigma, std::string_view stream) {
      return noisy(value, sigma, run.seed, stream, k);
    };
    out += fmt::format("{:.6f},{:.9g}", s.time_s, run.input.command[k]);
    if (bus) out += fmt::format(",{:.4f}", read(s.bus_voltage_V, bench.noise.bus_voltage_V, "bus_voltage"));
    if (current)
      out += fmt::format(",{:.5f}", read(s.motor_current_A, bench.noise.motor_current_A, "motor_current"));
    if (has_encoder(bench)) {
      out += fmt::format(",{:.0f}", encoder_reading(s.encoder_counts));
    } else {
      out += fmt::format(",{:.9g}", read(s.position_rad, bench.noise.position_rad, "position"));
    }
    if (bench.has_temperature) {
      out += fmt::format(",{:.2f}", read(kAmbient_degC + s.winding_rise_K, bench.noise.winding_K, "winding"));
    }
    out += '\n';
  }
  return out;
}

std::string axis_model_text(const AxisModel& model) {
  std::string out = "format = \"omnihil-model/1\"\nrig = \"axis\"\n";
  if (model.drive.linear) out += "linear = true\n";
  if (!model.file.name.empty()) out += fmt::format("name = {}\n", toml_text(model.file.name));
  const auto number = [&](std::string_view key, double value, const Parameter* given) {
    if (given == nullptr) return fmt::format("{} = {}\n", key, value);
    Parameter written = *given;
    written.values = {value};
    return parameter_line(key, written);
  };
  const DriveParams<double> otherwise;
  std::string section;
  for (const DriveParamPath& at : drive_param_paths()) {
    const std::string path(model.drive.linear ? at.linear_path : at.path);
    if (path.empty() || model.drive.*at.value == otherwise.*at.value) continue;
    const std::size_t dot = path.find('.');
    if (path.substr(0, dot) != section) out += fmt::format("\n[{}]\n", section = path.substr(0, dot));
    const Parameter* given = model.file.parameters.find(path);
    if (given != nullptr && given->values.empty()) given = nullptr;
    out += number(path.substr(dot + 1), model.drive.*at.value, given);
    if (path == "motor.rotor_inertia_kg_m2") {
      if (model.drive.pole_pairs > 0) out += fmt::format("pole_pairs = {}\n", model.drive.pole_pairs);
      if (model.drive.slots > 0) out += fmt::format("slots = {}\n", model.drive.slots);
    }
  }
  return out + write_effects(model.effects, model.drive.linear);
}

}  // namespace omnihil
