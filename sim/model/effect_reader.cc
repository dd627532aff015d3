#include "sim/model/effect_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "sim/law/effect_registry.h"
#include "sim/model/expression_reader.h"
#include "sim/model/fitted_reader.h"

namespace omnihil {
namespace {

std::string hint(std::string_view near) {
  return near.empty() ? "" : fmt::format("did you mean \"{}\"?", near);
}

struct FoundKey {
  std::size_t row = 0;
  std::string wrong = "";  // what is wrong with the key; empty: nothing
  std::string allowed = "";
};

FoundKey find_key(const EffectInfo& info, std::string_view key, const EffectContext& context) {
  const std::span<const EffectParam> rows = rows_of(info, context.wheels);
  std::vector<std::string> keys;
  for (const EffectParam& row : rows) keys.push_back(param_key(row, context.linear));
  if (const auto at = std::find(keys.begin(), keys.end(), key); at != keys.end())
    return {.row = static_cast<std::size_t>(at - keys.begin())};
  std::string allowed;
  for (std::size_t i = 0; i < keys.size() && i < 8; ++i) allowed += (i > 0 ? ", " : "allowed: ") + keys[i];
  if (keys.size() > 8) allowed += " …";
  for (const EffectParam& row : info.params.subspan(rows.size())) {
    if (param_key(row, context.linear) == key)
      return {.wrong = fmt::format("is of wheel {}, and the robot has {}", row.wheel, context.wheels),
              .allowed = allowed};
  }
  const std::string near =
      hint(nearest_spelling(key, std::vector<std::string_view>(keys.begin(), keys.end())));
  return {.wrong = fmt::format("{} has no such parameter", info.id),
          .allowed = near.empty() ? allowed : near};
}

std::string unknown_effect_hint(std::string_view id) {
  const std::string near = hint(nearest_effect(id));
  return near.empty() ? "`omnihil effects` lists them" : near;
}

bool in_range(const EffectParam& row, double value, bool linear) {
  const ParamRange range = param_range(row, linear, kStrongestDrive);
  return std::isfinite(value) && value >= range.lower && value <= range.upper;
}

class SectionReader {
 public:
  SectionReader(const ModelDocument& document, const EffectContext& context,
                std::vector<ModelProblem>& problems)
      : document_(document), context_(context), problems_(problems) {}

  EffectUse read(const EffectEntry& entry, const toml::table& table) {
    EffectUse use = neutral_use(entry, context_.drive, context_.wheels);
    use.tolerances.resize(use.values.size());
    use.notes.resize(use.values.size());
    for (const auto& [key, node] : table) {
      const std::string name(key.str());
      const std::string path = fmt::format("effects.{}.{}", entry.info->id, name);
      const FoundKey found = find_key(*entry.info, name, context_);
      if (!found.wrong.empty()) {
        add(key.source(), path, "", found.wrong, found.allowed);
        continue;
      }
      const std::size_t i = found.row;
      NumberBelief belief;
      read_value(entry.info->params[i], path, node, use.values[i], belief);
      use.tolerances[i] = belief.tolerance;
      use.notes[i] = std::move(belief.note);
    }
    return use;
  }

  void add(const toml::source_region& where, std::string key, std::string value, std::string what,
           std::string allowed) {
    problems_.push_back(
        problem_at(document_, where, std::move(key), std::move(value), std::move(what), std::move(allowed)));
  }

 private:
  void wrong(const toml::node& node, const std::string& path, std::string what, std::string allowed) {
    add(node.source(), path, document_.written(node), std::move(what), std::move(allowed));
  }

  void read_value(const EffectParam& row, const std::string& path, const toml::node& node, double& value,
                  NumberBelief& belief) {
    const toml::table* table = node.as_table();
    if (table == nullptr) return read_number(row, path, node, value);
    for (const auto& [key, part] : *table) {
      if (key.str() == "value") {
        read_number(row, path, part, value);
      } else if (key.str() == "tolerance") {
        const auto number = part.is_number() ? part.value<double>() : std::nullopt;
        if (number && *number >= 0.0 && *number <= kLargestTolerance) {
          belief.tolerance = number;
        } else {
          wrong(part, path + ".tolerance", "is not usable",
                "allowed: 0 to 10, relative to the value (1-sigma)");
        }
      } else if (key.str() == "source") {
        if (!part.is_string()) wrong(part, path + ".source", "is not a text", "a text is needed");
        belief.note.source = part.value_or(std::string());
      } else if (!is_fit_key(key.str())) {
        add(key.source(), fmt::format("{}.{}", path, std::string_view(key.str())), "",
            "unknown key of a number",
            "allowed: value, tolerance, source; of a fit also sigma, data, date, believed");
      }
    }
    if (table->get("value") == nullptr)
      wrong(node, path, "has no value", "write { value = …, tolerance = … }");
    const BeliefRule rule{.range = allowed_range(row, context_.linear),
                          .within = [&](double believed) { return in_range(row, believed, context_.linear); },
                          .absolute_sigma = true};
    read_fitted(document_, path, *table, rule, belief, problems_);
  }

  void read_number(const EffectParam& row, const std::string& path, const toml::node& node, double& value) {
    if (!node.is_number()) {
      return wrong(node, path, fmt::format("is {}", kind_of(node)),
                   "a number is needed: " + allowed_range(row, context_.linear));
    }
    const double number = *node.value<double>();
    if (!in_range(row, number, context_.linear))
      return wrong(node, path, "is out of range", "allowed: " + allowed_range(row, context_.linear));
    value = number;
  }

  const ModelDocument& document_;
  const EffectContext& context_;
  std::vector<ModelProblem>& problems_;
};

}  // namespace

std::vector<EffectUse> read_effects(const ModelDocument& document, const EffectContext& context,
                                    std::vector<ModelProblem>& problems) {
  std::vector<EffectUse> uses;
  const toml::node* effects = document.table.get("effects");
  if (effects == nullptr || !effects->is_table()) return uses;  // a wrong type is the model reader's to say
  SectionReader reader(document, context, problems);
  for (const auto& [key, node] : *effects->as_table()) {
    const std::string id(key.str());
    const EffectEntry* entry = find_effect(id);
    if (entry != nullptr && is_formula(*entry->info)) {
      read_expressions(document, node, context.linear, uses, problems);
    } else if (entry == nullptr) {
      reader.add(key.source(), "effects." + id, "", "there is no such effect", unknown_effect_hint(id));
    } else if (const toml::table* table = node.as_table()) {
      uses.push_back(reader.read(*entry, *table));
    } else {
      reader.add(node.source(), "effects." + id, document.written(node), "is not a section",
                 fmt::format("write [effects.{}] and its parameters below it", id));
    }
  }
  return uses;
}

std::string add_override(std::string_view text, const EffectContext& context, std::vector<EffectUse>& uses) {
  const std::size_t equals = text.find('=');
  const std::string_view path = text.substr(0, equals);
  const std::size_t dot = path.find('.');
  const std::string_view id = path.substr(0, dot);
  const EffectEntry* entry = find_effect(id);
  if (entry != nullptr && is_formula(*entry->info) && std::count(path.begin(), path.end(), '.') == 2) {
    return override_expression(text, uses);
  }
  if (entry == nullptr) return fmt::format("{}: there is no such effect; {}", id, unknown_effect_hint(id));
  const bool whole = equals == std::string_view::npos && dot == std::string_view::npos;
  if (!whole && (equals == std::string_view::npos || dot == std::string_view::npos)) {
    return fmt::format("{}: write ID.parameter=value, or ID for its typical size", text);
  }
  auto use = std::find_if(uses.begin(), uses.end(), [&](const EffectUse& u) { return u.entry == entry; });
  if (whole) {
    EffectUse typical = typical_use(*entry, context.drive, context.wheels);
    if (use == uses.end()) {
      uses.push_back(std::move(typical));
    } else {
      *use = std::move(typical);
    }
    return "";
  }
  const std::string_view key = path.substr(dot + 1);
  const FoundKey found = find_key(*entry->info, key, context);
  if (!found.wrong.empty()) return fmt::format("{}: {}; {}", path, found.wrong, found.allowed);
  const EffectParam& row = entry->info->params[found.row];
  const std::string_view number = text.substr(equals + 1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), value);
  if (error != std::errc() || end != number.data() + number.size()) {
    return fmt::format("{} = {}: is not a number; allowed: {}", path, number,
                       allowed_range(row, context.linear));
  }
  if (!in_range(row, value, context.linear))
    return fmt::format("{} = {}: is out of range; allowed: {}", path, number,
                       allowed_range(row, context.linear));
  if (use == uses.end()) use = uses.insert(uses.end(), neutral_use(*entry, context.drive, context.wheels));
  use->values[found.row] = value;
  if (found.row < use->notes.size()) use->notes[found.row] = {};
  return "";
}

std::string write_effects(std::span<const EffectUse> uses, bool linear) {
  std::string out;
  for (const EffectUse& use : uses) {
    if (expression_of(use) != nullptr) {
      out += write_expression(use);
      continue;
    }
    out += fmt::format("\n[effects.{}]\n", use.entry->info->id);
    for (std::size_t i = 0; i < use.values.size(); ++i) {
      const EffectParam& row = use.entry->info->params[i];
      const bool default_detail = row.role == ParamRole::kDetail && use.values[i] == row.neutral;
      const bool lone_shape = i > 0 && row.role == ParamRole::kShape &&
                              use.entry->info->params[i - 1].role == ParamRole::kDetail &&
                              use.values[i - 1] == use.entry->info->params[i - 1].neutral;
      if (default_detail || lone_shape) continue;
      const std::string more = annotations_text(i < use.tolerances.size() ? use.tolerances[i] : std::nullopt,
                                                i < use.notes.size() ? use.notes[i] : NumberNote{});
      out += more.empty()
                 ? fmt::format("{} = {}\n", param_key(row, linear), use.values[i])
                 : fmt::format("{} = {{ value = {}{} }}\n", param_key(row, linear), use.values[i], more);
    }
  }
  return out;
}

}  // namespace omnihil
