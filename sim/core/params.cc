#include "sim/core/params.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace omnihil {
namespace {

// Insertions, deletions and replacements from `a` to `b` (V. Levenshtein 1966), one row of the table at a
// time.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j < row.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replace = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, replace});
    }
  }
  return row.back();
}

}  // namespace

std::string parameter_path(const ParameterRow& row) {
  return row.section.empty() ? std::string(row.key) : fmt::format("{}.{}", row.section, row.key);
}

std::string allowed_range(const ParameterRow& row) {
  if (row.kind == ParameterKind::kChoice) {
    std::string words;
    for (const std::string_view word : row.choices) {
      words += fmt::format("{}\"{}\"", words.empty() ? "" : ", ", word);
    }
    return words;
  }
  const std::string unit = row.unit == "1" || row.unit.empty() ? "" : fmt::format(" {}", row.unit);
  const char* whole = row.kind == ParameterKind::kWholeNumber ? ", whole" : "";
  return fmt::format("{}{:g} to {:g}{}{}", row.above_lower ? "more than " : "", row.lower, row.upper, unit,
                     whole);
}

bool within_bounds(const ParameterRow& row, double value) {
  if (!std::isfinite(value)) return false;
  if (row.above_lower ? value <= row.lower : value < row.lower) return false;
  return value <= row.upper;
}

const Parameter* ParameterTable::find(std::string_view path) const {
  for (const Parameter& p : parameters) {
    const auto& row = *p.row;
    if (row.section.empty()
            ? path == row.key
            : path.size() == row.section.size() + 1 + row.key.size() && path.starts_with(row.section) &&
                  path[row.section.size()] == '.' && path.ends_with(row.key)) {
      return &p;
    }
  }
  return nullptr;
}

Parameter* ParameterTable::find(std::string_view path) {
  return const_cast<Parameter*>(std::as_const(*this).find(path));
}

double ParameterTable::value_or(std::string_view path, double otherwise) const {
  const Parameter* p = find(path);
  return p == nullptr || p->values.empty() ? otherwise : p->value();
}

std::string ParameterTable::set(std::string_view path, double value) {
  Parameter* p = find(path);
  if (p == nullptr) return fmt::format("{}: this model has no such parameter", path);
  if (is_text(*p->row)) return fmt::format("{}: is a text, not a number", path);
  const bool whole = p->row->kind != ParameterKind::kWholeNumber || value == std::floor(value);
  if (!within_bounds(*p->row, value) || !whole) {
    return fmt::format("{} = {:g}: allowed is {}", path, value, allowed_range(*p->row));
  }
  std::fill(p->values.begin(), p->values.end(), value);
  p->origin = Origin::kSet;
  return "";
}

RobotModel robot_model_of(const ParameterTable& table) {
  RobotModel model;
  for (const Parameter& p : table.parameters) {
    if (p.row->store != nullptr && !p.values.empty()) p.row->store(model, p.values);
  }
  return model;
}

std::string_view nearest_spelling(std::string_view word, std::span<const std::string_view> candidates) {
  const std::size_t reach = std::max<std::size_t>(2, word.size() / 3);
  std::string_view best;
  std::size_t best_distance = reach + 1;
  for (const std::string_view candidate : candidates) {
    const std::size_t distance = edit_distance(word, candidate);
    if (distance < best_distance) best = candidate, best_distance = distance;
  }
  return best;
}

}  // namespace omnihil
