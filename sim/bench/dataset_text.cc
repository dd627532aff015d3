#include "sim/bench/dataset_text.h"

#include <fmt/format.h>

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

std::string run_lines(std::string_view file, std::string_view use, std::string_view excitation) {
  std::string out = fmt::format("\n[[runs]]\nfile = {}\nuse = \"{}\"\n", toml_text(file), use);
  if (!excitation.empty()) out += fmt::format("excitation = {}\n", toml_text(excitation));
  return out;
}

}  // namespace omnihil
