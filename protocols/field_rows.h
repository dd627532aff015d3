// Rows of a packet table, written in the order in which the bits travel; the places are computed.
//
//   constexpr auto kFields = in_order(std::array{type_code("header", 8), number("robot", 4, "", "receiver"),
//                                                reserved("spare", 4, "unused")});
//   static_assert(kFields[2].bit == 12);
#pragma once
#include <array>
#include <cstddef>

#include "protocols/field_table.h"

namespace omnihil {

// A plain integer. lo == hi: limited by its width alone.
constexpr Field number(std::string_view name, int bits, std::string_view unit, std::string_view what,
                       double lo = 0.0, double hi = 0.0) {
  return {
      .name = name, .bits = bits, .kind = FieldKind::kUint, .lo = lo, .hi = hi, .unit = unit, .what = what};
}
constexpr Field flag(std::string_view name, std::string_view what) { return number(name, 1, "", what); }
// A flag that the team's own programs take and give as true or false; their other flags are 0 and 1.
constexpr Field boolean(std::string_view name, std::string_view what) {
  return number(name, 1, "bool", what);
}
constexpr Field reserved(std::string_view name, int bits, std::string_view what) {
  return {.name = name, .bits = bits, .kind = FieldKind::kReserved, .what = what};
}
constexpr Field constant(std::string_view name, int bits, std::uint64_t value, std::string_view what) {
  return {.name = name, .bits = bits, .kind = FieldKind::kConst, .constant = value, .what = what};
}
constexpr Field type_code(std::string_view name, int bits, std::string_view what = "packet type") {
  return {.name = name, .bits = bits, .kind = FieldKind::kType, .what = what};
}
constexpr Field length(std::string_view name, int bits, std::string_view what) {
  return {.name = name, .bits = bits, .kind = FieldKind::kLength, .unit = "bytes", .what = what};
}
constexpr Field checksum(std::string_view name, int bits, std::string_view what) {
  return {.name = name, .bits = bits, .kind = FieldKind::kChecksum, .what = what};
}
constexpr Field float32(std::string_view name, std::string_view unit, std::string_view what) {
  return {.name = name, .bits = 32, .kind = FieldKind::kFloat32, .unit = unit, .what = what};
}
constexpr Field ranged(std::string_view name, int bits, double lo, double hi, std::string_view unit,
                       std::string_view what) {
  return {.name = name,
          .bits = bits,
          .kind = FieldKind::kRanged32,
          .lo = lo,
          .hi = hi,
          .unit = unit,
          .what = what};
}
// The same row as a part of the frame; see Field::envelope.
constexpr Field enveloped(Field field) {
  field.envelope = true;
  return field;
}

// The same row with what it tells a dongle; see FieldRole.
constexpr Field with_role(FieldRole role, Field field) {
  field.role = role;
  return field;
}
constexpr Message with_role(MessageRole role, Message message) {
  message.role = role;
  return message;
}
constexpr Message answered_by(std::uint32_t type, Message message) {
  message.answer_type = type;
  return message;
}

// Bits after the last field, up to the whole byte: not listed among the values, kept on a round trip.
constexpr Field padding(int bits) {
  return enveloped(reserved("padding", bits, "fills the last byte; sent as 0"));
}

// The lists one after another, each field starting where the one before ends.
template <std::size_t... kCounts>
constexpr auto in_order(const std::array<Field, kCounts>&... lists) {
  std::array<Field, (kCounts + ... + 0)> all{};
  std::size_t count = 0;
  int bit = 0;
  const auto append = [&](const auto& list) {
    for (const Field& field : list) {
      all[count] = field;
      all[count].bit = bit;
      bit += field.bits;
      ++count;
    }
  };
  (append(lists), ...);
  return all;
}

}  // namespace omnihil
