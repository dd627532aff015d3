#include "hil/check/explain_candidates.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "hil/loop/effect_overrides.h"
#include "sim/law/effect_registry.h"
#include "sim/law/effect_set.h"
#include "sim/model/model_effects.h"
#include "sim/model/model_writer.h"
#include "sim/robot/robot_effects.h"

namespace omnihil {
namespace {

constexpr double kLeastStep = 0.02;  // relative: above what the counting of encoders makes of any change
constexpr double kMostStep = 0.2;    // relative: beyond it a parameter is not linear any more
constexpr double kTrace = 1e-6;      // of an effect's typical size: there, and of no consequence

std::optional<ModelBundle> readable(ModelBundle bundle) {
  if (!read_bundle(bundle).model) return std::nullopt;
  return bundle;
}

// With Coulomb friction, which is a number of the base model and a section of the effects in the text.
std::vector<EffectUse> effects_of(const ModelFile& file) {
  std::vector<EffectUse> uses;
  if (file.robot->effects) uses = *file.robot->effects;
  const Parameter* coulomb = file.parameters.find("effects.coulomb_friction.torque_Nm");
  if (coulomb == nullptr || coulomb->origin == Origin::kDefault) return uses;
  EffectUse use = neutral_use(*find_effect("coulomb_friction"));
  use.values.front() = coulomb->value();
  uses.push_back(std::move(use));
  return uses;
}

std::optional<ModelBundle> with_parameter(const ModelBundle& model, const ModelFile& file,
                                          const std::string& path, double value) {
  ModelFile changed = file;
  if (!changed.parameters.set(path, value).empty()) return std::nullopt;
  ModelBundle bundle = model;
  bundle.robot_text = model_text(changed, effects_of(changed));
  bundle.motor_file.clear();
  bundle.motor_text.clear();
  return readable(std::move(bundle));
}

std::optional<ModelBundle> with_effect(const ModelBundle& model, const std::string& name, double value) {
  ModelBundle bundle = model;
  std::vector<std::string> faults;
  add_effects(bundle, {fmt::format("{}={:.17g}", name, value)}, faults);
  if (!faults.empty()) return std::nullopt;
  return bundle;
}

bool in_model(const ModelFile& file, std::string_view id) {
  return std::ranges::any_of(file.effects, [&](const ModelEffect& effect) { return effect.id == id; });
}

}  // namespace

std::vector<ExplainCandidate> explain_candidates(const ModelBundle& model) {
  std::vector<ExplainCandidate> all;
  const ModelReading reading = read_bundle(model);
  if (!reading.model || !reading.model->robot) return all;
  const auto file = std::make_shared<const ModelFile>(*reading.model);
  for (const Parameter& p : file->parameters.parameters) {
    if (p.row->kind != ParameterKind::kNumber || !p.tolerance || *p.tolerance <= 0.0 || p.value() == 0.0)
      continue;
    const std::string path = parameter_path(*p.row);
    const double step = std::clamp(*p.tolerance, kLeastStep, kMostStep) * std::abs(p.value());
    all.push_back({path, std::string(p.row->unit), false, p.value(), p.value() - step, p.value() + step,
                   p.row->lower, p.row->upper,
                   [model, file, path](double value) { return with_parameter(model, *file, path, value); }});
  }
  const DriveParams<double> drive = wheel_drive_params(*file->robot);
  for (const EffectEntry* entry : all_effects()) {
    const EffectInfo& info = *entry->info;
    if (info.id == "expression" || !acts_on_robot(info.id) || in_model(*file, info.id) || info.params.empty())
      continue;
    const std::size_t row = first_strength(info);
    if (row >= info.params.size()) continue;
    const double typical = typical_use(*entry, &drive).values[row], neutral = info.params[row].neutral;
    if (!(std::isfinite(neutral) && typical != neutral)) continue;
    const std::string name = fmt::format("{}.{}", info.id, info.params[row].name);
    all.push_back({name, std::string(info.params[row].unit), true, neutral,
                   neutral + kTrace * (typical - neutral), typical, info.params[row].lower,
                   info.params[row].upper,
                   [model, name](double value) { return with_effect(model, name, value); }});
  }
  return all;
}

}  // namespace omnihil
