#include "identify/predict/candidate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sim/law/effect_registry.h"
#include "sim/model/axis_model.h"
#include "sim/model/effect_reader.h"
#include "sim/model/model_rows.h"
#include "sim/model/model_writer.h"

namespace omnihil {
namespace {

constexpr std::string_view kEffects = "effects.";
constexpr std::string_view kCoulomb = "coulomb_friction";

double coulomb_of(const Candidate& candidate) {
  const EffectUse* use = use_of(candidate, kCoulomb);
  return use != nullptr ? use->values.front() : 0.0;
}

// Updates the file's derived fields (models built from table and effects) after a change of either.
void refresh(Candidate& candidate) {
  ParameterTable& table = candidate.file.parameters;
  const bool linear = candidate.file.linear;
  if (Parameter* p =
          table.find(linear ? "effects.coulomb_friction.torque_N" : "effects.coulomb_friction.torque_Nm");
      p != nullptr && !p->values.empty()) {
    p->values.front() = coulomb_of(candidate);
  }
  const RobotModel numbers = robot_model_of(table);
  const std::string motor_name = candidate.file.motor.name;
  candidate.file.motor = numbers.motor;
  candidate.file.motor.name = motor_name;
  if (candidate.file.robot) candidate.file.robot = robot_of(candidate);
}

bool is_effects_row(const ParameterRow& row) { return row.section.starts_with(kEffects); }

// The index of an effect and of its row by "cogging.amplitude_Nm"; {-1, 0} where there is none.
std::pair<int, int> effect_row(const Candidate& candidate, std::string_view path) {
  if (path.starts_with(kEffects)) path.remove_prefix(kEffects.size());
  for (std::size_t e = 0; e < candidate.effects.size(); ++e) {
    const EffectUse& use = candidate.effects[e];
    const std::string name = effect_name(use);
    if (!path.starts_with(name) || path.size() <= name.size() || path[name.size()] != '.') continue;
    const std::string_view key = path.substr(name.size() + 1);
    for (std::size_t i = 0; i < use.values.size(); ++i) {
      const EffectParam& row = use.entry->info->params[i];
      if (row.name == key || param_key(row, candidate.file.linear) == key)
        return {static_cast<int>(e), static_cast<int>(i)};
    }
  }
  return {-1, 0};
}

// The parameter of any row that this rig may have; null: none such. A row that no file gave is added, as
// known exactly.
Parameter* table_parameter(Candidate& candidate, std::string_view path) {
  if (Parameter* p = candidate.file.parameters.find(path); p != nullptr) return p;
  const std::size_t dot = path.rfind('.');
  if (dot == std::string_view::npos) return nullptr;
  const ParameterRow* row = find_model_row(path.substr(0, dot), path.substr(dot + 1));
  const bool applies = row != nullptr && (row->rigs & rig_bit(candidate.file)) != 0;
  if (!applies || row->kind == ParameterKind::kText) return nullptr;
  candidate.file.parameters.parameters.push_back({.row = row, .values = {0.0}, .origin = Origin::kSet});
  return &candidate.file.parameters.parameters.back();
}

std::string linear_unit(std::string_view unit, std::string_view key, std::string_view name) {
  std::string out(unit);
  if (key == name) return out;
  if (const std::size_t at = out.find("N m"); at != std::string::npos) out.replace(at, 3, "N");
  if (const std::size_t at = out.find("rad"); at != std::string::npos) out.replace(at, 3, "m");
  return out;
}

// A base number that is friction in proportion to speed; the others are plain.
ParamTrait base_trait(std::string_view path) {
  for (const DriveParamPath& p : drive_param_paths()) {
    const bool damping = p.value == &DriveParams<double>::viscous_friction_Nm_s_per_rad;
    if (damping && (p.path == path || p.linear_path == path)) return ParamTrait::kDamping;
  }
  return ParamTrait::kPlain;
}

std::optional<Unknown> base_unknown(const Parameter& p) {
  const ParameterRow& row = *p.row;
  const bool number = row.kind == ParameterKind::kNumber && p.values.size() == 1;
  if (!number || is_effects_row(row) || !p.tolerance || *p.tolerance <= 0.0) return std::nullopt;
  // Of the value: in place of a bound that is excluded (R > 0).
  constexpr double kLeastShare = 1e-4;  // numerical: a choice
  const double believed = p.believed();
  const double lower = row.above_lower ? std::max(row.lower, kLeastShare * believed) : row.lower;
  Unknown u{.path = parameter_path(row), .unit = std::string(row.unit)};
  u.trait = base_trait(u.path);
  u.start = p.value();
  u.prior_mean = believed;
  u.lower = std::min({lower, believed, u.start});
  u.upper = row.upper;
  u.prior_sigma =
      *p.tolerance * std::abs(believed);  // relative tolerance of a zero value: sigma 0, a flat prior
  u.prior_form = prior_form(*p.tolerance, !row.above_lower && u.lower <= 0.0);
  u.scale = u.prior_sigma > 0.0 ? u.prior_sigma : 1e-3 * std::min(row.upper, 1.0);
  return u;
}

// A strength that a file gives without a tolerance is known exactly; not one that was fitted, nor one that the
// program has found (it has an owner), nor one at neutral, which the file leaves out.
bool is_stated(const EffectUse& use, std::size_t i) {
  const EffectParam& row = use.entry->info->params[i];
  const bool from_file = use.owner == nullptr && i < use.tolerances.size() && !use.tolerances[i];
  return from_file && use.fitted(i) == nullptr && row.role != ParamRole::kShape &&
         use.values[i] != row.neutral;
}

// The shapes of an exactly known strength are known exactly too, unless they have a tolerance of their own.
bool is_known_shape(const EffectUse& use, std::size_t i) {
  const std::span<const EffectParam> rows = use.entry->info->params;
  if (rows[i].role != ParamRole::kShape || i >= use.tolerances.size() || use.tolerances[i] ||
      use.fitted(i) != nullptr)
    return false;
  std::size_t strength = i;
  while (strength > 0 && rows[strength].role == ParamRole::kShape) --strength;
  return is_stated(use, strength);
}

std::optional<Unknown> effect_unknown(const EffectUse& use, std::size_t i, const Candidate& candidate) {
  const bool linear = candidate.file.linear;
  const EffectParam& row = use.entry->info->params[i];
  const std::span<const EffectParam> rows = use.entry->info->params;
  constexpr double kNotGiven = -1.0;  // a marker: tolerances are not negative
  const double tolerance = i < use.tolerances.size() ? use.tolerances[i].value_or(kNotGiven) : kNotGiven;
  const ParamRange range = param_range(row, candidate);
  if (tolerance == 0.0 || is_stated(use, i) || is_known_shape(use, i)) return std::nullopt;
  if (!(range.upper > range.lower) || is_whole(row)) return std::nullopt;
  if (row.role == ParamRole::kDetail && use.values[i] == row.neutral) return std::nullopt;
  const bool of_absent_detail = row.role == ParamRole::kShape && i > 0 &&
                                rows[i - 1].role == ParamRole::kDetail &&
                                use.values[i - 1] == rows[i - 1].neutral;
  if (of_absent_detail) return std::nullopt;
  const std::string key = param_key(row, linear);
  const double size = range.upper == row.upper || row.upper == 0.0 ? 1.0 : range.upper / row.upper;
  Unknown u{.path = effect_name(use) + "." + key, .unit = linear_unit(row.unit, key, row.name)};
  u.row = static_cast<int>(i);
  u.trait = row.trait;
  u.start = use.values[i];
  u.lower = range.lower;
  u.upper = range.upper;
  const FittedNumber* fit = use.fitted(i);
  const double believed = fit != nullptr && fit->believed ? *fit->believed : use.values[i];
  const bool absolute = fit != nullptr && fit->believed && fit->believed_sigma;
  u.prior_mean = row.role == ParamRole::kShape || absolute ? believed : row.neutral;
  u.prior_sigma = absolute ? *fit->believed_sigma : range.prior_scale;
  if (tolerance > 0.0 && believed != 0.0) {
    u.prior_mean = believed;
    u.prior_sigma = tolerance * std::abs(believed);
    if (believed > 0.0) u.prior_form = prior_form(tolerance, row.role != ParamRole::kShape);
  }
  double usual = row.typical;
  if (row.start_for != nullptr) {
    // Where the typical value depends on the drive, the prior's width scales with it (DECISIONS 49).
    const DriveParams<double> drive = drive_of(candidate);
    usual = start_of(row, &drive);
    if (row.typical != 0.0 && tolerance <= 0.0 && !absolute) u.prior_sigma *= std::abs(usual / row.typical);
  }
  const double typical = row.role == ParamRole::kShape ? usual : usual - row.neutral;
  u.scale = std::abs(typical) * size;
  if (u.scale == 0.0)
    u.scale = range.prior_scale > 0.0 ? range.prior_scale : 0.1 * (range.upper - range.lower);
  return u;
}

}  // namespace

ParamRange param_range(const EffectParam& row, const Candidate& of) {
  return param_range(row, of.file.linear, of.torque_scale);
}

Candidate candidate_of(ModelFile file, std::vector<EffectUse> effects) {
  return {.file = std::move(file), .effects = std::move(effects)};
}

Candidate candidate_of(const ModelFile& robot) {
  Candidate candidate{.file = robot, .effects = {}};
  const Parameter* coulomb = robot.parameters.find("effects.coulomb_friction.torque_Nm");
  if (coulomb != nullptr && coulomb->origin != Origin::kDefault) {
    EffectUse use = neutral_use(*find_effect(kCoulomb));
    use.values.front() = coulomb->value();
    use.tolerances = {coulomb->tolerance};
    use.notes = {{.source = coulomb->source, .fitted = coulomb->fitted}};
    candidate.effects.push_back(std::move(use));
  }
  if (robot.robot && robot.robot->effects != nullptr) {
    const auto& uses = *robot.robot->effects;
    candidate.effects.insert(candidate.effects.end(), uses.begin(), uses.end());
  }
  return candidate;
}

std::string effect_name(const EffectUse& use) {
  std::string id(use.entry->info->id);
  if (use.name.empty() || use.name == id) return id;
  return use.name.starts_with(id + ".") ? use.name : id + "." + use.name;
}

std::vector<Unknown> unknowns_of(const Candidate& candidate) {
  std::vector<Unknown> unknowns;
  for (const Parameter& p : candidate.file.parameters.parameters) {
    if (auto u = base_unknown(p)) unknowns.push_back(std::move(*u));
  }
  for (std::size_t e = 0; e < candidate.effects.size(); ++e) {
    const EffectUse& use = candidate.effects[e];
    for (std::size_t i = 0; i < use.values.size(); ++i) {
      auto u = effect_unknown(use, i, candidate);
      if (!u) continue;
      u->effect = static_cast<int>(e);
      unknowns.push_back(std::move(*u));
    }
  }
  return unknowns;
}

Candidate with_values(const Candidate& candidate, std::span<const Unknown> unknowns,
                      std::span<const double> values) {
  Candidate out = candidate;
  for (std::size_t n = 0; n < unknowns.size(); ++n) {
    const Unknown& u = unknowns[n];
    if (u.effect >= 0) {
      out.effects[static_cast<std::size_t>(u.effect)].values[static_cast<std::size_t>(u.row)] = values[n];
    } else if (Parameter* p = out.file.parameters.find(u.path)) {
      std::fill(p->values.begin(), p->values.end(), values[n]);
      p->origin = Origin::kSet;
    }
  }
  refresh(out);
  return out;
}

std::optional<double> value_at(const Candidate& candidate, std::string_view path) {
  const auto [effect, row] = effect_row(candidate, path);
  if (effect >= 0) {
    return candidate.effects[static_cast<std::size_t>(effect)].values[static_cast<std::size_t>(row)];
  }
  const Parameter* p = candidate.file.parameters.find(path);
  if (p == nullptr || p->values.empty()) return std::nullopt;
  return p->value();
}

std::string set_value(Candidate& candidate, std::string_view path, double value) {
  const auto [effect, row] = effect_row(candidate, path);
  if (effect >= 0) {
    EffectUse& use = candidate.effects[static_cast<std::size_t>(effect)];
    const EffectParam& param = use.entry->info->params[static_cast<std::size_t>(row)];
    const ParamRange range = param_range(param, candidate.file.linear, kStrongestDrive);
    if (!(value >= range.lower && value <= range.upper)) {
      return fmt::format("{} = {:g}: allowed is {}", path, value,
                         allowed_range(param, candidate.file.linear));
    }
    use.values[static_cast<std::size_t>(row)] = value;
    refresh(candidate);
    return "";
  }
  const std::size_t before = candidate.file.parameters.parameters.size();
  if (table_parameter(candidate, path) == nullptr) return fmt::format("{}: there is no such parameter", path);
  std::string wrong = candidate.file.parameters.set(path, value);
  if (!wrong.empty()) candidate.file.parameters.parameters.resize(before);
  if (wrong.empty()) refresh(candidate);
  return wrong;
}

Candidate with_known(const Candidate& candidate, std::span<const std::pair<std::string, double>> known) {
  Candidate out = candidate;
  for (const auto& [path, value] : known) set_value(out, path, value);
  return out;
}

std::size_t wheels_of(const Candidate& candidate) {
  return candidate.file.robot ? candidate.file.robot->wheels : kAllWheels;
}

EffectUse neutral_use(const EffectEntry& entry, const Candidate& of) {
  const DriveParams<double> drive = drive_of(of);
  return neutral_use(entry, &drive, wheels_of(of));
}

Candidate with_effect(const Candidate& candidate, const EffectEntry& entry) {
  Candidate out = candidate;
  out.effects.push_back(neutral_use(entry, candidate));
  return out;
}

Candidate with_effect(const Candidate& candidate, EffectUse use) {
  for (std::size_t i = 0; i < use.values.size(); ++i) {
    const EffectParam& row = use.entry->info->params[i];
    if (row.role != ParamRole::kShape) use.values[i] = row.neutral;
  }
  Candidate out = candidate;
  out.effects.push_back(std::move(use));
  return out;
}

const EffectUse* use_of(const Candidate& candidate, std::string_view id) {
  const auto at = std::ranges::find_if(candidate.effects,
                                       [&](const EffectUse& use) { return use.entry->info->id == id; });
  return at == candidate.effects.end() ? nullptr : &*at;
}

Candidate without_effect(const Candidate& candidate, std::string_view name) {
  Candidate out = candidate;
  std::erase_if(out.effects, [&](const EffectUse& use) { return effect_name(use) == name; });
  refresh(out);
  return out;
}

DriveParams<double> drive_of(const Candidate& candidate) {
  return drive_params_of(candidate.file.parameters);
}

RobotModel robot_of(const Candidate& candidate) {
  RobotModel robot = robot_model_of(candidate.file.parameters);
  if (candidate.file.robot) robot.name = candidate.file.robot->name;
  robot.motor.name = candidate.file.motor.name;
  robot.motor.coulomb_friction_Nm = coulomb_of(candidate);
  std::vector<EffectUse> others;
  for (const EffectUse& use : candidate.effects) {
    if (use.entry->info->id != kCoulomb) others.push_back(use);
  }
  robot.effects =
      others.empty() ? nullptr : std::make_shared<const std::vector<EffectUse>>(std::move(others));
  return robot;
}

void note_fit(Candidate& candidate, std::string_view path, const FittedNumber& fit) {
  const auto [effect, row] = effect_row(candidate, path);
  if (effect < 0) {
    if (Parameter* p = candidate.file.parameters.find(path)) p->fitted = fit;
    return;
  }
  EffectUse& use = candidate.effects[static_cast<std::size_t>(effect)];
  const auto i = static_cast<std::size_t>(row);
  use.notes.resize(use.values.size());
  use.notes[i].fitted = fit;
  const bool toleranced = i < use.tolerances.size() && use.tolerances[i];
  const bool of_the_page = use.notes[i].source.empty() && fit.believed_sigma && !toleranced;
  if (of_the_page) use.notes[i].source = "usual size";
}

std::string candidate_text(const Candidate& candidate) {
  constexpr double kFound =
      1.0;  // relative 1-sigma of a found parameter: wide, so that it is a start; a choice
  std::vector<EffectUse> effects = candidate.effects;
  for (EffectUse& use : effects) {
    if (!use.tolerances.empty() || use.owner != nullptr) continue;
    use.tolerances.resize(use.values.size());
    for (std::size_t i = 0; i < use.values.size(); ++i) {
      const EffectParam& row = use.entry->info->params[i];
      const bool found = row.role != ParamRole::kShape && use.values[i] != row.neutral;
      if (found && use.fitted(i) == nullptr) use.tolerances[i] = kFound;
    }
  }
  return model_text(candidate.file, effects);
}

}  // namespace omnihil
