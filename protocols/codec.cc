#include "protocols/codec.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

namespace omnihil {
namespace {

constexpr std::uint64_t mask(int bits) { return bits >= 64 ? ~0ull : (1ull << bits) - 1; }

// Where bit `bit` of the message stands: the byte, and its place in the byte counted from the lowest.
struct BitPlace {
  std::size_t byte;
  int shift;
};
constexpr BitPlace place_of(int bit, BitOrder order) {
  const int in_byte = bit % 8;
  return {static_cast<std::size_t>(bit / 8), order == BitOrder::kMsbFirst ? 7 - in_byte : in_byte};
}

PacketError contradiction(const Field& field) {
  if (field.kind == FieldKind::kType) return PacketError::kUnknownType;
  if (field.kind == FieldKind::kLength) return PacketError::kLength;
  if (field.cause == ConstCause::kVersion) return PacketError::kVersion;
  return field.cause == ConstCause::kAddress ? PacketError::kAddress : PacketError::kConstant;
}

// What a checksum's field must hold. Where it stands inside its own bytes it counts as 0.
std::uint64_t sum_of(const Field& field, BitOrder order, std::span<const std::uint8_t> packet) {
  const auto first = static_cast<std::size_t>(field.bit / 8);
  const int until = field.check->until;
  const auto end =
      until > 0 ? static_cast<std::size_t>(until) : packet.size() - static_cast<std::size_t>(-until);
  std::array<std::uint8_t, 1024> others;
  if (first < static_cast<std::size_t>(field.check->from) || first >= end || packet.size() > others.size())
    return field.check->of(packet);
  std::copy(packet.begin(), packet.end(), others.begin());
  write_bits(others, field.bit, field.bits, order, 0);
  return field.check->of(std::span<const std::uint8_t>(others).first(packet.size()));
}

bool is_limited(const Field& field) { return field.lo != field.hi; }

PacketError check_decoded(const Field& field, const Message& message, std::size_t packet_bytes,
                          const Value& value) {
  switch (field.kind) {
    case FieldKind::kConst:
    case FieldKind::kType:
    case FieldKind::kLength:
      return value.raw == required_raw(field, message, packet_bytes) ? PacketError::kNone
                                                                     : contradiction(field);
    case FieldKind::kFloat32:
      if (!std::isfinite(value.number)) return PacketError::kNotFinite;
      [[fallthrough]];
    case FieldKind::kInteger:
      if (is_limited(field) && (value.number < field.lo || value.number > field.hi))
        return PacketError::kRange;
      return PacketError::kNone;
    case FieldKind::kRanged32:
    case FieldKind::kScaled:
    case FieldKind::kReserved:
    case FieldKind::kChecksum:
      return PacketError::kNone;
  }
  return PacketError::kNone;
}

// The content that stands for an integer, the plus sign for zero.
std::uint64_t content_of(const Field& field, std::int64_t integer) {
  if (field.sign == Sign::kMagnitude && integer < 0) {
    return static_cast<std::uint64_t>(-integer) | (1ull << (field.bits - 1));
  }
  return static_cast<std::uint64_t>(integer) & mask(field.bits);
}

// Smallest integer, and the first above the largest, that the width and the sign allow.
struct Ends {
  double lowest;
  double end;
};
Ends ends_of(const Field& field) {
  if (field.kind == FieldKind::kReserved || field.sign == Sign::kNone)
    return {0.0, std::ldexp(1.0, field.bits)};
  const double half = std::ldexp(1.0, field.bits - 1);
  return {field.sign == Sign::kMagnitude ? 1.0 - half : -half, half};
}

PacketError encode_integer(const Field& field, const Value& value, std::uint64_t& raw) {
  if (!std::isfinite(value.number)) return PacketError::kNotFinite;
  const Ends ends = ends_of(field);
  if (value.number < ends.lowest || value.number != std::floor(value.number)) return PacketError::kRange;
  // A wide field's largest values all round to 2^bits as a double; `raw` then still holds the exact one.
  if (value.raw != 0 && value.raw <= mask(field.bits) && field_number(field, value.raw) == value.number) {
    raw = value.raw;
  } else if (value.number < ends.end) {
    raw = field.sign == Sign::kNone || field.kind == FieldKind::kReserved
              ? static_cast<std::uint64_t>(value.number)
              : content_of(field, static_cast<std::int64_t>(value.number));
  } else {
    return PacketError::kRange;
  }
  const bool outside = is_limited(field) && (value.number < field.lo || value.number > field.hi);
  return outside ? PacketError::kRange : PacketError::kNone;
}

PacketError encode_float(const Field& field, double number, std::uint64_t& raw) {
  if (!std::isfinite(number)) return PacketError::kNotFinite;
  const auto value = static_cast<float>(number);
  if (!std::isfinite(value)) return PacketError::kRange;
  if (is_limited(field) && (value < static_cast<float>(field.lo) || value > static_cast<float>(field.hi))) {
    return PacketError::kRange;
  }
  raw = std::bit_cast<std::uint32_t>(value);
  return PacketError::kNone;
}

PacketError encode_ranged(const Field& field, const Value& value, std::uint64_t& raw) {
  if (!std::isfinite(value.number)) return PacketError::kNotFinite;
  const auto number = static_cast<float>(value.number);
  const bool inside = number >= static_cast<float>(field.lo) && number <= static_cast<float>(field.hi);
  if (value.raw != 0 && value.raw <= mask(field.bits) && ranged_value(field, value.raw) == number) {
    raw = value.raw;  // decoded by this rule: back to the same bits, also where rounding passes the end
    return PacketError::kNone;
  }
  if (!inside) return PacketError::kRange;
  raw = ranged_raw(field, number);
  return PacketError::kNone;
}

// The number less whole spans, from lo up to below hi: x - (hi - lo) floor((x - lo) / (hi - lo)) in float32.
float wrapped(const Field& field, double number) {
  const auto lo = static_cast<float>(field.lo);
  const float span = static_cast<float>(field.hi) - lo;
  const auto x = static_cast<float>(number);
  const float away = x - lo;
  const float turns = std::floor(away / span);
  const float taken = span * turns;
  return x - taken;
}

// The content that says that there is no number.
std::uint64_t no_number(const Field& field) {
  return field.sign == Sign::kTwosComplement ? 1ull << (field.bits - 1) : 0;
}

PacketError encode_scaled(const Field& field, const Value& value, std::uint64_t& raw) {
  if (field.scale->none_at_lowest && std::isnan(value.number)) {
    raw = no_number(field);
    return PacketError::kNone;
  }
  if (!std::isfinite(value.number)) return PacketError::kNotFinite;
  if (value.raw <= mask(field.bits) && field_number(field, value.raw) == value.number) {
    raw = value.raw;  // decoded by this rule: back to the same bits
    return PacketError::kNone;
  }
  // Ends are often multiples of pi, which teams hold as float32.
  const Beyond beyond = field.scale->beyond;
  const double given = beyond == Beyond::kWrapped ? double{wrapped(field, value.number)} : value.number;
  const auto number = static_cast<float>(given);
  const bool below = number < static_cast<float>(field.lo);
  const bool above = number > static_cast<float>(field.hi);
  if ((below || above) && beyond == Beyond::kRefused) return PacketError::kRange;
  raw = content_of(field, field.scale->count(field, below ? field.lo : above ? field.hi : given));
  return PacketError::kNone;
}

// A checksum by its rule: 0 or the right one may be given.
PacketError fill_in_checksum(const Field& field, BitOrder order, double given,
                             std::span<std::uint8_t> packet) {
  const std::uint64_t sum = field.check->of(packet);
  write_bits(packet, field.bit, field.bits, order, sum);
  return given == 0.0 || given == static_cast<double>(sum) ? PacketError::kNone : PacketError::kChecksum;
}

PacketError encode_field(const Field& field, const Message& message, std::size_t packet_bytes,
                         const Value& value, std::uint64_t& raw) {
  switch (field.kind) {
    case FieldKind::kConst:
    case FieldKind::kType:
    case FieldKind::kLength:
      raw = required_raw(field, message, packet_bytes);
      if (raw > mask(field.bits)) return PacketError::kTooLong;
      return value.number == 0.0 || value.number == static_cast<double>(raw) ? PacketError::kNone
                                                                             : contradiction(field);
    case FieldKind::kInteger:
    case FieldKind::kReserved:
      return encode_integer(field, value, raw);
    case FieldKind::kFloat32:
      return encode_float(field, value.number, raw);
    case FieldKind::kRanged32:
      return encode_ranged(field, value, raw);
    case FieldKind::kScaled:
      return encode_scaled(field, value, raw);
    case FieldKind::kChecksum:
      raw = 0;
      return PacketError::kNone;
  }
  return PacketError::kNone;
}

// True where the flag on which the field depends is 0.
bool says_nothing(const Field& field, const Values& values) {
  return !field.only_if.empty() && values.number_or(field.only_if, 1.0) == 0.0;
}

// The content of a field that says nothing: 0, but what was decoded goes back as it was.
std::uint64_t content_of_nothing(const Field& field, const Value& value) {
  const bool was_decoded = std::isnan(value.number) || field_number(field, value.raw) == value.number;
  return was_decoded ? value.raw & mask(field.bits) : 0;
}

}  // namespace

std::uint64_t read_bits(std::span<const std::uint8_t> bytes, int bit, int bits, BitOrder order) {
  std::uint64_t raw = 0;
  for (int i = 0; i < bits; ++i) {
    const BitPlace place = place_of(bit + i, order);
    const std::uint64_t one = (bytes[place.byte] >> place.shift) & 1u;
    raw |= one << (order == BitOrder::kMsbFirst ? bits - 1 - i : i);
  }
  return raw;
}

void write_bits(std::span<std::uint8_t> bytes, int bit, int bits, BitOrder order, std::uint64_t raw) {
  for (int i = 0; i < bits; ++i) {
    const BitPlace place = place_of(bit + i, order);
    const auto one = static_cast<unsigned>(raw >> (order == BitOrder::kMsbFirst ? bits - 1 - i : i)) & 1u;
    const unsigned others = bytes[place.byte] & ~(1u << place.shift);
    bytes[place.byte] = static_cast<std::uint8_t>(others | one << place.shift);
  }
}

float ranged_scale(const Field& field) {
  // scale = (hi - lo) / (2^bits - 1), to 16 decimals, as float32
  const double scale = (field.hi - field.lo) / static_cast<double>(mask(field.bits));
  return static_cast<float>(std::nearbyint(scale * 1e16) / 1e16);
}

float ranged_value(const Field& field, std::uint64_t raw) {
  // value = raw * scale + lo
  const float product = static_cast<float>(static_cast<std::uint32_t>(raw)) * ranged_scale(field);
  return product + static_cast<float>(field.lo);
}

std::uint64_t ranged_raw(const Field& field, float value) {
  // raw = trunc((value - lo) / scale)
  const float distance = value - static_cast<float>(field.lo);
  const float counts = distance / ranged_scale(field);
  return static_cast<std::uint64_t>(counts) & mask(field.bits);
}

std::int64_t integer_of(const Field& field, std::uint64_t raw) {
  const bool negative = field.sign != Sign::kNone && (raw >> (field.bits - 1) & 1u) != 0;
  if (!negative) return static_cast<std::int64_t>(raw);
  if (field.sign == Sign::kMagnitude) return -static_cast<std::int64_t>(raw & mask(field.bits - 1));
  return static_cast<std::int64_t>(raw | ~mask(field.bits));
}

double field_step(const Field& field) {
  if (field.kind == FieldKind::kRanged32) return static_cast<double>(ranged_scale(field));
  if (field.kind == FieldKind::kScaled) {
    // Over all counts: between two neighbours a team's float32 would show.
    const auto counts =
        static_cast<std::int64_t>(mask(field.sign == Sign::kNone ? field.bits : field.bits - 1));
    return (field.scale->number(field, counts) - field.scale->number(field, 0)) / static_cast<double>(counts);
  }
  return field.kind == FieldKind::kInteger ? 1.0 : 0.0;
}

std::uint64_t required_raw(const Field& field, const Message& message, std::size_t packet_bytes) {
  if (field.kind == FieldKind::kType) return (message.type >> field.constant) & mask(field.bits);
  if (field.kind == FieldKind::kLength) return packet_bytes - field.constant;
  return field.constant;
}

double field_number(const Field& field, std::uint64_t raw) {
  if (field.kind == FieldKind::kScaled) {
    if (field.scale->none_at_lowest && raw == no_number(field))
      return std::numeric_limits<double>::quiet_NaN();
    return field.scale->number(field, integer_of(field, raw));
  }
  if (field.kind == FieldKind::kInteger && field.sign != Sign::kNone) {
    return static_cast<double>(integer_of(field, raw));
  }
  if (field.kind == FieldKind::kRanged32) return ranged_value(field, raw);
  if (field.kind == FieldKind::kFloat32) return std::bit_cast<float>(static_cast<std::uint32_t>(raw));
  return static_cast<double>(raw);
}

Value nearest_value(const Field& field, double number) {
  if (!std::isfinite(number)) number = 0.0;
  if (field.kind == FieldKind::kRanged32) {
    // A 32-bit field's upper end wraps in float32, hence raw and number.
    const double top = std::fmin(field.hi, static_cast<double>(ranged_value(field, mask(field.bits))));
    if (number >= top) return {.number = ranged_value(field, mask(field.bits)), .raw = mask(field.bits)};
    return {.number = std::fmax(number, field.lo), .raw = 0};
  }
  if (field.kind == FieldKind::kScaled && field.scale->beyond == Beyond::kWrapped)
    return {.number = number, .raw = 0};
  const bool is_float = field.kind == FieldKind::kFloat32;
  const bool is_integer = !is_float && field.kind != FieldKind::kScaled;
  double lo = field.lo;
  double hi = field.hi;
  if (!is_limited(field)) {
    const Ends ends = ends_of(field);
    lo = is_float ? -std::numeric_limits<float>::max() : ends.lowest;
    hi = is_float ? std::numeric_limits<float>::max() : ends.end - 1.0;
  }
  return {.number = std::clamp(is_integer ? std::floor(number) : number, lo, hi), .raw = 0};
}

FieldFault decode_fields(const Message& message, std::span<const std::uint8_t> bytes,
                         std::size_t packet_bytes, Values& out) {
  out.message = &message;
  // Damage is named before what it has made of the fields.
  for (const Field& field : message.fields) {
    if (field.kind != FieldKind::kChecksum || field.check == nullptr) continue;
    const std::uint64_t raw = read_bits(bytes, field.bit, field.bits, message.bit_order);
    if (sum_of(field, message.bit_order, bytes.first(packet_bytes)) != raw)
      return {PacketError::kChecksum, field.name};
  }
  for (std::size_t i = 0; i < message.fields.size(); ++i) {
    const Field& field = message.fields[i];
    Value& value = out.fields[i];
    value.raw = read_bits(bytes, field.bit, field.bits, message.bit_order);
    value.number = field_number(field, value.raw);
    if (says_nothing(field, out)) {
      value.number = std::numeric_limits<double>::quiet_NaN();
      continue;
    }
    const PacketError error = check_decoded(field, message, packet_bytes, value);
    if (error != PacketError::kNone) return {error, field.name};
  }
  return {};
}

PacketError field_fault(const Field& field, const Message& message, std::size_t packet_bytes,
                        const Value& value) {
  std::uint64_t raw = 0;
  if (!field.only_if.empty() && std::isnan(value.number)) return PacketError::kNone;
  return encode_field(field, message, packet_bytes, value, raw);
}

FieldFault encode_fields(const Values& values, std::size_t packet_bytes, std::span<std::uint8_t> bytes) {
  const Message& message = *values.message;
  for (std::size_t i = 0; i < message.fields.size(); ++i) {
    const Field& field = message.fields[i];
    std::uint64_t raw = 0;
    PacketError error = PacketError::kNone;
    if (says_nothing(field, values)) {
      raw = content_of_nothing(field, values.fields[i]);
    } else {
      error = encode_field(field, message, packet_bytes, values.fields[i], raw);
    }
    if (error != PacketError::kNone) return {error, field.name};
    write_bits(bytes, field.bit, field.bits, message.bit_order, raw);
  }
  for (std::size_t i = 0; i < message.fields.size(); ++i) {
    const Field& field = message.fields[i];
    if (field.kind != FieldKind::kChecksum || field.check == nullptr) continue;
    const PacketError error =
        fill_in_checksum(field, message.bit_order, values.fields[i].number, bytes.first(packet_bytes));
    if (error != PacketError::kNone) return {error, field.name};
  }
  return {};
}

}  // namespace omnihil
