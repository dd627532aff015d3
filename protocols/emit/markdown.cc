#include <algorithm>
#include <cstdio>
#include <vector>

#include "protocols/codec.h"
#include "protocols/emit/emit.h"
#include "protocols/protobuf_list.h"

namespace omnihil {
namespace {

std::string text(std::string_view view) { return std::string(view); }

// Fewest digits that give the number back to 9 places: 30, 31.4159265, 156.96.
std::string number_text(double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.9g", value);
  return buffer;
}

std::string hex_text(std::uint64_t value) {
  char buffer[24];
  std::snprintf(buffer, sizeof buffer, "%02llXh", static_cast<unsigned long long>(value));
  return buffer;
}

std::string_view direction_text(Direction direction) {
  switch (direction) {
    case Direction::kToRobot:
      return "host to robot";
    case Direction::kFromRobot:
      return "robot to host";
    case Direction::kBoth:
      return "both ways";
    case Direction::kToDongle:
      return "host to dongle";
    case Direction::kFromDongle:
      return "dongle to host";
    case Direction::kInside:
      return "between boards of the robot";
  }
  return "";
}

std::string carrier_text(const Carrier& carrier) {
  switch (carrier.kind) {
    case Carrier::Kind::kUsbCdc:
      return "USB serial port (CDC ACM); the rate a host sets has no effect";
    case Carrier::Kind::kUart:
      return "UART, " + std::to_string(carrier.baud) + " baud, " + std::to_string(carrier.bits_per_byte) +
             " bits on the line per byte";
    case Carrier::Kind::kUdp:
      return "UDP";
    case Carrier::Kind::kSpi:
      return "SPI";
    case Carrier::Kind::kCan:
      return "CAN; a frame as Linux has it in `struct can_frame`, 16 bytes";
  }
  return "";
}

// "-32768 to 32767": what the width allows, or less; the two zeros of a sign bit are worth a word.
std::string signed_text(const Field& field) {
  const std::int64_t largest = field.bits == 64 ? INT64_MAX : (std::int64_t{1} << (field.bits - 1)) - 1;
  const std::string_view form =
      field.sign == Sign::kMagnitude ? ", sign and magnitude" : ", two's complement";
  if (field.lo != field.hi) return number_text(field.lo) + " to " + number_text(field.hi) + text(form);
  if (field.bits > 32) {
    const std::string power = "2^" + std::to_string(field.bits - 1);
    return "-" + power + " to " + power + " - 1" + text(form);
  }
  const std::int64_t lowest = field.sign == Sign::kMagnitude ? -largest : -largest - 1;
  return std::to_string(lowest) + " to " + std::to_string(largest) + text(form);
}

std::string_view sign_text(Sign sign) {
  if (sign == Sign::kNone) return "unsigned";
  return sign == Sign::kMagnitude ? "sign and magnitude" : "two's complement";
}

std::string scaled_text(const Field& field) {
  constexpr std::string_view kBeyond[] = {"", "; what lies beyond is set to the end",
                                          "; what lies beyond comes round again"};
  return number_text(field.lo) + " to " + number_text(field.hi) + " in steps of " +
         number_text(field_step(field)) + " from " + number_text(field.scale->number(field, 0)) + " at 0, " +
         text(sign_text(field.sign)) + "; " + text(field.scale->says) +
         text(kBeyond[static_cast<std::size_t>(field.scale->beyond)]) +
         (field.scale->none_at_lowest ? "; the lowest count is no number" : "");
}

// "CRC-32 of bytes 4 to the end"
std::string checksum_text(const ChecksumRule& rule, const Message& message) {
  const int end = rule.until > 0 ? rule.until : message.size_bytes + rule.until;
  return text(rule.kind->title) + " of bytes " + std::to_string(rule.from) + " to " +
         (rule.until == 0 ? "the end" : std::to_string(end - 1));
}

std::string kind_text(const Field& field, const Message& message) {
  switch (field.kind) {
    case FieldKind::kInteger:
    case FieldKind::kReserved:
      if (field.sign != Sign::kNone) return signed_text(field);
      if (field.lo != field.hi) return number_text(field.lo) + " to " + number_text(field.hi);
      return field.bits > 32 ? "0 to 2^" + std::to_string(field.bits) + " - 1"
                             : "0 to " + std::to_string((1ull << field.bits) - 1);
    case FieldKind::kConst:
      return "always " + hex_text(field.constant);
    case FieldKind::kType:
      return "always " + hex_text(required_raw(field, message, 0));
    case FieldKind::kLength:
      return message.text_tail
                 ? std::to_string(message.size_bytes) + " + length of the text"
                 : "always " + std::to_string(static_cast<std::size_t>(message.size_bytes) - field.constant);
    case FieldKind::kFloat32:
      if (field.lo != field.hi) return "float32, " + number_text(field.lo) + " to " + number_text(field.hi);
      return "float32, finite";
    case FieldKind::kRanged32:
      return number_text(field.lo) + " to " + number_text(field.hi);
    case FieldKind::kScaled:
      return scaled_text(field);
    case FieldKind::kChecksum:
      return field.check == nullptr ? "computed" : checksum_text(*field.check, message);
  }
  return "";
}

std::string tag_form(const Field& field) { return field.kind == FieldKind::kFloat32 ? "4 bytes" : "varint"; }

// "11.0+16": byte, bit in the byte in the message's own bit order, width. Of protobuf "number 2, 4 bytes".
std::string place_text(const Field& field) {
  if (field.tag != 0) return "number " + std::to_string(field.tag) + ", " + tag_form(field);
  return std::to_string(field.bit / 8) + "." + std::to_string(field.bit % 8) + "+" +
         std::to_string(field.bits);
}

// The last earlier packet whose fields are all at the start of this one: its rows need no repeating.
const Message* head_of(const RadioFormat& format, const Message& message) {
  const Message* head = nullptr;
  for (const Message& earlier : format.messages) {
    if (&earlier == &message) break;
    const std::size_t count = earlier.fields.size();
    if (count > message.fields.size() || (head != nullptr && count <= head->fields.size())) continue;
    bool same = true;
    for (std::size_t i = 0; i < count && same; ++i) {
      const Field& a = earlier.fields[i];
      const Field& b = message.fields[i];
      same = a.name == b.name && a.bit == b.bit && a.bits == b.bits && a.kind == b.kind && a.what == b.what &&
             a.lo == b.lo && a.hi == b.hi && a.sign == b.sign && a.scale == b.scale && a.check == b.check &&
             a.only_if == b.only_if;
    }
    if (same) head = &earlier;
  }
  return head;
}

std::string padded(std::string line, std::size_t width) {
  if (line.size() < width) line.append(width - line.size(), ' ');
  return line;
}

bool is_whole_bytes(const Field& field) { return field.bit % 8 == 0 && field.bits % 8 == 0; }

const Field* field_at(const Message& message, int bit) {
  for (const Field& field : message.fields) {
    if (bit >= field.bit && bit < field.bit + field.bits) return &field;
  }
  return nullptr;
}

// One byte shared by several fields, highest bit on the left: "a a a a b c d e   a toRobotId, b toColor …".
std::string shared_byte(const Message& message, int byte) {
  std::vector<const Field*> seen;
  std::string cells;
  std::string names;
  for (int column = 7; column >= 0; --column) {
    const int bit = 8 * byte + (message.bit_order == BitOrder::kLsbFirst ? column : 7 - column);
    const Field* field = field_at(message, bit);
    if (seen.empty() || seen.back() != field) {
      seen.push_back(field);
      names += (names.empty() ? "" : ", ") + std::string(1, static_cast<char>('a' + seen.size() - 1)) + " " +
               text(field->name);
    }
    cells += std::string(1, static_cast<char>('a' + seen.size() - 1)) + " ";
  }
  return cells + "  " + names;
}

// The fields of a protobuf message from top to bottom: those that are not 0 follow each other like this.
std::string protobuf_picture(const Message& message) {
  std::string out = "```\nkey      content\n";
  for (const Field& field : message.fields) {
    const int key = field.tag << 3 | (field.kind == FieldKind::kFloat32 ? 5 : 0);
    out += padded(hex_text(static_cast<std::uint64_t>(key)), 9) + "[" + tag_form(field) + "] " +
           text(field.name) + "\n";
  }
  return out + "```\n";
}

// The bytes of a packet from top to bottom, starting at `first_byte`.
std::string byte_picture(const Message& message, int first_byte) {
  if (message.fields.front().tag != 0) return protobuf_picture(message);
  std::string out = "```\nbyte     7 6 5 4 3 2 1 0\n";
  int byte = first_byte;
  while (byte < message.size_bytes) {
    const Field* field = field_at(message, 8 * byte);
    if (field != nullptr && is_whole_bytes(*field)) {
      const int last = byte + field->bits / 8 - 1;
      const std::string bytes =
          last == byte ? std::to_string(byte) : std::to_string(byte) + "-" + std::to_string(last);
      out += padded(bytes, 9) + "[---------------] " + text(field->name) + "\n";
      byte = last + 1;
    } else {
      out += padded(std::to_string(byte), 9) + shared_byte(message, byte) + "\n";
      ++byte;
    }
  }
  if (message.text_tail) out += padded(std::to_string(byte) + "...", 9) + "text\n";
  return out + "```\n";
}

std::string_view order_text(BitOrder order) {
  return order == BitOrder::kLsbFirst
             ? "Bit 0 is the lowest bit of byte 0; fields run upward, numbers are little-endian."
             : "Bit 0 is the highest bit of byte 0; fields run on across bytes, numbers are big-endian.";
}

bool has_two_orders(const RadioFormat& format) {
  return std::any_of(format.messages.begin(), format.messages.end(), [&](const Message& each) {
    return each.bit_order != format.messages.front().bit_order;
  });
}

// The most bytes that a protobuf message has; else those of its table.
std::string size_text(const Message& message) {
  if (message.fields.front().tag == 0) return std::to_string(message.size_bytes) + " bytes";
  return "up to " + std::to_string(most_protobuf_bytes(message)) + " bytes";
}

std::string message_section(const RadioFormat& format, const Message& message) {
  const Message* head = head_of(format, message);
  const std::size_t first = head == nullptr ? 0 : head->fields.size();
  std::string out = "\n## " + text(message.name) + "\n\n" + text(message.what) + " Type " +
                    hex_text(message.type) + ", " + size_text(message) +
                    (message.text_tail ? " and the text" : "") + ", " +
                    text(direction_text(message.direction)) + ".\n";
  if (has_two_orders(format)) out += text(order_text(message.bit_order)) + "\n";
  if (head != nullptr) {
    out += "\nBytes 0 to " + std::to_string(head->size_bytes - 1) + " as in " + text(head->name) +
           ", with type " + hex_text(message.type) + ".\n";
  }
  if (first < message.fields.size() || message.text_tail) {
    out += "\n" + byte_picture(message, head == nullptr ? 0 : head->size_bytes);
  }
  if (first == message.fields.size()) return out;
  out += "\n| field | byte.bit+bits | values | unit | meaning |\n| --- | --- | --- | --- | --- |\n";
  for (const Field& field : message.fields.subspan(first)) {
    const std::string only_if = field.only_if.empty() ? "" : "; only if `" + text(field.only_if) + "`";
    out += "| `" + text(field.name) + "` | " + place_text(field) + " | " + kind_text(field, message) +
           (field.names.empty() ? "" : ": " + text(field.names)) + only_if + " | " + text(field.unit) +
           " | " + text(field.what) + " |\n";
  }
  return out;
}

std::string size_cell(const Message& message) {
  if (message.fields.front().tag != 0) return size_text(message);
  return std::to_string(message.size_bytes) + (message.text_tail ? " + text" : "");
}

}  // namespace

std::string emit_markdown(const RadioFormat& format) {
  std::string out = "# " + text(format.title) + "\n\n";
  out += "Id `" + text(format.id) + "`. Generated from the packet tables by `omnihil formats " +
         text(format.id) + "`; do not edit.\n\n";
  out += "- Source: " + text(format.source) + ".\n";
  out += "- Carrier: " + carrier_text(format.carrier) + ".\n";
  out += "- Longest frame on the wire: " + std::to_string(format.max_frame_bytes) + " bytes.\n";
  if (format.framing == Framing::kProtobuf) {
    out +=
        "- A frame: length in one byte, then for each packet 0Ah, its length, and its fields that are not 0 "
        "in the order "
        "of their numbers.\n";
  }
  out += has_two_orders(format) ? "- Packets differ in their bit order; each says which it has.\n"
                                : "- " + text(order_text(format.messages.front().bit_order)) + "\n";
  out += "- Bits named `padding` and fields called unknown or not used are kept as they are.\n\n";
  out += "## Notes\n\n" + text(format.notes) + "\n## Packets\n\n";
  out += "| packet | type | bytes | direction | what for |\n| --- | --- | --- | --- | --- |\n";
  for (const Message& message : format.messages) {
    out += "| `" + text(message.name) + "` | " + hex_text(message.type) + " | " + size_cell(message) + " | " +
           text(direction_text(message.direction)) + " | " + text(message.what) + " |\n";
  }
  for (const Message& message : format.messages) out += message_section(format, message);
  return out;
}

}  // namespace omnihil
