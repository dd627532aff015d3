#include "hil/model_export/export_notes.h"

#include <fmt/format.h>

#include <algorithm>

#include "hil/text/markup.h"
#include "sim/law/effect_set.h"

namespace omnihil {
namespace {

std::string without_double_hyphen(std::string text) {
  for (std::size_t at; (at = text.find("--")) != std::string::npos;) text.replace(at, 2, "- -");
  return text;
}

}  // namespace

std::string exact(double value) { return fmt::format("{}", value); }
std::string vec(const Eigen::Vector3d& v) { return fmt::format("{} {} {}", v.x(), v.y(), v.z()); }

std::string value_words(const Parameter& p) {
  if (is_text(*p.row)) return p.text;
  std::string out;
  for (const double v : p.values) out += (out.empty() ? "" : ", ") + exact(v);
  return out;
}

std::string origin_words(const Parameter& p) {
  std::string out = p.fitted ? "fitted" : p.source;
  if (p.fitted && p.fitted->sigma) out += fmt::format(", +-{:.2g}", *p.fitted->sigma);
  if (!p.fitted && p.tolerance)
    out += fmt::format("{}+-{:g} %", out.empty() ? "" : ", ", 100.0 * *p.tolerance);
  if (p.origin == Origin::kDefault) out = "default";
  return out;
}

std::vector<std::string> numbers_lost(const ModelFile& model, std::span<const std::string_view> survive) {
  std::vector<std::string> out;
  for (const Parameter& p : model.parameters.parameters) {
    if (p.row->section.empty() || p.origin == Origin::kDefault) continue;
    const std::string path = parameter_path(*p.row);
    if (std::find(survive.begin(), survive.end(), path) == survive.end())
      out.push_back(path + " = " + value_words(p));
  }
  return out;
}

std::vector<std::string> effects_lost(const ModelFile& model) {
  std::vector<std::string> out;
  if (!model.robot || !model.robot->effects) return out;
  for (const EffectUse& use : *model.robot->effects) {
    const std::string name = use.name.empty() ? std::string(use.entry->info->id) : "expression." + use.name;
    out.push_back(fmt::format("effects.{}: {}", name, use.entry->info->title));
  }
  return out;
}

std::string xml_comment(const std::string& title, const ModelExport& made) {
  std::string out = title + "\n";
  if (!made.lost.empty()) out += "\nWhat does not survive:\n";
  for (const std::string& line : made.lost) out += "  " + line + "\n";
  if (!made.assumed.empty()) out += "\nWhat is assumed, since the model does not say it:\n";
  for (const std::string& line : made.assumed) out += "  " + line + "\n";
  return "<!--\n" + escaped(without_double_hyphen(std::move(out))) + "-->\n";
}

std::string origins_comment(const ModelFile& model, std::span<const std::string_view> paths) {
  std::string out;
  for (const std::string_view path : paths) {
    const Parameter* p = model.parameters.find(path);
    if (p != nullptr) out += fmt::format("  {} = {} ({})\n", path, value_words(*p), origin_words(*p));
  }
  return "<!--\nNumbers of the model:\n" + escaped(without_double_hyphen(std::move(out))) + "-->\n";
}

ModelExport export_robot(const ModelFile& model, ExportFormat format, const std::string& name) {
  if (!model.robot) {
    ModelExport out;
    out.problem = fmt::format("rig = \"{}\"; only a robot can be exported", model.rig);
    return out;
  }
  switch (format) {
    case ExportFormat::kMjcf:
      return robot_mjcf(model, name);
    case ExportFormat::kUrdf:
      return robot_urdf(model, name);
    case ExportFormat::kC:
      break;
  }
  return robot_c_header(model, name);
}

}  // namespace omnihil
