#include "sim/model/params.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "sim/robot/ball_handling.h"

namespace omnihil {
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
  if (const Parameter* const chip = table.find("kicker.chip_network");
      chip != nullptr && !chip->text.empty()) {
    if (const auto network = chip_of_text(chip->text)) {
      auto handling = std::make_shared<BallHandling>(handling_of(model));
      handling->chip = *network;
      model.handling = std::move(handling);
    }
  }
  return model;
}

}  // namespace omnihil
