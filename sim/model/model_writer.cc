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

std::string parameter_line(std::string_view key, const Parameter& parameter) {
  const std::string more =
      annotations_text(parameter.tolerance, {.source = parameter.source, .fitted = parameter.fitted});
  const std::string value = values_text(parameter);
  return more.empty() ? fmt::format("{} = {}\n", key, value)
                      : fmt::format("{} = {{ value = {}{} }}\n", key, value, more);
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
