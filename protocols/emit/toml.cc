#include <charconv>
#include <string>

#include "protocols/dongles/table_dongle.h"
#include "protocols/emit/emit.h"
#include "protocols/meaning.h"
#include "protocols/scale_rules.h"
#include "protocols/table_words.h"

namespace omnihil {
namespace {

// A TOML basic string: quotes, backslashes and what is no printable character escaped.
std::string quoted(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (c == '\n') {
      out += "\\n";
    } else if (c == '\r') {
      out += "\\r";
    } else {
      out += c;
    }
  }
  return out + "\"";
}

// As few digits as give the very same number back.
std::string toml_number(double value) {
  char buffer[32];
  return {buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr};
}

std::string toml_hex(std::uint64_t value) {
  char buffer[24] = "0x";
  return {buffer, std::to_chars(buffer + 2, buffer + sizeof buffer, value, 16).ptr};
}

template <class Enum, std::size_t n>
std::string word(const std::string_view (&words)[n], Enum value) {
  return quoted(words[static_cast<std::size_t>(value)]);
}

// Lines of the notes as they are; a basic string over several lines.
std::string text_block(std::string_view text) {
  std::string out = "\"\"\"\n";
  for (const char c : text) {
    if (c == '\\' || c == '"') out += '\\';
    out += c;
  }
  return out + "\"\"\"";
}

std::string scaled_keys(const Field& field) {
  return ", lo = " + toml_number(field.lo) + ", hi = " + toml_number(field.hi);
}

std::string kind_keys(const Field& field) {
  std::string out;
  if (field.sign != Sign::kNone) out += ", sign = " + word(kSignWords, field.sign);
  switch (field.kind) {
    case FieldKind::kConst:
      out += ", is = " + toml_hex(field.constant);
      return field.cause == ConstCause::kConstant ? out : out + ", cause = " + word(kCauseWords, field.cause);
    case FieldKind::kType:
      return field.constant == 0 ? out : out + ", from_bit = " + std::to_string(field.constant);
    case FieldKind::kLength:
      return field.constant == 0 ? out : out + ", not_counted = " + std::to_string(field.constant);
    case FieldKind::kScaled:
      return out + ", rule = " + quoted(field.scale->name) + scaled_keys(field);
    case FieldKind::kChecksum:
      out += ", sum = " + quoted(field.check->kind->name);
      if (field.check->from != 0) out += ", from = " + std::to_string(field.check->from);
      if (field.check->until != 0) out += ", until = " + std::to_string(field.check->until);
      return out;
    default:
      return field.lo == field.hi ? out : out + scaled_keys(field);
  }
}

std::string toml_field(const Field& field) {
  std::string out = "  { name = " + quoted(field.name) + ", bits = " + std::to_string(field.bits) +
                    ", kind = " + word(kKindWords, field.kind) + kind_keys(field);
  if (field.tag != 0) out += ", number = " + std::to_string(field.tag);
  if (!field.names.empty()) out += ", names = " + quoted(field.names);
  if (!field.unit.empty()) out += ", unit = " + quoted(field.unit);
  if (field.role != FieldRole::kNone) out += ", role = " + word(kFieldRoleWords, field.role);
  if (!field.only_if.empty()) out += ", only_if = " + quoted(field.only_if);
  if (field.envelope) out += ", envelope = true";
  if (field.means != nullptr) out += ", means = " + quoted(field.means->word);
  if (field.times != 1.0) out += ", times = " + toml_number(field.times);
  return out + ", what = " + quoted(field.what) + " },\n";
}

std::string packet_table(const Message& message) {
  std::string out = "\n[[packet]]\nname = " + quoted(message.name) + "\ntype = " + toml_hex(message.type) +
                    "\ndirection = " + word(kDirectionWords, message.direction) +
                    "\nbit_order = " + word(kBitOrderWords, message.bit_order) + "\n";
  if (message.role != MessageRole::kNone) out += "role = " + word(kMessageRoleWords, message.role) + "\n";
  if (message.answer_type != 0) out += "answer_type = " + toml_hex(message.answer_type) + "\n";
  if (message.asks >= 0) out += "asks = " + quoted(kAsksWords[static_cast<std::size_t>(message.asks)]) + "\n";
  if (message.text_tail) out += "text = true\n";
  if (message.in_field_frame) out += "frame = \"field\"\n";
  out += "what = " + quoted(message.what) + "\nfields = [\n";
  for (const Field& field : message.fields) out += toml_field(field);
  return out + "]\n";
}

std::string list_table(const PacketList& list) {
  if (list.begin.empty()) return "\n[list]\nmost = " + std::to_string(list.most) + "\n";
  std::string begin;
  for (const std::uint8_t byte : list.begin) begin += (begin.empty() ? "" : ", ") + toml_hex(byte);
  return "\n[list]\nbegin = [" + begin + "]\nend = " + toml_hex(list.end) +
         "\nmost = " + std::to_string(list.most) + "\n";
}

// Why this field's row would not be the field; empty: it is.
std::string_view toml_problem(const Field& field, int next_bit) {
  if (field.bit != next_bit) return "its fields do not follow each other bit by bit";
  if (field.kind == FieldKind::kChecksum && field.check == nullptr) return "a checksum by a rule of its own";
  if (field.kind == FieldKind::kScaled && find_scale_rule(field.scale->name) != field.scale)
    return "a rule of rounding that has no name";
  return {};
}

}  // namespace

std::string no_toml_reason(const RadioFormat& format) {
  if (!format.own_codec.empty())
    return "its codec is more than its tables: it " + std::string(format.own_codec);
  for (const Message& message : format.messages) {
    int bit = 0;
    for (const Field& field : message.fields) {
      const std::string_view problem = toml_problem(field, bit);
      if (!problem.empty())
        return std::string(message.name) + "." + std::string(field.name) + ": " + std::string(problem);
      bit += field.bits;
    }
  }
  return {};
}

std::string emit_toml(const RadioFormat& format) {
  std::string out = "# Packet tables of " + std::string(format.title) + ", by `omnihil formats " +
                    std::string(format.id) + " --toml`.\n# How to change it: docs/radio/own-format.md\n";
  out += "format = " + quoted(kRadioFileFormat) + "\nid = " + quoted(format.id) +
         "\ntitle = " + quoted(format.title) + "\nsource = " + quoted(format.source) +
         "\nnotes = " + text_block(format.notes) + "\n";
  const RadioFormat* robots = format.dongle == make_table_dongle || !format.has_dongle() ? nullptr : &format;
  if (format.serves_as != nullptr) robots = format.serves_as;
  if (robots != nullptr) {
    out +=
        "# Towards robots it is this built-in format, as long as its packets are the same. Without this line "
        "the\n"
        "# fields' `means` and the packets' `asks` say what they mean to a robot.\n";
    out += "robots = " + quoted(robots->id) + "\n";
  }
  out += "framing = " + word(kFramingWords, format.framing) +
         "\n\n[carrier]\nkind = " + word(kCarrierWords, format.carrier.kind) + "\n";
  if (format.carrier.baud > 0) out += "baud = " + std::to_string(format.carrier.baud) + "\n";
  if (format.carrier.bits_per_byte != 10)
    out += "bits_per_byte = " + std::to_string(format.carrier.bits_per_byte) + "\n";
  if (format.to_robot_ns != 0 || format.to_host_ns != 0) {
    out += "\n[air]\nto_robot_us = " + toml_number(static_cast<double>(format.to_robot_ns) / 1e3) +
           "\nto_host_us = " + toml_number(static_cast<double>(format.to_host_ns) / 1e3) + "\n";
  }
  if (format.list != nullptr) out += list_table(*format.list);
  for (const Message& message : format.messages) out += packet_table(message);
  return out;
}

}  // namespace omnihil
