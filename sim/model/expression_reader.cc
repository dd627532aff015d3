// [effects.expression.NAME] of a model file.
#include "sim/model/expression_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "sim/model/fitted_reader.h"
#include "sim/model/params.h"

namespace omnihil {
namespace {

bool is_name(std::string_view name) {
  return !name.empty() && std::all_of(name.begin(), name.end(), [](unsigned char c) {
    return (std::isalnum(c) != 0 && c < 128) || c == '_' || c == '-';
  });
}

class ExpressionReader {
 public:
  ExpressionReader(const ModelDocument& document, bool linear, std::vector<ModelProblem>& problems)
      : document_(document), linear_(linear), problems_(problems) {}

  // Empty when something is wrong.
  std::optional<EffectUse> read(const std::string& name, const toml::table& table) {
    const std::size_t before = problems_.size();
    path_ = "effects.expression." + name;
    text_ = {.name = name, .adds_to = {}, .formula = {}, .params = {}, .linear = linear_};
    beliefs_.clear();
    share_ = nullptr;
    read_text(table, "adds_to", text_.adds_to);
    read_text(table, "formula", text_.formula);
    read_params(table);
    if (text_.adds_to.empty() || text_.formula.empty()) return std::nullopt;
    std::vector<FormulaFault> faults;
    const auto expression = make_expression(text_, faults);
    for (const FormulaFault& f : faults) add_fault(table, f);
    if (expression == nullptr) return std::nullopt;
    check_use(table, *expression);
    EffectUse use = use_of_expression(expression);
    use.notes.resize(use.values.size());
    for (std::size_t i = 0; i < beliefs_.size(); ++i) {
      use.tolerances[i] = beliefs_[i].tolerance;
      use.notes[i] = std::move(beliefs_[i].note);
    }
    if (share_ != nullptr) read_share(table, *share_, expression->shared, use);
    if (problems_.size() > before) return std::nullopt;
    return use;
  }

  void wrong(const toml::node& node, const std::string& path, std::string what, std::string allowed) {
    problems_.push_back(problem_at(document_, node.source(), path, document_.written(node), std::move(what),
                                   std::move(allowed)));
  }
  void wrong_key(const toml::key& key, const std::string& path, std::string what, std::string allowed) {
    problems_.push_back(problem_at(document_, key.source(), path, "", std::move(what), std::move(allowed)));
  }

 private:
  void read_text(const toml::table& table, std::string_view key, std::string& text) {
    const toml::node* node = table.get(key);
    const std::string path = fmt::format("{}.{}", path_, key);
    if (node == nullptr) {
      problems_.push_back(problem_at(document_, table.source(), path, "", "is missing",
                                     "write adds_to = \"torque_Nm\" and formula = \"…\""));
    } else if (!node->is_string() || node->value<std::string>()->empty()) {
      wrong(*node, path, fmt::format("is {}", kind_of(*node)), "a text is needed");
    } else {
      text = *node->value<std::string>();
    }
  }

  void read_params(const toml::table& table) {
    for (const auto& [key, node] : table) {
      const std::string name(key.str());
      if (name == "adds_to" || name == "formula") continue;
      const std::string path = fmt::format("{}.{}", path_, name);
      if (!is_formula_name(name)) {
        wrong_key(key, path, "cannot be a parameter's name", "letters, digits, _; no function's name");
      } else if (!node.is_table()) {
        wrong(node, path, fmt::format("is {}", kind_of(node)),
              "write { value = …, lower = …, upper = …, unit = \"…\" }");
      } else if (name == "share" && text_.formula.find("share") == std::string::npos) {
        share_ = node.as_table();
      } else {
        read_param(name, path, *node.as_table());
      }
    }
  }

  void read_param(const std::string& name, const std::string& path, const toml::table& table) {
    ExpressionParam p;
    p.name = name;
    NumberBelief belief;
    const bool value = read_number(table, "value", path, p.value);
    const bool lower = read_number(table, "lower", path, p.lower);
    const bool upper = read_number(table, "upper", path, p.upper);
    for (const auto& [key, node] : table) {
      const std::string part(key.str()), full = fmt::format("{}.{}", path, part);
      if (part == "value" || part == "lower" || part == "upper") continue;
      if (part == "unit" && node.is_string()) {
        p.unit = *node.value<std::string>();
      } else if (part == "tolerance" && node.is_number() && *node.value<double>() >= 0.0 &&
                 *node.value<double>() <= kLargestTolerance) {
        belief.tolerance = node.value<double>();
      } else if (part == "source" && node.is_string()) {
        belief.note.source = *node.value<std::string>();
      } else if (!is_fit_key(part)) {
        wrong_key(key, full, "is not usable",
                  "allowed: value, lower, upper, unit (text), tolerance (0 to 10), source (text)");
      }
    }
    if (lower && upper && !(p.lower < p.upper)) {
      wrong(table, path, "has a lower bound that is not below the upper one", "lower < upper");
    } else if (value && lower && upper && !(p.value >= p.lower && p.value <= p.upper)) {
      wrong(*table.get("value"), path, "is out of range",
            fmt::format("allowed: {:g} to {:g}", p.lower, p.upper));
    }
    const BeliefRule rule{
        .range = fmt::format("{:g} to {:g}", p.lower, p.upper),
        .within = [&](double believed) { return believed >= p.lower && believed <= p.upper; },
        .absolute_sigma = true};
    read_fitted(document_, path, table, rule, belief, problems_);
    text_.params.push_back(p);
    beliefs_.push_back(std::move(belief));
  }

  bool read_number(const toml::table& table, std::string_view key, const std::string& path, double& number) {
    const toml::node* node = table.get(key);
    if (node == nullptr) {
      wrong(table, path, fmt::format("has no {}", key),
            "write { value = …, lower = …, upper = …, unit = \"…\" }");
      return false;
    }
    if (!node->is_number() || !std::isfinite(*node->value<double>())) {
      wrong(*node, fmt::format("{}.{}", path, key), "is not a number", "a number is needed");
      return false;
    }
    number = *node->value<double>();
    return true;
  }

  void read_share(const toml::table& section, const toml::table& table, bool known, EffectUse& use) {
    const toml::node* value = table.get("value");
    if (!known) {
      wrong(*section.get("share"), path_ + ".share", "is not used in the formula", "remove it");
    } else if (value == nullptr || !value->is_number() || *value->value<double>() < 0.0 ||
               *value->value<double>() > 1.0) {
      wrong(table, path_ + ".share", "is not usable", "allowed: { value = 0 to 1 }");
    } else {
      use.values.back() = *value->value<double>();
      NumberBelief belief;
      const BeliefRule rule{.range = "0 to 1",
                            .within = [](double believed) { return believed >= 0.0 && believed <= 1.0; },
                            .absolute_sigma = true};
      read_fitted(document_, path_ + ".share", table, rule, belief, problems_);
      use.tolerances.back() = belief.tolerance;
      use.notes.back() = std::move(belief.note);
    }
  }

  // Where in the file a character of the formula stands: behind the quote, on one line.
  void add_fault(const toml::table& table, const FormulaFault& f) {
    const bool of_formula = f.position >= 0;
    const std::string key = of_formula ? "formula" : "adds_to";
    const toml::node& node = *table.get(key);
    std::string what = f.what;
    if (of_formula) {
      what = fmt::format("position {}{}: {}", f.position + 1,
                         f.found.empty() ? "" : fmt::format(", \"{}\"", f.found), f.what);
    }
    ModelProblem p = problem_at(document_, node.source(), fmt::format("{}.{}", path_, key),
                                document_.written(node), what, f.allowed);
    const bool plain =
        !document_.written(node).starts_with("\"\"\"") && !document_.written(node).starts_with("'''");
    if (of_formula && plain) p.column += 1 + f.position;
    problems_.push_back(std::move(p));
  }

  void check_use(const toml::table& table, const Expression& e) {
    const auto used = e.formula.variables();
    for (std::size_t i = 0; i < e.text.params.size(); ++i) {
      if (std::find(used.begin(), used.end(), static_cast<int>(i)) != used.end()) continue;
      const std::string& name = e.text.params[i].name;
      wrong(*table.get(name), fmt::format("{}.{}", path_, name), "is not used in the formula", "remove it");
    }
  }

  const ModelDocument& document_;
  bool linear_;
  std::vector<ModelProblem>& problems_;
  std::string path_;
  ExpressionText text_;
  std::vector<NumberBelief> beliefs_;
  const toml::table* share_ = nullptr;
};

}  // namespace

void read_expressions(const ModelDocument& document, const toml::node& section, bool linear,
                      std::vector<EffectUse>& uses, std::vector<ModelProblem>& problems) {
  ExpressionReader reader(document, linear, problems);
  if (!section.is_table()) {
    return reader.wrong(section, "effects.expression", "is not a section", "write [effects.expression.NAME]");
  }
  for (const auto& [key, node] : *section.as_table()) {
    const std::string name(key.str()), path = "effects.expression." + name;
    if (!node.is_table() || (name == "adds_to" || name == "formula")) {
      reader.wrong_key(key, path, "stands outside a named formula",
                       "write [effects.expression.NAME] above it");
    } else if (!is_name(name)) {
      reader.wrong_key(key, path, "cannot be a formula's name", "letters, digits, _ and -");
    } else if (auto use = reader.read(name, *node.as_table())) {
      uses.push_back(std::move(*use));
    }
  }
}

}  // namespace omnihil
