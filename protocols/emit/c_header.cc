#include <cctype>
#include <cstdio>

#include "protocols/codec.h"
#include "protocols/emit/emit.h"

namespace omnihil {
namespace {

void define(std::string& out, const std::string& name, std::uint64_t value, const char* format_string) {
  char number[32];
  std::snprintf(number, sizeof number, format_string, static_cast<unsigned long long>(value));
  out += "#define " + name + " " + number + "\n";
}

void define_scale(std::string& out, const std::string& name, const Field& field) {
  char lines[256];
  std::snprintf(lines, sizeof lines, "#define %s_PER_COUNT %.9g\n#define %s_AT_0 %.9g\n", name.c_str(),
                field_step(field), name.c_str(), field.scale->number(field, 0));
  out += lines;
}

void define_message(std::string& out, const std::string& prefix, const Message& message) {
  const std::string name = prefix + "_" + c_macro_name(message.name);
  out += "\n/* " + std::string(message.what) + " */\n";
  define(out, name + "_TYPE", message.type, "0x%02llXu");
  define(out, name + "_BYTES", static_cast<std::uint64_t>(message.size_bytes), "%llu");
  define(out, name + "_LSB_FIRST", message.bit_order == BitOrder::kLsbFirst ? 1 : 0, "%llu");
  for (const Field& field : message.fields) {
    const std::string field_name = name + "_" + c_macro_name(field.name);
    if (field.tag != 0) {
      define(out, field_name + "_NUMBER", static_cast<std::uint64_t>(field.tag), "%llu");
      continue;
    }
    define(out, field_name + "_BIT", static_cast<std::uint64_t>(field.bit), "%llu");
    define(out, field_name + "_BITS", static_cast<std::uint64_t>(field.bits), "%llu");
    if (field.kind == FieldKind::kConst) define(out, field_name + "_CONST", field.constant, "0x%02llXu");
    if (field.sign == Sign::kTwosComplement) define(out, field_name + "_SIGNED", 1, "%llu");
    if (field.sign == Sign::kMagnitude) define(out, field_name + "_SIGN_BIT", 1, "%llu");
    if (field.kind == FieldKind::kScaled) define_scale(out, field_name, field);
  }
}

}  // namespace

std::string c_macro_name(std::string_view name) {
  std::string out;
  for (char c : name) {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0) {
      out += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    } else if (!out.empty() && out.back() != '_') {
      out += '_';
    }
  }
  while (!out.empty() && out.back() == '_') out.pop_back();
  return out;
}

std::string emit_c_header(const RadioFormat& format) {
  const std::string prefix = c_macro_name(format.id);
  const std::string guard = "OMNIHIL_" + prefix + "_H";
  std::string out =
      "/* " + std::string(format.title) +
      ": places of the fields in its packets. Generated from the packet tables; do not edit. */\n";
  out += "#ifndef " + guard + "\n#define " + guard + "\n";
  for (const Message& message : format.messages) define_message(out, prefix, message);
  out += "\n#endif\n";
  return out;
}

}  // namespace omnihil
