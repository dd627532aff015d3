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
  return {.name = name,
          .bits = bits,
          .kind = FieldKind::kInteger,
          .lo = lo,
          .hi = hi,
          .unit = unit,
          .what = what};
}
// The same with a sign: two's complement, or the highest bit alone.
constexpr Field signed_number(std::string_view name, int bits, std::string_view unit, std::string_view what,
                              double lo = 0.0, double hi = 0.0) {
  Field field = number(name, bits, unit, what, lo, hi);
  field.sign = Sign::kTwosComplement;
  return field;
}
constexpr Field sign_and_magnitude(std::string_view name, int bits, std::string_view unit,
                                   std::string_view what, double lo = 0.0, double hi = 0.0) {
  Field field = number(name, bits, unit, what, lo, hi);
  field.sign = Sign::kMagnitude;
  return field;
}
// The same row with words for its values; see Field::names.
constexpr Field named(std::string_view names, Field field) {
  field.names = names;
  return field;
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
// A constant of the packet tables' version, or that says whom a packet is for; see ConstCause.
constexpr Field version(Field field) {
  field.cause = ConstCause::kVersion;
  return field;
}
constexpr Field address(Field field) {
  field.cause = ConstCause::kAddress;
  return field;
}
constexpr Field type_code(std::string_view name, int bits, std::string_view what = "packet type") {
  return {.name = name, .bits = bits, .kind = FieldKind::kType, .what = what};
}
// The bits from `from_bit` on of the packet's type, where its code stands in several fields.
constexpr Field type_code_bits(std::string_view name, int bits, int from_bit, std::string_view what) {
  return {.name = name,
          .bits = bits,
          .kind = FieldKind::kType,
          .constant = static_cast<std::uint64_t>(from_bit),
          .what = what};
}
// `not_counted`: bytes of the packet that the length leaves out.
constexpr Field length(std::string_view name, int bits, std::string_view what,
                       std::uint64_t not_counted = 0) {
  return {.name = name,
          .bits = bits,
          .kind = FieldKind::kLength,
          .constant = not_counted,
          .unit = "bytes",
          .what = what};
}
constexpr Field checksum(std::string_view name, int bits, std::string_view what,
                         const ChecksumRule* rule = nullptr) {
  return {.name = name, .bits = bits, .kind = FieldKind::kChecksum, .check = rule, .what = what};
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
// A number in lo..hi by a team's own rule; `sign` is that of the integer that travels.
constexpr Field scaled(std::string_view name, int bits, Sign sign, const ScaleRule& rule, double lo,
                       double hi, std::string_view unit, std::string_view what) {
  return {.name = name,
          .bits = bits,
          .kind = FieldKind::kScaled,
          .sign = sign,
          .lo = lo,
          .hi = hi,
          .scale = &rule,
          .unit = unit,
          .what = what};
}
// The same row as the field of this number in a protobuf message; see Field::tag.
constexpr Field tagged(int tag, Field field) {
  field.tag = tag;
  return field;
}
// The same row as a part of the frame; see Field::envelope.
constexpr Field enveloped(Field field) {
  field.envelope = true;
  return field;
}

// The same row where it says something only while `flag` is not 0; see Field::only_if.
constexpr Field only_if(std::string_view flag, Field field) {
  field.only_if = flag;
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
