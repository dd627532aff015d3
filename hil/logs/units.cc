#include "hil/logs/units.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <numbers>

namespace omnihil {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;

// `kind` stands for what is measured; `factor` leads to the first unit of the kind.
struct Unit {
  std::string_view name;
  std::string_view kind;
  double factor = 1.0;
  bool electrical = false;  // divided by the pole pairs as well
};
constexpr Unit kUnits[] = {{"s", "time"},
                           {"ms", "time", 1e-3},
                           {"us", "time", 1e-6},
                           {"µs", "time", 1e-6},
                           {"ns", "time", 1e-9},
                           {"min", "time", 60.0},
                           {"rad", "angle"},
                           {"deg", "angle", kTurn / 360},
                           {"°", "angle", kTurn / 360},
                           {"turn", "angle", kTurn},
                           {"turns", "angle", kTurn},
                           {"rev", "angle", kTurn},
                           {"mrad", "angle", 1e-3},
                           {"erad", "angle", 1.0, true},
                           {"rad/s", "speed"},
                           {"rpm", "speed", kTurn / 60},
                           {"RPM", "speed", kTurn / 60},
                           {"rev/min", "speed", kTurn / 60},
                           {"r/min", "speed", kTurn / 60},
                           {"deg/s", "speed", kTurn / 360},
                           {"°/s", "speed", kTurn / 360},
                           {"turn/s", "speed", kTurn},
                           {"turns/s", "speed", kTurn},
                           {"rev/s", "speed", kTurn},
                           {"rps", "speed", kTurn},
                           {"Hz", "speed", kTurn},
                           {"erpm", "speed", kTurn / 60, true},
                           {"erad/s", "speed", 1.0, true},
                           {"A", "current"},
                           {"mA", "current", 1e-3},
                           {"V", "voltage"},
                           {"mV", "voltage", 1e-3},
                           {"1", "ratio"},
                           {"ratio", "ratio"},
                           {"%", "ratio", 0.01},
                           {"percent", "ratio", 0.01},
                           {"pct", "ratio", 0.01},
                           {"/255", "ratio", 1.0 / 255.0},    // a timer's compare value, 8 bits: analogWrite
                           {"/1023", "ratio", 1.0 / 1023.0},  // 10 bits
                           {"/4095", "ratio", 1.0 / 4095.0},  // 12 bits
                           {"N m", "torque"},
                           {"Nm", "torque"},
                           {"N*m", "torque"},
                           {"N.m", "torque"},
                           {"mNm", "torque", 1e-3},
                           {"mN m", "torque", 1e-3},
                           {"N", "force"},
                           {"m", "length"},
                           {"cm", "length", 1e-2},
                           {"mm", "length", 1e-3},
                           {"m/s", "velocity"},
                           {"mm/s", "velocity", 1e-3},
                           {"cm/s", "velocity", 1e-2},
                           {"m/s^2", "acceleration"},
                           {"m/s2", "acceleration"},
                           {"m/s²", "acceleration"},
                           {"g", "acceleration", 9.80665},
                           {"degC", "temperature"},
                           {"°C", "temperature"},
                           {"C", "temperature"},
                           {"counts", "counts"},
                           {"count", "counts"},
                           {"ticks", "counts"}};

const Unit* find_unit(std::string_view name) {
  const auto it =
      std::find_if(std::begin(kUnits), std::end(kUnits), [&](const Unit& u) { return u.name == name; });
  return it == std::end(kUnits) ? nullptr : it;
}

// What stands behind the last underscores of a name. Letters alone ("_s", "_A") are case-sensitive: "_a" is no ampere.
struct Suffix {
  std::string_view text, unit;
};
constexpr Suffix kSuffixes[] = {
    {"_rad_s", "rad/s"},   {"_deg_s", "deg/s"}, {"_m_s2", "m/s^2"},    {"_m_s", "m/s"},
    {"_mm_s", "mm/s"},     {"_rev_s", "rev/s"}, {"_turn_s", "turn/s"}, {"_turns_s", "turns/s"},
    {"_rpm", "rpm"},       {"_erpm", "erpm"},   {"_rad", "rad"},       {"_deg", "deg"},
    {"_turns", "turns"},   {"_rev", "rev"},     {"_ms", "ms"},         {"_us", "us"},
    {"_ns", "ns"},         {"_s", "s"},         {"_sec", "s"},         {"_mA", "mA"},
    {"_A", "A"},           {"_mV", "mV"},       {"_V", "V"},           {"_mNm", "mNm"},
    {"_Nm", "N m"},        {"_N", "N"},         {"_mm", "mm"},         {"_m", "m"},
    {"_percent", "%"},     {"_pct", "%"},       {"_degC", "degC"},     {"_C", "degC"},
    {"_counts", "counts"}, {"_ticks", "counts"}};

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.front())) != 0) text.remove_prefix(1);
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back())) != 0) text.remove_suffix(1);
  return text;
}

// "-rad": the other way round; "0.0018*m": a number of metres for each of the column's.
struct Scaled {
  double factor = 1.0;
  std::string_view unit;
};
Scaled scaled(std::string_view word) {
  double factor = 0.0;
  const auto [end, fault] = std::from_chars(word.data(), word.data() + word.size(), factor);
  const auto length = static_cast<std::size_t>(end - word.data());
  if (fault == std::errc{} && factor != 0.0 && std::isfinite(factor) && word.substr(length).starts_with('*'))
    return {factor, word.substr(length + 1)};
  if (word.starts_with('-')) return {-1.0, word.substr(1)};
  return {1.0, word};
}

}  // namespace

bool is_unit(std::string_view word) { return find_unit(scaled(word).unit) != nullptr; }

std::vector<std::string> units_for(std::string_view to) {
  std::vector<std::string> out;
  const Unit* target = find_unit(to);
  if (target == nullptr) return {std::string(to)};
  for (const Unit& u : kUnits) {
    // One spelling of each.
    const auto same = [&](const Unit& other) {
      return other.kind == u.kind && other.factor == u.factor && other.electrical == u.electrical;
    };
    if (u.kind == target->kind && std::find_if(std::begin(kUnits), std::end(kUnits), same)->name == u.name)
      out.emplace_back(u.name);
  }
  return out;
}

std::optional<UnitScale> unit_scale(std::string_view from, std::string_view to, const UnitContext& context,
                                    std::string& fault) {
  const Scaled said = scaled(from);
  const Unit* a = find_unit(said.unit);
  const Unit* b = find_unit(to);
  if (a == nullptr || b == nullptr || a->kind != b->kind) {
    std::string allowed;
    for (const std::string& word : units_for(to)) allowed += (allowed.empty() ? "" : ", ") + word;
    fault = fmt::format("\"{}\" is no unit for this; allowed: {}", from, allowed);
    return std::nullopt;
  }
  double scale = said.factor * a->factor / b->factor;
  if (a->electrical) {
    if (!(context.pole_pairs > 0.0)) {
      fault = fmt::format("\"{}\" needs the number of pole pairs: motor.pole_pairs in the model", from);
      return std::nullopt;
    }
    scale /= context.pole_pairs;
  }
  return UnitScale{scale, 0.0};
}

std::pair<std::string, std::string> split_unit(std::string_view name) {
  name = trimmed(name);
  for (const auto& [open, close] : {std::pair{'[', ']'}, std::pair{'(', ')'}}) {
    if (name.empty() || name.back() != close) continue;
    const std::size_t at = name.rfind(open);
    if (at == std::string_view::npos || at == 0) continue;
    const std::string_view unit = trimmed(name.substr(at + 1, name.size() - at - 2));
    if (is_unit(unit)) return {std::string(trimmed(name.substr(0, at))), std::string(unit)};
  }
  for (const Suffix& s : kSuffixes) {
    if (name.size() > s.text.size() && name.ends_with(s.text))
      return {std::string(name.substr(0, name.size() - s.text.size())), std::string(s.unit)};
  }
  return {std::string(name), ""};
}

}  // namespace omnihil
