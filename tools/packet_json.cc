#include "tools/packet_json.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>

#include "protocols/codec.h"
#include "sim/model/params.h"

namespace omnihil {
namespace {

using nlohmann::json;

constexpr std::string_view kTextKey = "text";

// The steps into the JSON of a field's name: "wheel[2].speed" -> wheel, [2], speed.
std::vector<std::string_view> steps_of(std::string_view name) {
  std::vector<std::string_view> steps;
  while (!name.empty()) {
    const std::size_t end = std::min(name.find_first_of(".[", 1), name.size());
    steps.push_back(name.substr(0, end));
    name.remove_prefix(end);
    if (name.starts_with('.')) name.remove_prefix(1);
  }
  return steps;
}
bool is_element(std::string_view step) { return step.starts_with('['); }

// What stands next to `path` in the name of a field below it: ".speed" of "wheel", "" where it is the field.
std::optional<std::string_view> below(const Field& field, std::string_view path) {
  if (path.empty()) return field.name;
  if (!field.name.starts_with(path)) return std::nullopt;
  const std::string_view rest = field.name.substr(path.size());
  if (!rest.empty() && rest[0] != '.' && rest[0] != '[') return std::nullopt;
  return rest;
}

bool is_float(const Field& field) {
  return field.kind == FieldKind::kFloat32 || field.kind == FieldKind::kRanged32 ||
         field.kind == FieldKind::kScaled;
}

bool may_be_no_number(const Field& field) {
  return !field.only_if.empty() || (field.scale != nullptr && field.scale->none_at_lowest);
}

std::string short_float(float value) {
  char buffer[32];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, value).ptr;
  std::string out(buffer, end);
  if (out.find_first_of(".e") == std::string::npos) out += ".0";
  return out;
}

std::string short_number(double value) {
  char buffer[32];
  return {buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr};
}

std::string in_quotes(std::string_view text) { return "'" + std::string(text) + "'"; }

// One byte of a text per character up to U+00FF.
bool latin1_from_utf8(std::string_view utf8, std::string& out) {
  for (std::size_t i = 0; i < utf8.size(); ++i) {
    const auto lead = static_cast<unsigned char>(utf8[i]);
    if (lead < 0x80) {
      out += utf8[i];
    } else if ((lead == 0xC2 || lead == 0xC3) && i + 1 < utf8.size()) {
      const auto next = static_cast<unsigned char>(utf8[++i]);
      out += static_cast<char>(((lead & 0x03u) << 6) | (next & 0x3Fu));
    } else {
      return false;
    }
  }
  return true;
}

std::string utf8_from_latin1(std::string_view text) {
  std::string out;
  for (char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x80) {
      out += c;
    } else {
      out += static_cast<char>(0xC0 | (byte >> 6));
      out += static_cast<char>(0x80 | (byte & 0x3F));
    }
  }
  return out;
}

struct Reader {
  const Message& message;
  PacketFromJson& out;

  void problem(std::string_view field, const json& value, const std::string& allowed) {
    out.problems.push_back("field " + in_quotes(field) + ": " + value.dump() +
                           " is not allowed; allowed: " + allowed);
  }

  // The names that may stand where `path` ends, without what is below them.
  void unknown_key(const std::string& path) {
    const std::size_t parent = path.find_last_of(".[") == std::string::npos ? 0 : path.find_last_of(".[");
    std::vector<std::string_view> names;
    for (const Field& field : message.fields) {
      if (!below(field, std::string_view(path).substr(0, parent))) continue;
      const std::string_view name = field.name.substr(0, field.name.find_first_of(".[", parent + 1));
      if (names.empty() || names.back() != name) names.push_back(name);
    }
    if (message.text_tail) names.push_back(kTextKey);
    const std::string_view near = nearest_spelling(path, names);
    out.problems.push_back("field " + in_quotes(path) + ": " + std::string(message.name) +
                           " has no such field" +
                           (near.empty() ? "" : "; did you mean " + in_quotes(near) + "?"));
  }

  void number(std::size_t index, const json& given) {
    const Field& field = message.fields[index];
    Value& value = out.values.fields[index];
    is_given[index] = true;
    if (given.is_boolean() && field.bits == 1 && !is_float(field)) {
      value = {.number = given.get<bool>() ? 1.0 : 0.0, .raw = 0};
    } else if (given.is_null() && may_be_no_number(field)) {
      value = {.number = std::numeric_limits<double>::quiet_NaN(), .raw = 0};
    } else if (given.is_number()) {
      value = {.number = given.get<double>(), .raw = 0};
      // Integers above 2^53 do not fit a double.
      if (given.is_number_unsigned() && !is_float(field)) value.raw = given.get<std::uint64_t>();
    } else {
      problem(field.name, given, allowed_text(field, message));
      return;
    }
    check(index, given);
  }

  void check(std::size_t index, const json& given) {
    const Field& field = message.fields[index];
    const std::size_t size = static_cast<std::size_t>(message.size_bytes) + out.text.size();
    if (field_fault(field, message, size, out.values.fields[index]) != PacketError::kNone) {
      problem(field.name, given, allowed_text(field, message));
    }
  }

  // Elements of the array, or members of the struct, that `path` names.
  void array(const std::string& path, const json& given, std::size_t elements) {
    if (!given.is_array() || given.size() != elements) {
      problem(path, given, "an array of " + std::to_string(elements) + " numbers");
      return;
    }
    for (std::size_t i = 0; i < elements; ++i) field(path + "[" + std::to_string(i) + "]", given[i]);
  }

  void members(const std::string& path, const json& given) {
    if (!given.is_object()) return problem(path, given, "an object");
    for (const auto& [key, value] : given.items()) field(path + "." + key, value);
  }

  void text(const json& given) {
    if (!given.is_string() || !latin1_from_utf8(given.get_ref<const std::string&>(), out.text)) {
      problem(kTextKey, given, "a text of characters up to U+00FF, one byte each");
    }
  }

  void field(const std::string& path, const json& given) {
    std::size_t elements = 0;
    bool is_struct = false;
    for (std::size_t i = 0; i < message.fields.size(); ++i) {
      const auto rest = below(message.fields[i], path);
      if (!rest) continue;
      if (rest->empty()) return number(i, given);
      is_struct = !is_element(*rest);
      if (!is_struct) elements = static_cast<std::size_t>(std::stoi(std::string(rest->substr(1)))) + 1;
    }
    if (is_struct) return members(path, given);
    return elements > 0 ? array(path, given, elements) : unknown_key(path);
  }

  std::array<bool, kMaxFields> is_given{};
};

// A field left out holds 0: that must be allowed as well.
void check_left_out(const std::array<bool, kMaxFields>& is_given, const Message& message,
                    PacketFromJson& out) {
  for (std::size_t i = 0; i < message.fields.size(); ++i) {
    const Field& field = message.fields[i];
    const std::size_t size = static_cast<std::size_t>(message.size_bytes) + out.text.size();
    if (is_given[i]) continue;
    if (field_fault(field, message, size, out.values.fields[i]) == PacketError::kNone) continue;
    out.problems.push_back("field " + in_quotes(field.name) +
                           ": missing; allowed: " + allowed_text(field, message));
  }
}

std::string value_text(const Field& field, const Value& value) {
  if (field.unit == "bool") return value.raw != 0 ? "true" : "false";
  if (std::isnan(value.number)) return "null";
  if (is_float(field)) return short_float(static_cast<float>(value.number));
  if (field.sign != Sign::kNone) return std::to_string(integer_of(field, value.raw));
  return std::to_string(value.raw);
}

// JSON text of values that stand in structs and arrays by their names, in the order in which these first appear: fields of
// one struct may stand apart in the packet.
class Nested {
 public:
  void add(std::string_view name, std::string value) {
    Nested* at = this;
    for (const std::string_view step : steps_of(name)) at = &at->below(step);
    at->value_ = std::move(value);
  }
  std::string text() const {
    if (below_.empty() && !step_.empty()) return value_;
    std::string out;
    for (const Nested& each : below_) {
      out += out.empty() ? "" : ",";
      if (!is_element(each.step_)) out += "\"" + std::string(each.step_) + "\":";
      out += each.text();
    }
    return !below_.empty() && is_element(below_.front().step_) ? "[" + out + "]" : "{" + out + "}";
  }

 private:
  Nested& below(std::string_view step) {
    const auto known = std::ranges::find(below_, step, &Nested::step_);
    if (known != below_.end()) return *known;
    below_.emplace_back().step_ = step;
    return below_.back();
  }

  std::string_view step_;  // empty: the packet
  std::string value_;
  std::vector<Nested> below_;
};

}  // namespace

std::string allowed_text(const Field& field, const Message& message) {
  const std::string unit = field.unit.empty() ? "" : " " + std::string(field.unit);
  const bool limited = field.lo != field.hi;
  std::string limits = short_number(field.lo) + " to " + short_number(field.hi) + unit;
  switch (field.kind) {
    case FieldKind::kInteger:
    case FieldKind::kReserved:
      if (field.unit == "bool") return "true or false";
      if (field.sign != Sign::kNone && !limited) {
        const std::int64_t largest = (std::int64_t{1} << (field.bits - 1)) - 1;
        const std::int64_t lowest = field.sign == Sign::kMagnitude ? -largest : -largest - 1;
        return "a whole number, " + std::to_string(lowest) + " to " + std::to_string(largest) + unit;
      }
      if (limited) return "a whole number, " + limits;
      return "a whole number, 0 to " + std::to_string(field.bits >= 64 ? ~0ull : (1ull << field.bits) - 1) +
             unit;
    case FieldKind::kConst:
      return std::to_string(field.constant);
    case FieldKind::kType:
      return std::to_string(required_raw(field, message, 0));
    case FieldKind::kLength:
      return message.text_tail
                 ? std::to_string(message.size_bytes) + " + length of the text, at most 255"
                 : std::to_string(static_cast<std::uint64_t>(message.size_bytes) - field.constant);
    case FieldKind::kFloat32:
      return limited ? limits : "any finite float32" + unit;
    case FieldKind::kRanged32:
      return limits;
    case FieldKind::kScaled:
      if (field.scale->beyond != Beyond::kRefused) limits = "a number, best in " + limits;
      return field.scale->none_at_lowest ? limits + ", or null" : limits;
    case FieldKind::kChecksum:
      return "the checksum of the packet";
  }
  return "";
}

void packet_from_json(const json& object, const Message& message, PacketFromJson& out) {
  out = {};
  out.values.message = &message;
  if (!object.is_object()) {
    out.problems.push_back("not a JSON object: " + object.dump());
    return;
  }
  Reader reader{message, out};
  // The text first: the length field depends on it.
  if (message.text_tail && object.contains(kTextKey)) reader.text(object.at(std::string(kTextKey)));
  for (const auto& [key, value] : object.items()) {
    if (!message.text_tail || key != kTextKey) reader.field(key, value);
  }
  check_left_out(reader.is_given, message, out);
  out.values.text = out.text;
}

std::string packet_to_json(const Values& values) {
  const Message& message = *values.message;
  Nested fields;
  for (std::size_t i = 0; i < message.fields.size(); ++i) {
    const Field& field = message.fields[i];
    if (!field.envelope) fields.add(field.name, value_text(field, values.fields[i]));
  }
  if (message.text_tail && !values.text.empty()) {
    fields.add(kTextKey, json(utf8_from_latin1(values.text)).dump());
  }
  return "{\"packet\":\"" + std::string(message.name) + "\",\"fields\":" + fields.text() + "}";
}

}  // namespace omnihil
