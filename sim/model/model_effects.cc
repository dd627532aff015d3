#include "sim/model/model_effects.h"

#include <algorithm>

#include "sim/law/effect_registry.h"
#include "sim/model/effect_reader.h"
#include "sim/robot/robot_effects.h"

namespace omnihil {
namespace {

constexpr std::string_view kInBaseModel = "coulomb_friction";

bool has(const std::vector<EffectUse>& uses, const EffectUse& use) {
  return std::any_of(uses.begin(), uses.end(), [&](const EffectUse& u) {
    return u.entry->info->id == use.entry->info->id && u.name == use.name;
  });
}

}  // namespace

std::vector<EffectUse> read_robot_effects(const ModelDocument& document, const ModelDocument* motor,
                                          const RobotModel* robot, std::vector<ModelProblem>& problems) {
  DriveParams<double> drive;
  if (robot != nullptr) drive = wheel_drive_params(*robot);
  EffectContext context;
  if (robot != nullptr) context = {.drive = &drive, .linear = false, .wheels = robot->wheels};
  std::vector<ModelProblem> found;
  std::vector<EffectUse> uses;
  for (const ModelDocument* source : {&document, motor}) {
    if (source == nullptr) continue;
    for (EffectUse& use : read_effects(*source, context, found)) {
      if (use.entry->info->id != kInBaseModel && !has(uses, use)) uses.push_back(std::move(use));
    }
  }
  for (ModelProblem& p : found) {
    const bool said = std::any_of(problems.begin(), problems.end(), [&](const ModelProblem& q) {
      return p.file == q.file && p.line == q.line && p.column == q.column;
    });
    if (!said) problems.push_back(std::move(p));
  }
  return uses;
}

bool acts_on_robot(std::string_view effect) {
  const EffectEntry* entry = find_effect(effect);
  return effect == kInBaseModel || (entry != nullptr && (entry->info->rigs & kOnRobot) != 0);
}

}  // namespace omnihil
