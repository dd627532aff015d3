#include "sim/model/model_writer.h"

#include <fmt/format.h>

#include "sim/model/effect_reader.h"
#include "sim/model/model_rows.h"

namespace omnihil {
namespace {

std::string values_text(const Parameter& parameter) {
  if (parameter.row->kind == ParameterKind::kText) return toml_text(parameter.text);
  if (parameter.row->kind == ParameterKind::kTruth) return parameter.value() != 0.0 ? "true" : "false";
  std::string text;
  for (const double value : parameter.values) {
    if (!text.empty()) text += ", ";
    text += fmt::format("{}", value);
  }
  return parameter.values.size() == 1 ? text : "[" + text + "]";
}

bool written(const Parameter& p, std::uint32_t rig) {
  const ParameterRow& row = *p.row;
  if ((row.rigs & rig) == 0 || p.origin == Origin::kDefault) return false;
  if (row.section.empty() || row.section.starts_with("effects.")) return false;  // above, and below
  if (row.section == "motor" && row.key == "file") return false;
  return row.kind == ParameterKind::kText ? !p.text.empty() : !p.values.empty();
}

}  // namespace

std::uint32_t rig_bit(const ModelFile& file) {
  if (file.rig == "robot") return kRigRobot;
  if (file.rig == "motor") return kRigMotor;
  return file.linear ? kRigLinearAxis : kRigAxis;
}

std::string toml_text(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      out += std::string("\\") + c;
    } else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) {
      out += fmt::format("\\u{:04x}", static_cast<unsigned>(static_cast<unsigned char>(c)));
    } else {
      out += c;
    }
  }
  return out + "\"";
}

std::string parameter_line(std::string_view key, const Parameter& parameter) {
  std::string text = std::string(key) + " = ";
  if (!parameter.tolerance && parameter.source.empty()) return text + values_text(parameter) + "\n";
  text += "{ value = " + values_text(parameter);
  if (parameter.tolerance) text += fmt::format(", tolerance = {}", *parameter.tolerance);
  if (!parameter.source.empty()) text += ", source = " + toml_text(parameter.source);
  return text + " }\n";
}

std::string model_text(const ModelFile& file, std::span<const EffectUse> effects) {
  std::string text = fmt::format("format = \"omnihil-model/1\"\nrig = \"{}\"\n", file.rig);
  if (file.linear) text += "linear = true\n";
  if (!file.name.empty()) text += "name = " + toml_text(file.name) + "\n";
  if (!file.source.empty()) text += "source = " + toml_text(file.source) + "\n";
  const std::uint32_t rig = rig_bit(file);
  std::string_view section;
  // Rows of a section stand together in the table of rows; numbers that a run added stand behind.
  for (const ParameterRow& row : model_rows()) {
    for (const Parameter& p : file.parameters.parameters) {
      if (p.row != &row || !written(p, rig)) continue;
      if (row.section != section) text += fmt::format("\n[{}]\n", section = row.section);
      text += parameter_line(row.key, p);
    }
  }
  return text + write_effects(effects, file.linear);
}

}  // namespace omnihil
