// DBC: Vector's text form of a CAN database. Source: "DBC File Format Documentation", version 01/2007.
#include <algorithm>
#include <cctype>
#include <cstdio>

#include "protocols/codec.h"
#include "protocols/emit/emit.h"

namespace omnihil {
namespace {

constexpr int kIdBits = 29;     // of the frame's first word; flags follow
constexpr int kLengthBit = 32;  // in `struct can_frame`
constexpr int kDataBit = 64;
constexpr std::uint64_t kNodes = 4;  // as many as there are wheels

// Where the id holds a node: its field.
const Field* node_field(const Message& message) {
  for (const Field& field : message.fields) {
    if (field.bit < kIdBits && field.kind == FieldKind::kInteger) return &field;
  }
  return nullptr;
}

std::uint64_t can_id(const Message& message, std::uint64_t node) {
  std::uint64_t id = 0;
  for (const Field& field : message.fields) {
    if (field.bit >= kIdBits) continue;
    id |= (field.kind == FieldKind::kInteger ? node : required_raw(field, message, 0)) << field.bit;
  }
  return id;
}

std::uint64_t data_bytes(const Message& message) {
  for (const Field& field : message.fields) {
    if (field.bit == kLengthBit) return field.constant;
  }
  return 0;
}

bool is_signal(const Field& field) {
  return field.bit >= kDataBit && !field.envelope && field.kind != FieldKind::kReserved;
}

// The first word of the title: "ODrive CANSimple" is ODrive.
std::string dbc_device(const RadioFormat& format) {
  std::string name;
  for (const char c : format.title.substr(0, format.title.find_first_of(" ,:"))) {
    name += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  }
  return name;
}

std::string dbc_number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

std::string signal_row(const Field& field, std::string_view receiver) {
  const bool is_float = field.kind == FieldKind::kFloat32;
  const bool has_sign = is_float || field.sign == Sign::kTwosComplement;
  const bool scaled = field.kind == FieldKind::kScaled;
  const double at_0 = scaled ? field.scale->number(field, 0) : 0.0;
  return " SG_ " + std::string(field.name) + " : " + std::to_string(field.bit - kDataBit) + "|" +
         std::to_string(field.bits) + "@1" + (has_sign ? "-" : "+") + " (" +
         (scaled ? dbc_number(field_step(field)) : "1") + "," + dbc_number(at_0) + ") [" +
         dbc_number(field.lo) + "|" + dbc_number(field.hi) + "] \"" + std::string(field.unit) + "\" " +
         std::string(receiver) + "\n";
}

// "1 IDLE, 8 CLOSED" as 1 "IDLE" 8 "CLOSED".
std::string value_names(std::string_view names) {
  std::string out;
  while (!names.empty()) {
    const std::string_view one = names.substr(0, names.find(", "));
    const std::size_t space = one.find(' ');
    out += " " + std::string(one.substr(0, space)) + " \"" + std::string(one.substr(space + 1)) + "\"";
    names.remove_prefix(std::min(names.size(), one.size() + 2));
  }
  return out;
}

// One call for each message of each node there may be.
template <class Visit>
void for_each_message(const RadioFormat& format, Visit&& visit) {
  for (std::uint64_t node = 0; node < kNodes; ++node) {
    for (const Message& message : format.messages) {
      const Field* field = node_field(message);
      if (field == nullptr && node > 0) continue;
      const std::string number = field == nullptr ? "" : std::to_string(node);
      visit(message, can_id(message, node), dbc_device(format) + number + "_" + std::string(message.name));
    }
  }
}

}  // namespace

std::string emit_dbc(const RadioFormat& format) {
  const std::string device = dbc_device(format);
  std::string out = "VERSION \"\"\n\nNS_ :\n\nBS_:\n\nBU_: MainBoard " + device + "\n";
  std::string values, floats;
  for_each_message(format, [&](const Message& message, std::uint64_t id, const std::string& name) {
    const bool from_device = message.role == MessageRole::kFeedback;
    out += "\nBO_ " + std::to_string(id) + " " + name + ": " + std::to_string(data_bytes(message)) + " " +
           (from_device ? device : "MainBoard") + "\n";
    for (const Field& field : message.fields) {
      if (!is_signal(field)) continue;
      out += signal_row(field, from_device ? "MainBoard" : std::string_view(device));
      const std::string which = std::to_string(id) + " " + std::string(field.name);
      if (!field.names.empty()) values += "VAL_ " + which + value_names(field.names) + " ;\n";
      if (field.kind == FieldKind::kFloat32) floats += "SIG_VALTYPE_ " + which + " : 1;\n";
    }
  });
  out += "\nCM_ \"" + std::string(format.title) + "; by omnihil formats " + std::string(format.id) +
         " --dbc, nodes 0 to 3.\";\n";
  if (!values.empty()) out += "\n" + values;
  if (!floats.empty()) out += "\n" + floats;
  return out;
}

}  // namespace omnihil
