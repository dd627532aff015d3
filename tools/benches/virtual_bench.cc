#include "tools/benches/virtual_bench.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include "hil/loop/effect_overrides.h"
#include "hil/text/program_files.h"
#include "hil/text/recording_text.h"
#include "sim/law/toml_text.h"

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

std::string channel_line(const std::string& signal, const std::string& column, double sigma,
                         const std::string& more) {
  const std::string noise = sigma > 0.0 ? fmt::format(", sigma = {:g}", sigma) : "";
  return fmt::format("{} = {{ column = \"{}\"{}{} }}\n", signal, column, noise, more);
}

std::string run_lines(const std::string& name, const std::string& use, const std::string& excitation) {
  return fmt::format("\n[[runs]]\nfile = {}\nuse = \"{}\"\nexcitation = {}\n", toml_text(name + ".csv"), use,
                     toml_text(excitation));
}

std::string dataset_head(const std::string& title, const std::string& rig) {
  return fmt::format(
      "format = \"omnihil-dataset/1\"\ntitle = {}\nrig = \"{}\"\nmodel = \"model.toml\"\n\n[channels]\n",
      toml_text(title), rig);
}

}  // namespace omnihil
