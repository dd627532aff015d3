#include "sim/bench/dataset_text.h"

#include <fmt/format.h>

#include <cmath>

#include "sim/drive/sensor_chain.h"
#include "sim/law/toml_text.h"

namespace omnihil {

std::string dataset_head(std::string_view title, std::string_view rig, std::string_view radio) {
  const std::string sent = radio.empty() ? "" : fmt::format("radio = {}\n", toml_text(radio));
  return fmt::format(
             "format = \"omnihil-dataset/1\"\ntitle = {}\nrig = \"{}\"\nmodel = "
             "\"model.toml\"\n{}\n[channels]\n",
             toml_text(title), rig, sent) +
         channel_line("time", "time_s");
}

std::string channel_line(std::string_view signal, std::string_view column, double sigma,
                         std::string_view more) {
  const std::string noise = sigma > 0.0 ? fmt::format(", sigma = {:g}", sigma) : "";
  return fmt::format("{} = {{ column = \"{}\"{}{} }}\n", signal, column, noise, more);
}

std::string columns_text(std::string_view title, std::string_view rig,
                         const std::vector<BenchColumn>& columns) {
  std::string text = dataset_head(title, rig);
  for (const BenchColumn& c : columns) text += channel_line(c.signal, c.column, c.sigma, c.more);
  return text;
}

std::string bench_header(const std::vector<BenchColumn>& columns) {
  std::string text = "time_s";
  for (const BenchColumn& c : columns) text += "," + c.column;
  return text + "\n";
}

std::string bench_line(const std::vector<BenchColumn>& columns, double time_s,
                       const std::vector<double>& values, std::optional<std::uint64_t> seed,
                       std::uint64_t k) {
  std::string text = fmt::format("{:.6f}", time_s);
  for (std::size_t i = 0; i < columns.size(); ++i) {
    text += ',';
    if (!std::isfinite(values[i])) continue;
    const BenchColumn& c = columns[i];
    const double value = seed && c.sigma > 0.0 ? noisy(values[i], c.sigma, *seed, c.stream, k) : values[i];
    text += fmt::format(fmt::runtime(c.format), value);
  }
  return text + "\n";
}

std::string run_lines(std::string_view file, std::string_view use, std::string_view excitation) {
  std::string out = fmt::format("\n[[runs]]\nfile = {}\nuse = \"{}\"\n", toml_text(file), use);
  if (!excitation.empty()) out += fmt::format("excitation = {}\n", toml_text(excitation));
  return out;
}

}  // namespace omnihil
