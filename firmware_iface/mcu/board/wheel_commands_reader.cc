#include "firmware_iface/mcu/board/wheel_commands_reader.h"

#include <fmt/format.h>

#include <cmath>

namespace omnihil::mcu {
namespace {

constexpr std::string_view kPath = "wheel_commands";

const MotorBusKind* read_dialect(const toml::table& t, BoardKeys& keys) {
  std::string dialects;
  for (const MotorBusKind* bus : motor_buses()) {
    if (bus->main_board.dialect.empty()) continue;
    dialects += std::string(bus->main_board.dialect) + ", ";
  }
  const MotorBusKind* bus = find_dialect(keys.text(t, std::string(kPath), "dialect").value_or(""));
  if (bus == nullptr) {
    keys.wrong(t, std::string(kPath), "dialect", t.contains("dialect") ? "unknown" : "missing",
               dialects + "or [[wheel_commands.frame]] and period_ms");
  }
  return bus;
}

WordField read_field(const toml::table& t, const std::string& path, BoardKeys& keys, const WordFrame& frame,
                     int motors) {
  keys.only(t, path, {"at", "type", "big_endian", "value", "per_rad_s", "wheel"});
  WordField field;
  const auto type = word_type(keys.text(t, path, "type").value_or(""));
  if (!type)
    keys.wrong(t, path, "type", t.contains("type") ? "unknown" : "missing",
               "u8, i8, u16, i16, u32, i32, f32");
  field.type = type.value_or(WordType::kU8);
  if (!t.contains("at")) keys.missing(t, path, "at", "the field's first byte, from 0");
  const auto last = static_cast<std::int64_t>(frame.bytes) - static_cast<std::int64_t>(bytes_of(field.type));
  field.at = static_cast<std::size_t>(keys.whole(t, path, "at", 0, last).value_or(0));
  field.big_endian = keys.flag(t, path, "big_endian").value_or(false);
  field.speed = t.contains("per_rad_s");
  if (field.speed == t.contains("value"))
    keys.wrong(t, path, field.speed ? "value" : "at",
               field.speed ? "beside per_rad_s" : "neither value nor per_rad_s",
               "a value that stays, or per_rad_s: what 1 rad/s of the motor is");
  // A number that stays has to fit its type; a speed ends at the type's bounds.
  double lower = -1e10, upper = 1e10;
  if (!field.speed && field.type != WordType::kF32) {
    const bool is_signed = keys.text(t, path, "type")->starts_with('i');
    const double span = std::ldexp(1.0, 8 * static_cast<int>(bytes_of(field.type)));
    lower = is_signed ? -0.5 * span : 0.0;
    upper = (is_signed ? 0.5 : 1.0) * span - 1.0;
  }
  field.value = keys.number(t, path, field.speed ? "per_rad_s" : "value", lower, upper).value_or(0.0);
  if (frame.each_wheel && t.contains("wheel"))
    keys.wrong(t, path, "wheel", "in a frame for each wheel", "each = \"board\"");
  field.wheel = static_cast<int>(keys.whole(t, path, "wheel", 0, motors - 1).value_or(0));
  return field;
}

WordFrame read_frame(const toml::table& t, const std::string& path, BoardKeys& keys, bool serial,
                     int motors) {
  keys.only(t, path, {"each", "id", "extended", "bytes", "field"});
  WordFrame frame;
  const std::string each = keys.text(t, path, "each").value_or("wheel");
  frame.each_wheel = each == "wheel";
  if (each != "wheel" && each != "board") keys.wrong(t, path, "each", "unknown", "wheel, board");
  frame.extended = keys.flag(t, path, "extended").value_or(false);
  constexpr std::int64_t kLastStandard = 0x7FF, kLastExtended = 0x1FFFFFFF;
  const std::int64_t last = (frame.extended ? kLastExtended : kLastStandard) - (kWheels - 1);
  if (!serial && !t.contains("id")) keys.missing(t, path, "id", "of the robot's first wheel");
  if (serial && t.contains("id")) keys.wrong(t, path, "id", "on a serial port", "frames without one");
  frame.id = static_cast<std::uint32_t>(keys.whole(t, path, "id", 0, last).value_or(0));
  const std::int64_t most = serial ? static_cast<std::int64_t>(BusFrame::kCapacity) : 8;
  if (!t.contains("bytes")) keys.missing(t, path, "bytes", fmt::format("1 to {}", most));
  frame.bytes = static_cast<std::uint8_t>(keys.whole(t, path, "bytes", 1, most).value_or(most));
  for (const auto& [field, name] : keys.tables(t, "field"))
    frame.fields.push_back(read_field(*field, path + "." + name, keys, frame, motors));
  return frame;
}

WheelWords read_words(const toml::table& t, BoardKeys& keys, bool serial, int motors) {
  const std::string path(kPath);
  WheelWords words;
  if (t.contains("dialect")) keys.wrong(t, path, "dialect", "beside frames", "one of the two");
  if (!t.contains("period_ms")) keys.missing(t, path, "period_ms", "between what the main board says");
  constexpr double kMs_ns = 1e6;
  words.period_ns = static_cast<std::int64_t>(keys.whole(t, path, "period_ms", 1, 1000).value_or(1) * kMs_ns);
  for (const auto& [frame, name] : keys.tables(t, "frame"))
    words.frames.push_back(read_frame(*frame, path + "." + name, keys, serial, motors));
  return words;
}

}  // namespace

WheelCommands read_wheel_commands(const toml::table& top, BoardKeys& keys, const BoardNames* names,
                                  int motors) {
  WheelCommands commands;
  const std::string path(kPath);
  const toml::node* node = top.get(kPath);
  if (node == nullptr) return commands;
  const toml::table* t = node->as_table();
  if (t == nullptr) {
    keys.wrong(top, "", kPath, "not a table", "[wheel_commands]");
    return commands;
  }
  if (top.contains("radio")) keys.wrong(top, "", kPath, "beside [radio]", "one of the two");
  keys.only(*t, path, {"dialect", "via", "reversed", "period_ms", "frame"});
  const bool own = t->contains("frame");
  if (!own) commands.bus = read_dialect(*t, keys);
  commands.via = keys.text(*t, path, "via").value_or("");
  commands.sign = keys.flag(*t, path, "reversed").value_or(false) ? -1.0 : 1.0;
  const bool is_can = names != nullptr && names->has_can(commands.via),
             is_serial = names != nullptr && names->has_serial(commands.via);
  if (own) {
    commands.words = read_words(*t, keys, is_serial, motors);
    commands.serial = is_serial;
    if (names != nullptr && !is_can && !is_serial)
      keys.wrong(*t, path, "via", t->contains("via") ? "no such port" : "missing",
                 names->serials() + ", " + names->cans());
    return commands;
  }
  if (commands.bus == nullptr || names == nullptr) return commands;
  commands.serial = commands.bus->carrier == BusCarrier::kUart;
  if (commands.serial ? !is_serial : !is_can) {
    keys.wrong(*t, path, "via", commands.serial ? "not a serial port of the chip" : "not a CAN of the chip",
               commands.serial ? names->serials() : names->cans());
  }
  return commands;
}

}  // namespace omnihil::mcu
