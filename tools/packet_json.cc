#include "tools/packet_json.h"

#include <charconv>
#include <nlohmann/json.hpp>
#include <string_view>

#include "protocols/codec.h"
#include "sim/model/params.h"

namespace omnihil {
namespace {

using nlohmann::json;

constexpr std::string_view kTextKey = "text";

// "cmd[2]" -> "cmd"; a plain name is its own key.
std::string_view json_key(const Field& field) { return field.name.substr(0, field.name.find('[')); }
bool is_element(const Field& field) { return json_key(field).size() != field.name.size(); }

bool is_float(const Field& field) {
  return field.kind == FieldKind::kFloat32 || field.kind == FieldKind::kRanged32;
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

  void unknown_key(const std::string& key) {
    std::vector<std::string_view> names;
    for (const Field& field : message.fields) {
      if (names.empty() || names.back() != json_key(field)) names.push_back(json_key(field));
    }
    if (message.text_tail) names.push_back(kTextKey);
    const std::string_view near = nearest_spelling(key, names);
    out.problems.push_back("field " + in_quotes(key) + ": " + std::string(message.name) +
                           " has no such field" +
                           (near.empty() ? "" : "; did you mean " + in_quotes(near) + "?"));
  }

  void number(std::size_t index, const json& given) {
    const Field& field = message.fields[index];
    Value& value = out.values.fields[index];
    if (given.is_boolean() && field.bits == 1 && !is_float(field)) {
      value = {.number = given.get<bool>() ? 1.0 : 0.0, .raw = 0};
    } else if (given.is_number()) {
      value = {.number = given.get<double>(), .raw = 0};
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

  void array(const std::string& key, const json& given) {
    std::vector<std::size_t> indices;
    for (std::size_t i = 0; i < message.fields.size(); ++i) {
      if (json_key(message.fields[i]) == key) indices.push_back(i);
    }
    if (!given.is_array() || given.size() != indices.size()) {
      problem(key, given, "an array of " + std::to_string(indices.size()) + " numbers");
      return;
    }
    for (std::size_t i = 0; i < indices.size(); ++i) number(indices[i], given[i]);
  }

  void text(const json& given) {
    if (!given.is_string() || !latin1_from_utf8(given.get_ref<const std::string&>(), out.text)) {
      problem(kTextKey, given, "a text of characters up to U+00FF, one byte each");
    }
  }

  void field(const std::string& key, const json& given) {
    for (std::size_t i = 0; i < message.fields.size(); ++i) {
      if (json_key(message.fields[i]) != key) continue;
      return is_element(message.fields[i]) ? array(key, given) : number(i, given);
    }
    unknown_key(key);
  }
};

// A field left out holds 0: that must be allowed as well.
void check_left_out(const json& object, const Message& message, PacketFromJson& out) {
  for (std::size_t i = 0; i < message.fields.size(); ++i) {
    const Field& field = message.fields[i];
    const std::size_t size = static_cast<std::size_t>(message.size_bytes) + out.text.size();
    if (object.contains(std::string(json_key(field)))) continue;
    if (field_fault(field, message, size, out.values.fields[i]) == PacketError::kNone) continue;
    out.problems.push_back("field " + in_quotes(field.name) +
                           ": missing; allowed: " + allowed_text(field, message));
  }
}

std::string value_text(const Field& field, const Value& value) {
  if (field.unit == "bool") return value.raw != 0 ? "true" : "false";
  if (is_float(field)) return short_float(static_cast<float>(value.number));
  return std::to_string(value.raw);
}

}  // namespace

std::string allowed_text(const Field& field, const Message& message) {
  const std::string unit = field.unit.empty() ? "" : " " + std::string(field.unit);
  const bool limited = field.lo != field.hi;
  std::string limits = short_number(field.lo) + " to " + short_number(field.hi) + unit;
  switch (field.kind) {
    case FieldKind::kUint:
    case FieldKind::kReserved:
      if (field.unit == "bool") return "true or false";
      if (limited) return "a whole number, " + limits;
      return "a whole number, 0 to " + std::to_string(field.bits >= 64 ? ~0ull : (1ull << field.bits) - 1) +
             unit;
    case FieldKind::kConst:
      return std::to_string(field.constant);
    case FieldKind::kType:
      return std::to_string(message.type);
    case FieldKind::kLength:
      return message.text_tail ? std::to_string(message.size_bytes) + " + length of the text, at most 255"
                               : std::to_string(message.size_bytes);
    case FieldKind::kFloat32:
      return limited ? limits : "any finite float32" + unit;
    case FieldKind::kRanged32:
      return limits;
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
  check_left_out(object, message, out);
  out.values.text = out.text;
}

std::string packet_to_json(const Values& values) {
  const Message& message = *values.message;
  std::string out = "{\"packet\":\"" + std::string(message.name) + "\",\"fields\":{";
  std::string_view open_array;
  bool first = true;
  for (std::size_t i = 0; i < message.fields.size(); ++i) {
    const Field& field = message.fields[i];
    if (field.envelope) continue;
    if (!open_array.empty() && json_key(field) != open_array) {
      out += "]";
      open_array = {};
    }
    if (!first) out += ",";
    first = false;
    if (open_array.empty()) out += "\"" + std::string(json_key(field)) + "\":";
    if (open_array.empty() && is_element(field)) {
      out += "[";
      open_array = json_key(field);
    }
    out += value_text(field, values.fields[i]);
  }
  if (!open_array.empty()) out += "]";
  if (message.text_tail && !values.text.empty()) {
    out += std::string(first ? "" : ",") + "\"text\":" + json(utf8_from_latin1(values.text)).dump();
  }
  return out + "}}";
}

}  // namespace omnihil
