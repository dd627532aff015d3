#include "hil/recording/compare_recordings_tolerance.h"

#include <algorithm>
#include <array>

#include "hil/recording/recording.h"
#include "hil/text/recording_text.h"
#include "protocols/codec.h"
#include "sim/model/params.h"

namespace omnihil {
namespace {

constexpr std::array kDefaults{
    UnitTolerance{"m", 0.001},    UnitTolerance{"rad", 0.005}, UnitTolerance{"m/s", 0.005},
    UnitTolerance{"rad/s", 0.05}, UnitTolerance{"m/s^2", 0.1}, UnitTolerance{"counts", 4.0},
    UnitTolerance{"A", 0.05},     UnitTolerance{"V", 0.01},    UnitTolerance{"Nm", 0.001},
    UnitTolerance{"N", 0.1},      UnitTolerance{"1", 0.001},   UnitTolerance{"ms", 1.0},
};
constexpr std::string_view kPacketTime = "packet_time_s";
constexpr std::string_view kUnitPrefix = "unit:";

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r\"";
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

// Every key that a setting may name.
std::vector<std::string> known_keys(const RadioFormat* format) {
  std::vector<std::string> keys{std::string(kPacketTime)};
  std::vector<std::string_view> units;
  for (const UnitTolerance& row : kDefaults) units.push_back(row.unit);
  for (const SampleColumn& column : sample_columns()) {
    keys.push_back(column.name);
    keys.emplace_back(without_wheel(column.name));
    units.push_back(column.unit);
  }
  if (format != nullptr) {
    for (const Message& message : format->messages) {
      for (const Field& field : message.fields) {
        keys.push_back(std::string(message.name) + "." + std::string(field.name));
        if (!field.unit.empty()) units.push_back(field.unit);
      }
    }
  }
  for (const std::string_view unit : units) keys.push_back(std::string(kUnitPrefix) + std::string(unit));
  return keys;
}

// One count of the field's resolution, in its unit.
double resolution(const Field& field) {
  return field.kind == FieldKind::kInteger && field.unit.empty() ? 0.0 : field_step(field);
}

}  // namespace

std::span<const UnitTolerance> default_tolerances() { return kDefaults; }

std::string_view without_wheel(std::string_view column) {
  const std::size_t size = column.size();
  const bool has_wheel =
      size > 2 && column[size - 2] == '_' && column[size - 1] >= '1' && column[size - 1] <= '4';
  return has_wheel ? column.substr(0, size - 2) : column;
}

double Tolerances::of_column(std::string_view name, std::string_view unit) const {
  if (exact) return 0.0;
  for (const std::string& key :
       {std::string(name), std::string(without_wheel(name)), std::string(kUnitPrefix) + std::string(unit)}) {
    if (const auto at = settings.find(key); at != settings.end()) return at->second;
  }
  const auto row =
      std::find_if(kDefaults.begin(), kDefaults.end(), [&](const auto& each) { return each.unit == unit; });
  return row == kDefaults.end() ? 0.0 : row->tolerance;
}

double Tolerances::of_field(std::string_view message, const Field& field) const {
  if (exact) return 0.0;
  const auto named = settings.find(std::string(message) + "." + std::string(field.name));
  if (named != settings.end()) return named->second;
  const bool is_number = field.kind == FieldKind::kRanged32 || field.kind == FieldKind::kFloat32 ||
                         field.kind == FieldKind::kScaled;
  const std::string_view unit = field.unit.empty() && is_number ? "1" : field.unit;
  return resolution(field) + (unit.empty() ? 0.0 : of_column("", unit));
}

double Tolerances::packet_time_s() const {
  if (exact) return 0.0;
  const auto at = settings.find(kPacketTime);
  return at == settings.end() ? kDefaultPacketTime_s : at->second;
}

void Tolerances::read(std::string_view setting, const std::string& place, const RadioFormat* format,
                      std::vector<std::string>& problems) {
  const std::size_t equals = setting.find('=');
  const std::string key(trimmed(setting.substr(0, equals)));
  if (equals == std::string_view::npos || key.empty()) {
    problems.push_back(place + ": found " + in_quotes(setting) + ", allowed: KEY=VALUE");
    return;
  }
  const std::string_view text = trimmed(setting.substr(equals + 1));
  double value = 0.0;
  if (!parse_number(text, value) || value < 0.0) {
    problems.push_back(place + ": tolerance of '" + key + "': found " + in_quotes(text) +
                       ", allowed: a number >= 0");
    return;
  }
  const std::vector<std::string> keys = known_keys(format);
  if (std::find(keys.begin(), keys.end(), key) == keys.end()) {
    const std::vector<std::string_view> views(keys.begin(), keys.end());
    const std::string_view nearest = nearest_spelling(key, views);
    problems.push_back(place + ": found key " + in_quotes(key) +
                       ", allowed: a sample column, 'unit:UNIT', MESSAGE.FIELD of the radio format, " +
                       std::string(kPacketTime) +
                       (nearest.empty() ? std::string() : "; did you mean '" + std::string(nearest) + "'?"));
    return;
  }
  settings[key] = value;
}

void Tolerances::read_file(std::string_view text, const std::string& name, const RadioFormat* format,
                           std::vector<std::string>& problems) {
  for (int line_number = 1; !text.empty(); ++line_number) {
    const std::size_t end = text.find('\n');
    std::string_view line = text.substr(0, end);
    text = end == std::string_view::npos ? std::string_view{} : text.substr(end + 1);
    line = trimmed(line.substr(0, line.find('#')));
    if (!line.empty()) read(line, name + ":" + std::to_string(line_number), format, problems);
  }
}

std::string default_tolerance_text() {
  std::string text = "Default tolerances: packet_time_s ";
  append_number(text, kDefaultPacketTime_s);
  for (const UnitTolerance& row : kDefaults) {
    text += ", unit:" + std::string(row.unit) + " ";
    append_number(text, row.tolerance);
  }
  return text;
}

}  // namespace omnihil
