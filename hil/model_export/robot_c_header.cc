// A C header: every number of a robot's file as a macro, and the matrix from body velocity to wheel speeds.
#include <fmt/format.h>

#include <cctype>
#include <cmath>

#include "hil/model_export/export_notes.h"
#include "sim/law/effect_set.h"
#include "sim/robot/geometry.h"

namespace omnihil {
namespace {

// "motor.resistance_ohm" -> "OMNIHIL_MOTOR_RESISTANCE_OHM"
std::string macro_of(std::string_view path) {
  std::string out = "OMNIHIL_";
  for (const char c : path) {
    const auto u = static_cast<unsigned char>(c);
    out += std::isalnum(u) != 0 ? static_cast<char>(std::toupper(u)) : '_';
  }
  return out;
}

// A C floating constant: "3" alone would be an int.
std::string constant(double v) {
  std::string out = exact(v);
  if (out.find_first_of(".e") == std::string::npos) out += ".0";
  return v < 0.0 ? "(" + out + ")" : out;
}

// Nothing of what a file says may end a comment, or go on to the next line.
std::string comment(std::string text) {
  for (char& c : text) {
    if (c == '\n' || c == '\r' || c == '\\') c = ' ';
  }
  for (std::size_t at; (at = text.find("*/")) != std::string::npos;) text.replace(at, 2, "* /");
  for (std::size_t at; (at = text.find("/*")) != std::string::npos;) text.replace(at, 2, "/ *");
  return "/* " + text + " */";
}

std::string line_of(const Parameter& p) {
  std::string value;
  if (p.row->kind == ParameterKind::kWholeNumber || p.row->kind == ParameterKind::kTruth) {
    value = fmt::format("{:.0f}", p.value());
  } else if (p.values.size() == 1) {
    value = constant(p.value());
  } else {
    for (const double v : p.values) value += (value.empty() ? "{" : ", ") + constant(v);
    value += "}";
  }
  std::string about = p.row->unit == "1" ? "" : std::string(p.row->unit) + "; ";
  about += p.row->what;
  if (const std::string origin = origin_words(p); !origin.empty()) about += "; " + origin;
  return fmt::format("#define {} {} {}\n", macro_of(parameter_path(*p.row)), value, comment(about));
}

std::string effect_lines(const RobotModel& m) {
  std::string out;
  if (!m.effects) return out;
  for (const EffectUse& use : *m.effects) {
    const std::string name = use.name.empty() ? std::string(use.entry->info->id) : "expression." + use.name;
    out += "\n" + comment(fmt::format("{}: {}", name, use.entry->info->equation)) + "\n";
    for (std::size_t i = 0; i < use.values.size() && i < use.entry->info->params.size(); ++i) {
      const EffectParam& row = use.entry->info->params[i];
      out += fmt::format("#define {} {} {}\n", macro_of("effects." + name + "." + std::string(row.name)),
                         constant(use.values[i]), comment(fmt::format("{}; {}", row.unit, row.what)));
    }
  }
  return out;
}

// Rows of eq. (5): rad/s of a wheel per m/s forward, per m/s to the left, per rad/s of turning.
std::string matrix(const RobotModel& m) {
  const WheelGeometry<double> g = wheel_geometry(m);
  std::string out = "#define OMNIHIL_WHEEL_SPEEDS_OF_BODY {";
  for (std::size_t i = 0; i < m.wheels; ++i) {
    out += fmt::format("{}{{{}, {}, {}}}", i == 0 ? "" : ", ", constant(-g.sin_angle[i] / g.wheel_radius_m),
                       constant(g.cos_angle[i] / g.wheel_radius_m),
                       constant(g.wheel_center_radius_m / g.wheel_radius_m));
  }
  return out + "}\n";
}

}  // namespace

ModelExport robot_c_header(const ModelFile& file, const std::string& name) {
  const RobotModel& m = *file.robot;
  ModelExport made;
  made.lost = {"the laws: tyre curves, friction, effects are numbers here, not functions",
               "tolerances and sources: in comments"};
  for (const Parameter& p : file.parameters.parameters) {
    if (!p.row->section.empty() && is_text(*p.row) && p.origin != Origin::kDefault)
      made.lost.push_back(parameter_path(*p.row) + " = " + value_words(p));
  }
  const std::string guard = macro_of(name + "_H");
  made.text =
      comment(name + ": numbers of a robot by omnihil. SI, but where the name says another unit.") + "\n";
  made.text += comment("What does not survive:") + "\n";
  for (const std::string& line : made.lost) made.text += comment("  " + line) + "\n";
  made.text += fmt::format("#ifndef {0}\n#define {0}\n\n", guard);
  std::string_view section;
  for (const Parameter& p : file.parameters.parameters) {
    if (p.row->section.empty() || is_text(*p.row) || p.values.empty() || !std::isfinite(p.value())) continue;
    if (p.row->section != section) made.text += "\n";
    section = p.row->section;
    made.text += line_of(p);
  }
  made.text += effect_lines(m);
  made.text += "\n" +
               comment("wheel speeds in rad/s = this matrix times (forward m/s, left m/s, turning rad/s)") +
               "\n" + matrix(m);
  made.text += "\n#endif\n";
  return made;
}

}  // namespace omnihil
