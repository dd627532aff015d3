#include "tools/formula_argument.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>

#include "sim/law/expression.h"

namespace omnihil {
namespace {

constexpr double kRange = 1000.0;  // times the start value, either sign

std::string trimmed(std::string_view text) {
  const std::size_t from = text.find_first_not_of(" \t");
  if (from == std::string_view::npos) return "";
  return std::string(text.substr(from, text.find_last_not_of(" \t") - from + 1));
}

// "a = 2e-8, b = 0.1"
void read_values(std::string_view text, ExpressionText& expression, std::vector<std::string>& faults) {
  while (!trimmed(text).empty()) {
    const std::size_t end = text.find(',');
    const std::string part = trimmed(text.substr(0, end));
    text = end == std::string_view::npos ? std::string_view() : text.substr(end + 1);
    const std::size_t equals = part.find('=');
    const std::string name = trimmed(std::string_view(part).substr(0, equals));
    const std::string number =
        equals == std::string::npos ? "" : trimmed(std::string_view(part).substr(equals + 1));
    char* rest = nullptr;
    const double value = std::strtod(number.c_str(), &rest);
    if (number.empty() || *rest != '\0' || !std::isfinite(value) || value == 0.0 || !is_formula_name(name)) {
      faults.push_back(fmt::format("'{}': write NAME = NUMBER, the number not 0", part));
      continue;
    }
    const double bound = kRange * std::abs(value);
    expression.params.push_back({.name = name, .unit = "1", .value = value, .lower = -bound, .upper = bound});
  }
}

}  // namespace

EffectUse formula_argument(std::string_view text, bool linear, std::vector<std::string>& faults) {
  ExpressionText expression;
  expression.name = "added";
  expression.linear = linear;
  const std::size_t plus = text.find("+="), semicolon = text.find(';');
  expression.adds_to = trimmed(text.substr(0, plus));
  expression.formula = trimmed(text.substr(
      plus + 2, semicolon == std::string_view::npos ? std::string_view::npos : semicolon - plus - 2));
  if (semicolon != std::string_view::npos) read_values(text.substr(semicolon + 1), expression, faults);
  if (!faults.empty()) return {};
  std::vector<FormulaFault> wrong;
  const auto made = make_expression(std::move(expression), wrong);
  for (const FormulaFault& f : wrong) {
    faults.push_back(
        fmt::format("formula, character {}: '{}': {}; allowed: {}; a parameter needs a value behind "
                    "the formula: \"; a = 2e-8\"",
                    f.position, f.found, f.what, f.allowed));
  }
  return made == nullptr ? EffectUse{} : use_of_expression(made);
}

}  // namespace omnihil
