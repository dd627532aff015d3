#include "hil/loop/effect_overrides.h"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

#include "sim/model/effect_reader.h"
#include "sim/model/model_effects.h"
#include "sim/robot/robot_effects.h"

namespace omnihil {
namespace {

// "[effects.cogging]" -> "effects.cogging"; "" for any other line. Sections of arrays are none of ours.
std::string section_of(const std::string& line) {
  const std::size_t open = line.find_first_not_of(" \t");
  if (open == std::string::npos || line[open] != '[') return "";
  const std::size_t close = line.find(']', open);
  return close == std::string::npos ? "" : line.substr(open + 1, close - open - 1);
}

bool opens_section(const std::string& line) {
  const std::size_t first = line.find_first_not_of(" \t");
  return first != std::string::npos && line[first] == '[';
}

// The text without one section and those below it.
std::string without(const std::string& text, const std::string& section) {
  std::istringstream lines(text);
  std::string out, line;
  bool inside = false;
  while (std::getline(lines, line)) {
    if (opens_section(line)) inside = (section_of(line) + ".").starts_with(section + ".");
    if (!inside) out += line + "\n";
  }
  return out;
}

std::string id_of(const std::string& with) { return with.substr(0, with.find_first_of(".=")); }

// Everything in effect now; Coulomb friction too, which the base model holds.
std::vector<EffectUse> uses_of(const ModelFile& model, const EffectContext& context) {
  std::vector<EffectUse> uses;
  if (model.robot->effects != nullptr) uses = *model.robot->effects;
  const double coulomb_Nm = model.robot->motor.coulomb_friction_Nm;
  if (coulomb_Nm > 0.0) add_override(fmt::format("coulomb_friction.torque_Nm={}", coulomb_Nm), context, uses);
  return uses;
}

}  // namespace

void add_effects(ModelBundle& bundle, const std::vector<std::string>& with,
                 std::vector<std::string>& faults) {
  if (with.empty()) return;
  const ModelReading reading = read_bundle(bundle);
  if (!reading.model || !reading.model->robot) return;
  const DriveParams<double> drive = wheel_drive_params(*reading.model->robot);
  const EffectContext context{.drive = &drive, .linear = false, .wheels = reading.model->robot->wheels};
  std::vector<EffectUse> uses = uses_of(*reading.model, context);
  const std::size_t before = faults.size();
  for (const std::string& text : with) {
    const std::string fault = add_override(text, context, uses);
    if (!fault.empty()) {
      faults.push_back("--with " + fault);
    } else if (!acts_on_robot(id_of(text))) {
      faults.push_back(fmt::format(
          "--with {}: has no place in the simulation of a robot: it acts on a bench alone", text));
    }
  }
  if (faults.size() > before) return;
  std::string text = bundle.robot_text;
  if (!text.empty() && text.back() != '\n') text += '\n';
  std::vector<std::string> done;
  for (const std::string& one : with) {
    const std::string id = id_of(one);
    if (std::find(done.begin(), done.end(), id) != done.end()) continue;
    done.push_back(id);
    text = without(text, "effects." + id);
    for (const EffectUse& use : uses) {
      if (use.entry->info->id == id) text += write_effects({&use, 1}, false);
    }
  }
  ModelBundle changed = bundle;
  changed.robot_text = text;
  for (const ModelProblem& p : read_bundle(changed).problems) {
    faults.push_back(
        fmt::format("--with: {} (write each effect of the model as a section of its own)", p.text()));
  }
  if (faults.size() == before) bundle = std::move(changed);
}

}  // namespace omnihil
