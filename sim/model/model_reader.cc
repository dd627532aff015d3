#include "sim/model/model_reader.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "sim/model/fitted_reader.h"

namespace omnihil {
namespace {

std::string join(const std::string& section, std::string_view key) {
  return section.empty() ? std::string(key) : fmt::format("{}.{}", section, key);
}

// What may stand in `section`: its keys and its sub-sections.
std::vector<std::string_view> names_in(std::string_view section) {
  std::vector<std::string_view> names;
  for (const ParameterRow& row : model_rows()) {
    std::string_view name;
    if (row.section == section) {
      name = row.key;
    } else if (section.empty() || (row.section.starts_with(section) && row.section.size() > section.size() &&
                                   row.section[section.size()] == '.')) {
      name = row.section.substr(section.empty() ? 0 : section.size() + 1);
      name = name.substr(0, name.find('.'));
    }
    if (!name.empty() && std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }
  return names;
}

std::string hint(std::string_view word, std::span<const std::string_view> candidates) {
  const std::string_view near = nearest_spelling(word, candidates);
  return near.empty() ? "" : fmt::format("did you mean \"{}\"?", near);
}

}  // namespace

ModelReader::ModelReader(const ModelDocument& document, std::vector<ModelProblem>& problems)
    : document_(document), problems_(problems) {
  read_rig();
}

void ModelReader::wrong(const toml::node& node, const std::string& key, std::string what,
                        std::string allowed) {
  problems_.push_back(problem_at(document_, node.source(), key, document_.written(node), std::move(what),
                                 std::move(allowed)));
}

void ModelReader::read_rig() {
  const toml::node* rig = document_.table.get("rig");
  if (rig == nullptr || !rig->is_string()) return;  // missing or of a wrong type: said with the other keys
  const std::string name = rig->as_string()->get();
  const toml::node* linear = document_.table.get("linear");
  const bool along_a_line = linear != nullptr && linear->is_boolean() && linear->as_boolean()->get();
  if (name == "robot") rig_ = kRigRobot;
  if (name == "axis") rig_ = along_a_line ? kRigLinearAxis : kRigAxis;
  if (name == "motor") rig_ = kRigMotor;
  if (rig_ != 0) return;
  constexpr std::string_view kRigs[] = {"robot", "axis", "motor"};
  const std::string near = hint(name, kRigs);
  wrong(*rig, "rig", "there is no such rig",
        "allowed: \"robot\", \"axis\", \"motor\"" + (near.empty() ? "" : "; " + near));
}

void ModelReader::read(Origin origin) {
  origin_ = origin;
  read_section("", document_.table);
}

toml::source_region ModelReader::section_place(std::string_view section) const {
  const toml::node_view<const toml::node> node = document_.table.at_path(section);
  return node ? node.node()->source() : document_.table.source();
}

void ModelReader::read_section(const std::string& section, const toml::table& table) {
  for (const auto& [key, node] : table) {
    const std::string name(key.str());
    const std::string path = join(section, name);
    if (const ParameterRow* row = find_model_row(section, name)) {
      read_value(*row, key, node);
    } else if (path == "effects" && node.is_table()) {
      read_effects(*node.as_table());
    } else if (is_model_section(path) && node.is_table()) {
      read_section(path, *node.as_table());
    } else if (is_model_section(path)) {
      wrong(node, path, fmt::format("is {}, but this name is a section", kind_of(node)),
            fmt::format("write [{}] and its keys below it", path));
      spoil(path);
    } else {
      unknown_key(section, key, node);
    }
  }
}

void ModelReader::read_effects(const toml::table& table) {
  for (const auto& [key, node] : table) {
    const std::string name(key.str());
    const std::string path = "effects." + name;
    const auto names = effect_names();
    if (std::find(names.begin(), names.end(), name) == names.end()) {
      problems_.push_back(
          problem_at(document_, key.source(), path, "", "there is no such effect", hint(name, names)));
    } else if (!node.is_table()) {
      wrong(node, path, fmt::format("is {}, but an effect is a table of its parameters", kind_of(node)),
            fmt::format("write [{}] and its parameters below it", path));
    } else {
      const bool simulated = is_model_section(path);
      effects_.push_back({.id = name, .simulated = simulated});
      if (simulated) read_section(path, *node.as_table());
    }
  }
}

// What stands under a name that is wrong is not missing as well.
void ModelReader::spoil(std::string_view path) {
  for (const ParameterRow& row : model_rows()) {
    if (row.section == path || parameter_path(row) == path) spoilt_[&row] = true;
  }
}

void ModelReader::unknown_key(const std::string& section, const toml::key& key, const toml::node& node) {
  const std::string name(key.str());
  const std::vector<std::string_view> names = names_in(section);
  const std::string_view near = nearest_spelling(name, names);
  std::string allowed;
  if (!near.empty()) {
    spoil(join(section, near));
    allowed = fmt::format("did you mean \"{}\"?", near);
  }
  for (const ParameterRow& row : model_rows()) {  // gear_ratio is the ratio of [gear]
    if (allowed.empty() && fmt::format("{}_{}", row.section, row.key) == name)
      allowed = fmt::format("did you mean \"{}\" in [{}]?", row.key, row.section);
  }
  for (const ParameterRow& row : model_rows()) {  // right key, wrong section
    if (!allowed.empty()) break;
    if (row.key != name) continue;
    allowed = row.section.empty() ? "it belongs at the top of the file"
                                  : fmt::format("it belongs in [{}]", row.section);
  }
  if (allowed.empty()) allowed = fmt::format("allowed here: {}", fmt::join(names, ", "));
  const bool is_section = node.is_table() && !node.as_table()->is_inline();
  problems_.push_back(problem_at(document_, key.source(), join(section, name), "",
                                 is_section ? "unknown section" : "unknown key", allowed));
}

void ModelReader::read_value(const ParameterRow& row, const toml::key& key, const toml::node& node) {
  const std::string path = parameter_path(row);
  if (rig_ != 0 && (row.rigs & rig_) == 0) {
    problems_.push_back(problem_at(document_, key.source(), path, "",
                                   fmt::format("does not apply to rig {}", rig_names(rig_)),
                                   fmt::format("only to rig {}", rig_names(row.rigs))));
    return;
  }
  Parameter out{.row = &row, .origin = origin_};
  out.line = static_cast<int>(node.source().begin.line);
  out.column = static_cast<int>(node.source().begin.column);
  const toml::node* value = &node;
  bool good = true;
  const bool numeric = !is_text(row) && row.kind != ParameterKind::kTruth;
  if (numeric && node.is_table()) {
    const std::size_t before = problems_.size();
    const toml::table& table = *node.as_table();
    read_annotated(row, table);
    value = table.get("value");
    if (const toml::node* t = table.get("tolerance")) read_tolerance(row, *t, out);
    if (const toml::node* s = table.get("source"); s != nullptr && s->is_string())
      out.source = s->as_string()->get();
    if (row.kind == ParameterKind::kNumber) read_fit(row, table, out);
    good = problems_.size() == before;
  }
  if (value != nullptr)
    good = (numeric ? read_numbers(row, *value, out) : read_text(row, *value, out)) && good;
  if (good) {
    values_[&row] = std::move(out);
  } else {
    spoilt_[&row] = true;
  }
}

// The keys of { value, tolerance, source }, without their contents.
void ModelReader::read_annotated(const ParameterRow& row, const toml::table& table) {
  constexpr std::string_view kKeys[] = {"value", "tolerance", "source", "believed"};
  const std::string path = parameter_path(row);
  for (const auto& [key, node] : table) {
    const std::string name(key.str());
    if (row.kind == ParameterKind::kNumber && is_fit_key(name)) continue;  // read_fit
    if (name == "believed" || std::find(std::begin(kKeys), std::end(kKeys), name) == std::end(kKeys)) {
      const std::string near = hint(name, kKeys);
      problems_.push_back(problem_at(document_, key.source(), path + "." + name, "",
                                     "unknown key of a number",
                                     near.empty() ? "allowed: value, tolerance, source; of a fit also "
                                                    "sigma, data, date, believed"
                                                  : near));
    } else if (name == "source" && !node.is_string()) {
      wrong(node, path + ".source", fmt::format("is {}", kind_of(node)), "a text is needed");
    }
  }
  if (table.get("value") == nullptr) {
    wrong(table, path, "has no value", fmt::format("write {{ value = …, tolerance = …, source = \"…\" }}"));
  }
}

void ModelReader::read_fit(const ParameterRow& row, const toml::table& table, Parameter& out) {
  const BeliefRule rule{.range = allowed_range(row),
                        .within = [&](double value) { return within_bounds(row, value); },
                        .absolute_sigma = row.section.starts_with("effects.")};
  NumberBelief belief{.tolerance = out.tolerance, .note = {.source = out.source, .fitted = {}}};
  read_fitted(document_, parameter_path(row), table, rule, belief, problems_);
  out.tolerance = belief.tolerance;
  out.source = std::move(belief.note.source);
  out.fitted = std::move(belief.note.fitted);
}

bool ModelReader::read_number(const ParameterRow& row, const toml::node& node, double& out) {
  const std::string path = parameter_path(row);
  if (!node.is_number()) {
    wrong(node, path, fmt::format("is {}", kind_of(node)),
          fmt::format("a number is needed ({}), bare or as {{ value = …, tolerance = …, source = \"…\" }}",
                      allowed_range(row)));
    return false;
  }
  out = *node.value<double>();
  if (row.kind == ParameterKind::kWholeNumber && std::isfinite(out) && out != std::floor(out)) {
    wrong(node, path, "is not a whole number", "allowed: " + allowed_range(row));
    return false;
  }
  if (!within_bounds(row, out)) {
    wrong(node, path, "is out of range", "allowed: " + allowed_range(row));
    return false;
  }
  return true;
}

bool ModelReader::read_numbers(const ParameterRow& row, const toml::node& node, Parameter& out) {
  double number = 0.0;
  if (row.kind != ParameterKind::kWheelNumbers) {
    if (!read_number(row, node, number)) return false;
    out.values = {number};
    return true;
  }
  const toml::array* list = node.as_array();
  if (list == nullptr || list->size() < kMinWheels || list->size() > kMaxWheels) {
    const std::string found =
        list == nullptr ? std::string(kind_of(node)) : fmt::format("a list of {}", list->size());
    wrong(node, parameter_path(row), "is " + found,
          fmt::format("a list of {} to {} numbers is needed, one per wheel, each {}", kMinWheels, kMaxWheels,
                      allowed_range(row)));
    return false;
  }
  bool good = true;
  for (const toml::node& entry : *list) {
    good = read_number(row, entry, number) && good;
    out.values.push_back(number);
  }
  return good;
}

bool ModelReader::read_text(const ParameterRow& row, const toml::node& node, Parameter& out) {
  const std::string path = parameter_path(row);
  if (row.kind == ParameterKind::kTruth) {
    if (!node.is_boolean()) {
      wrong(node, path, fmt::format("is {}", kind_of(node)), "allowed: true, false");
      return false;
    }
    out.values = {node.as_boolean()->get() ? 1.0 : 0.0};
    return true;
  }
  if (!node.is_string()) {
    wrong(node, path, fmt::format("is {}", kind_of(node)), "a text is needed");
    return false;
  }
  out.text = node.as_string()->get();
  if (row.kind == ParameterKind::kChoice) {
    const auto word = std::find(row.choices.begin(), row.choices.end(), out.text);
    if (word == row.choices.end()) {
      const std::string near = hint(out.text, row.choices);
      wrong(node, path, "is not a choice",
            fmt::format("allowed: {}{}", allowed_range(row), near.empty() ? "" : "; " + near));
      return false;
    }
    out.values = {static_cast<double>(word - row.choices.begin())};
  }
  if (row.section.empty() && row.key == "format" && out.text != kModelFormat) {
    wrong(node, path, "is not a format this program reads", fmt::format("allowed: \"{}\"", kModelFormat));
    return false;
  }
  return !(row.section.empty() && row.key == "rig" && rig_ == 0);
}

void ModelReader::read_tolerance(const ParameterRow& row, const toml::node& node, Parameter& out) {
  const std::string path = parameter_path(row) + ".tolerance";
  const std::string allowed =
      fmt::format("allowed: 0 to {:g}, relative to the value (1-sigma; 0.1 is 10 %)", kLargestTolerance);
  if (!node.is_number()) return wrong(node, path, fmt::format("is {}", kind_of(node)), allowed);
  const double tolerance = *node.value<double>();
  if (!(tolerance >= 0.0 && tolerance <= kLargestTolerance))
    return wrong(node, path, "is out of range", allowed);
  out.tolerance = tolerance;
}

}  // namespace omnihil
