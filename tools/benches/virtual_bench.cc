#include "tools/benches/virtual_bench.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "hil/loop/effect_overrides.h"
#include "hil/text/program_files.h"
#include "hil/text/recording_text.h"
#include "sim/model/effect_reader.h"

namespace omnihil {
namespace {

// "" or what is wrong with an excitation's name, which is no file's either.
std::string excitation_fault(const std::string& excitation) {
  const bool file = excitation.find('.') != std::string::npos || std::filesystem::exists(excitation);
  if (file || find_excitation(excitation)) return "";
  return fmt::format("--excite {}: allowed are {}, or a CSV file", excitation,
                     fmt::join(excitation_names(), ", "));
}

}  // namespace

std::vector<BenchRow> read_bench_rows(const std::string& path, std::span<const std::size_t> widths,
                                      const std::string& needed, std::vector<std::string>& faults) {
  std::vector<BenchRow> out;
  std::ifstream file(path);
  if (!file) faults.push_back(fmt::format("--excite {}: cannot be read", path));
  std::string line;
  for (int number = 1; std::getline(file, line) && faults.size() < 20; ++number) {
    std::istringstream cells(line);
    std::vector<double> values;
    bool good = true;
    for (std::string cell; std::getline(cells, cell, ',');) {
      cell.erase(0, cell.find_first_not_of(" \t"));
      cell.erase(cell.find_last_not_of(" \t\r") + 1);
      values.push_back(0.0);
      good = parse_number(cell, values.back()) && good;
    }
    if ((!good && number == 1) || line.find_first_not_of(" \t\r") == std::string::npos) continue;
    const bool wide =
        !values.empty() && std::find(widths.begin(), widths.end(), values.size() - 1) != widths.end();
    if (!good || !wide || (!out.empty() && values[0] <= out.back().time_s)) {
      faults.push_back(fmt::format("{}:{}: \"{}\": needed are a time in s that increases and {}", path,
                                   number, line, needed));
      continue;
    }
    out.push_back({values[0], {values.begin() + 1, values.end()}});
  }
  if (out.size() < 3 && faults.empty())
    faults.push_back(fmt::format("--excite {}: fewer than three rows", path));
  return out;
}

std::vector<BenchRow> bench_rows(const BenchOptions& o,
                                 const std::function<std::vector<double>(double)>& values) {
  std::vector<BenchRow> out;
  const auto count = static_cast<std::size_t>(o.duration_s * o.rate_Hz + 1e-6) + 1;
  for (std::size_t n = 0; n < count; ++n) {
    const double time_s = static_cast<double>(n) / o.rate_Hz;
    out.push_back({time_s, values(time_s)});
  }
  return out;
}

std::vector<BenchRun> bench_runs(
    const BenchOptions& o, std::vector<std::string>& faults,
    const std::function<std::vector<BenchRow>(Excitation, double, std::uint64_t)>& excited,
    const std::function<std::vector<BenchRow>(const std::string&)>& read) {
  constexpr double kHoldoutRatio = 1.0 / 3.0;  // of a file's time, at its end
  constexpr double kHoldoutAmplitude = 0.8;    // of the fit run's
  std::vector<BenchRun> runs;
  for (const std::string& e : o.excitations) {
    if (const auto kind = find_excitation(e)) {
      runs.push_back({e, "fit", e, excited(*kind, 1.0, o.seed)});
      runs.push_back({e + "_holdout", "holdout", e, excited(*kind, kHoldoutAmplitude, o.seed + 1)});
    } else {
      const std::vector<BenchRow> all = read(e);
      const auto cut = static_cast<std::ptrdiff_t>(static_cast<double>(all.size()) * (1.0 - kHoldoutRatio));
      const std::string stem = std::filesystem::path(e).stem().string();
      runs.push_back({stem, "fit", e, {all.begin(), all.begin() + cut}});
      runs.push_back({stem + "_holdout", "holdout", e, {all.begin() + cut, all.end()}});
    }
  }
  for (std::size_t i = 0; i < runs.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (runs[i].name == runs[j].name) faults.push_back("--excite " + runs[i].name + ": given twice");
    }
  }
  return runs;
}

void check_bench_numbers(const BenchOptions& o, std::vector<std::string>& faults) {
  for (const std::string& e : o.excitations) {
    if (const std::string fault = excitation_fault(e); !fault.empty()) faults.push_back(fault);
  }
  if (!(o.duration_s > 0.0 && o.duration_s <= 3600.0))
    faults.push_back("--duration: allowed is more than 0 to 3600 s");
  if (!(o.rate_Hz >= 1.0 && o.rate_Hz <= 1e5)) faults.push_back("--rate: allowed is 1 to 100000 Hz");
  if (!(o.step_s >= 1e-7 && o.step_s <= 1e-3)) faults.push_back("--step: allowed is 1e-7 to 1e-3 s");
  if (!(o.noise_scale >= 0.0 && o.noise_scale <= 1000.0)) faults.push_back("--noise: allowed is 0 to 1000");
}

namespace {

std::optional<AxisModel> open_model(const std::string& name, std::vector<std::string>& faults) {
  const StoredModel stored = load_model(name, {data_folder("models")});
  if (stored.bundle.robot_text.empty()) {
    for (const ModelProblem& p : stored.problems) faults.push_back(p.text());
    return std::nullopt;
  }
  AxisReading reading = read_axis_bundle(stored.bundle);
  for (const ModelProblem& p : reading.problems) faults.push_back(p.text());
  return std::move(reading.model);
}

void check_robot_numbers(const BenchOptions& o, std::vector<std::string>& faults) {
  check_bench_numbers(o, faults);
  const bool whole = o.rate_Hz > 0.0 && std::llround(1e9 / o.rate_Hz) % 500'000 == 0 && o.rate_Hz <= 2000.0;
  if (!whole)
    faults.push_back("--rate: allowed for a robot are 2000 Hz and its whole parts (1000, 500, 400 …)");
  if (!(o.amplitude >= -1.0 && o.amplitude <= 1.0))
    faults.push_back("--amplitude: allowed is -1 to 1, a duty");
  if (!o.drive.empty() && o.drive != "duty")
    faults.push_back(fmt::format("--drive {}: a robot is driven by duty", o.drive));
}

}  // namespace

std::optional<BenchRobot> open_robot(const BenchOptions& options, std::vector<std::string>& faults) {
  check_robot_numbers(options, faults);
  BenchRobot out{.nominal = load_robot_model(options.model, {data_folder("models")}), .driven = {}};
  for (const ModelProblem& p : out.nominal.problems) faults.push_back(p.text());
  if (!out.nominal.model) return std::nullopt;
  ModelBundle bundle = out.nominal.bundle;
  add_effects(bundle, options.with, faults);
  out.driven = read_bundle(bundle);
  if (!out.driven.model || !faults.empty()) return std::nullopt;
  return out;
}

std::optional<BenchAxis> open_axis(const BenchOptions& options, std::vector<std::string>& faults) {
  check_bench_numbers(options, faults);
  std::optional<AxisModel> model = open_model(options.model, faults);
  if (!model) return std::nullopt;
  std::vector<EffectUse> driven = model->effects;
  for (const std::string& text : options.with) {
    const std::string fault =
        add_override(text, {.drive = &model->drive, .linear = model->drive.linear}, driven);
    if (!fault.empty()) faults.push_back("--with " + fault);
  }
  return BenchAxis{.nominal = std::move(*model), .driven = std::move(driven)};
}

std::string bench_dataset(const std::string& title, const std::string& rig,
                          const std::vector<BenchColumn>& columns, const std::vector<BenchRun>& runs) {
  std::string text = columns_text(title, rig, columns);
  for (const BenchRun& run : runs) text += run_lines(run.name + ".csv", run.use, run.excitation);
  return text;
}

}  // namespace omnihil
