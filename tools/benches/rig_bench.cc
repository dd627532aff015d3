#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "hil/dataset/dataset_model.h"
#include "identify/predict/predictor.h"
#include "sim/bench/axis_dataset.h"
#include "tools/benches/virtual_bench.h"

namespace omnihil {
namespace {

// Its model without the effects of --with and with them, and the text of the one without.
struct Opened {
  Candidate nominal, driven;
  std::string text;
};

std::optional<Opened> open(const Rig& rig, const BenchOptions& o, std::vector<std::string>& faults) {
  if (rig.of_robot) {
    const std::optional<BenchRobot> robot = open_robot(o, faults);
    if (!robot) return std::nullopt;
    return Opened{candidate_of(*robot->nominal.model), candidate_of(*robot->driven.model),
                  dataset_model_text(*robot->nominal.model)};
  }
  const std::optional<BenchAxis> axis = open_axis(o, faults);
  if (!axis || !faults.empty()) return std::nullopt;
  return Opened{candidate_of(axis->nominal.file, axis->nominal.effects),
                candidate_of(axis->nominal.file, axis->driven), axis_model_text(axis->nominal)};
}

// What is given, and room for what will be measured.
Run run_of(const std::vector<Channel>& channels, const BenchRun& planned) {
  Run run;
  for (const Channel& c : channels) run.signals[c.signal].resize(planned.input.size());
  for (std::size_t k = 0; k < planned.input.size(); ++k) {
    const BenchRow& row = planned.input[k];
    run.time_s.push_back(row.time_s);
    for (std::size_t i = 0; i < row.values.size(); ++i) run.signals[channels[i].signal][k] = row.values[i];
  }
  return run;
}

Dataset blank(const Rig& rig, const BenchOptions& o, const Candidate& model,
              const std::vector<BenchRun>& runs) {
  Dataset d;
  d.rig = &rig;
  d.linear = model.file.linear;
  d.channels = rig.bench->channels(model);
  for (Channel& c : d.channels) {
    const SignalRow& row = *find_signal(rig, c.signal);
    c.unit = signal_unit(row, d.linear);
    c.imposed = c.imposed || row.imposed == Imposed::kAlways;
    c.sigma *= o.noise_scale;
  }
  for (const BenchRun& run : runs) d.runs.push_back(run_of(d.channels, run));
  return d;
}

std::vector<BenchColumn> columns_of(const Dataset& d) {
  std::vector<BenchColumn> out;
  for (const Channel& c : d.channels) {
    out.push_back({.signal = c.signal, .column = c.column, .sigma = c.sigma});
    if (c.counts_per_rev > 0.0)
      out.back().more = fmt::format(", counts_per_rev = {:g}, shaft = \"rotor\"", c.counts_per_rev);
  }
  return out;
}

std::string run_text(const std::vector<BenchColumn>& columns, const Run& run) {
  std::string text = bench_header(columns);
  for (std::size_t k = 0; k < run.time_s.size(); ++k) {
    std::vector<double> values;
    for (const BenchColumn& c : columns) values.push_back((*run.signal(c.signal))[k]);
    text += bench_line(columns, run.time_s[k], values);
  }
  return text;
}

}  // namespace

std::optional<VirtualBench> make_rig_bench(const Rig& rig, const BenchOptions& o,
                                           std::vector<std::string>& faults) {
  const std::optional<Opened> model = open(rig, o, faults);
  if (!model) return std::nullopt;
  const auto runs = bench_runs(
      o, faults,
      [&](Excitation e, double scale, std::uint64_t seed) {
        return bench_rows(o, rig.bench->given(model->nominal, {.excitation = e,
                                                               .amplitude = o.amplitude,
                                                               .scale = scale,
                                                               .duration_s = o.duration_s,
                                                               .rate_Hz = o.rate_Hz,
                                                               .seed = seed}));
      },
      [&](const std::string& path) {
        faults.push_back(fmt::format("--excite {}: of a {} excitations by name are allowed", path, rig.name));
        return std::vector<BenchRow>();
      });
  if (!faults.empty()) return std::nullopt;
  const Dataset asked = blank(rig, o, model->nominal, runs);
  const auto measured = make_predictor(asked, model->nominal, {})->simulated(model->driven, o.seed);
  const std::vector<BenchColumn> columns = columns_of(asked);
  VirtualBench bench;
  bench.files = {{"dataset.toml", bench_dataset(fmt::format("simulated: a {} of {}", rig.name, o.model),
                                                std::string(rig.name), columns, runs)},
                 {"model.toml", model->text}};
  for (const BenchRun& planned : runs) {
    const Run& run = measured->run(static_cast<int>(bench.runs++));
    bench.files.push_back({planned.name + ".csv", run_text(columns, run)});
    bench.rows += run.time_s.size();
    for (const auto& [name, values] : run.signals) {
      const auto bad = std::find_if(values.begin(), values.end(), [](double v) { return !std::isfinite(v); });
      if (bad == values.end() || !bench.diverged.empty()) continue;
      bench.diverged = fmt::format("run {}: {} is not finite at {:.6f} s", planned.name, name,
                                   run.time_s[static_cast<std::size_t>(bad - values.begin())]);
    }
  }
  return bench;
}

}  // namespace omnihil
