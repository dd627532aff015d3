#include "sim/bench/axis_dataset.h"

#include <fmt/format.h>

#include "sim/bench/axis_signal.h"
#include "sim/bench/dataset_text.h"
#include "sim/model/model_rows.h"
#include "sim/model/model_writer.h"

namespace omnihil {
namespace {

// 1-sigma of usual sensors (guesses, +-50 %); of a position where the rig has no encoder.
constexpr double kBus_V = 0.02, kCurrent_A = 0.03, kPosition_rad = 1e-4, kWinding_K = 0.2;

// What is asked first, then what the axis' signals of those names (axis_signal.h) show.
std::vector<BenchColumn> columns_of(const AxisBench& bench) {
  const AxisInput& in = bench.runs.front().input;
  std::vector<BenchColumn> out{{std::string(command_name(in.kind)), std::string(command_name(in.kind))}};
  const auto add = [&](const char* signal, const char* column, const char* format, double sigma) {
    out.push_back({signal, column, format, sigma * bench.noise_scale, "", signal});
  };
  if (bench.model.has_electrics && in.kind != CommandKind::kMotorVoltage)
    add("bus_voltage", "bus_V", "{:.4f}", kBus_V);
  if (bench.model.has_electrics && in.kind != CommandKind::kMotorCurrent)
    add("motor_current", "current_A", "{:.5f}", kCurrent_A);
  if (bench.model.encoder_counts_per_turn > 0.0) {
    add("encoder", "ticks", "{:.0f}", 0.0);
    out.back().more =
        fmt::format(", counts_per_rev = {:g}, shaft = \"{}\"", bench.model.encoder_counts_per_turn,
                    in.encoder_on_output ? "output" : "rotor");
  } else {
    add("position", "position", "{:.9g}", kPosition_rad);
  }
  if (bench.has_temperature) {
    add("winding_temperature", "winding_degC", "{:.2f}", kWinding_K);
    out.back().stream = "winding";
  }
  return out;
}

}  // namespace

std::string dataset_text(const AxisBench& bench) {
  std::string out = columns_text(bench.title, "axis", columns_of(bench));
  for (const AxisBenchRun& run : bench.runs) out += run_lines(run.name + ".csv", run.use, run.excitation);
  return out;
}

std::string run_csv(const AxisBench& bench, const AxisBenchRun& run) {
  const std::vector<BenchColumn> columns = columns_of(bench);
  std::string out = bench_header(columns);
  for (std::size_t k = 0; k < run.samples.size(); ++k) {
    std::vector<double> values{run.input.command[k]};
    for (std::size_t i = 1; i < columns.size(); ++i)
      values.push_back(find_axis_signal(columns[i].signal)->get(run.samples[k], run.input, k));
    out += bench_line(columns, run.samples[k].time_s, values, run.seed, k);
  }
  return out;
}

std::string axis_model_text(const AxisModel& model) {
  // What a robot's and a motor's file have in an axis' place (drive_params_of).
  constexpr std::pair<std::string_view, std::string_view> kStandIns[] = {
      {"robot.wheel_inertia_kg_m2", "load.inertia_kg_m2"},
      {"datasheet.nominal_voltage_V", "supply.voltage_V"}};
  ModelFile file = model.file;
  file.rig = "axis";
  for (const auto& [from, to] : kStandIns) {
    Parameter* stands_in = file.parameters.find(from);
    const Parameter* own = file.parameters.find(to);
    if (stands_in == nullptr || (own != nullptr && !own->values.empty())) continue;
    for (const ParameterRow& row : model_rows()) {
      if (parameter_path(row) == to) stands_in->row = &row;
    }
  }
  return model_text(file, model.effects);
}

}  // namespace omnihil
