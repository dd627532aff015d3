#include "hil/variables/variable_value.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>

namespace omnihil {
namespace {

unsigned width_of(const DebugType& type, const VariablePlace& place) {
  return place.bits > 0 ? place.bits : static_cast<unsigned>(8 * std::min<std::uint64_t>(type.bytes, 8));
}

std::uint64_t mask_of(unsigned bits) {
  return bits >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << bits) - 1;
}

bool is_signed(const DebugType& type) {
  return type.kind == ValueKind::kSigned || (type.kind == ValueKind::kEnumeration && type.negative);
}

// Bit by bit: a field of 64 bits that does not begin at a byte lies in nine.
std::uint64_t bits_of(const DebugType& type, const VariablePlace& place, std::span<const std::uint8_t> raw) {
  std::uint64_t word = 0;
  const unsigned width = width_of(type, place);
  for (unsigned i = 0; i < width; ++i) {
    const std::size_t at = place.bit_offset + i;
    if (at / 8 < raw.size()) word |= std::uint64_t{raw[at / 8] >> (at % 8) & 1u} << i;
  }
  return word;
}

std::int64_t with_sign(std::uint64_t word, unsigned width) {
  const bool negative = width > 0 && (word >> (width - 1) & 1) != 0;
  return static_cast<std::int64_t>(negative ? word | ~mask_of(width) : word);
}

void put_bits(std::uint64_t word, const DebugType& type, const VariablePlace& place,
              std::span<std::uint8_t> raw) {
  const unsigned width = width_of(type, place);
  for (unsigned i = 0; i < width; ++i) {
    const std::size_t at = place.bit_offset + i;
    const auto bit = static_cast<std::uint8_t>(1u << (at % 8));
    if (at / 8 >= raw.size()) return;
    raw[at / 8] = static_cast<std::uint8_t>((word >> i & 1) != 0 ? raw[at / 8] | bit : raw[at / 8] & ~bit);
  }
}

double real_of(std::uint64_t word, std::uint64_t bytes) {
  return bytes == 4 ? static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(word)))
                    : std::bit_cast<double>(word);
}

bool whole(std::string_view text, std::uint64_t& value, int base = 10) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, base);
  return error == std::errc{} && end == text.data() + text.size();
}

bool real(std::string_view text, double& value) {  // "nan" and "inf", too
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && end == text.data() + text.size();
}

// A whole number as its sign and its size, hexadecimal too.
bool integer(std::string_view text, bool& negative, std::uint64_t& size) {
  negative = text.starts_with('-');
  if (negative) text.remove_prefix(1);
  const bool hex = text.starts_with("0x") || text.starts_with("0X");
  return hex ? whole(text.substr(2), size, 16) : whole(text, size);
}

}  // namespace

double number_of_value(const DebugType& type, const VariablePlace& place, std::span<const std::uint8_t> raw) {
  const std::uint64_t word = bits_of(type, place, raw);
  if (type.kind == ValueKind::kReal) return real_of(word, type.bytes);
  if (type.kind == ValueKind::kBool) return word != 0 ? 1.0 : 0.0;
  if (is_signed(type)) return static_cast<double>(with_sign(word, width_of(type, place)));
  return static_cast<double>(word);
}

std::string text_of_value(const DebugType& type, const VariablePlace& place,
                          std::span<const std::uint8_t> raw) {
  const std::uint64_t word = bits_of(type, place, raw);
  const std::int64_t number = with_sign(word, width_of(type, place));
  switch (type.kind) {
    case ValueKind::kReal:
      return type.bytes == 4 ? fmt::format("{}", static_cast<float>(real_of(word, 4)))
                             : fmt::format("{}", real_of(word, 8));
    case ValueKind::kBool:
      return word != 0 ? "true" : "false";
    case ValueKind::kPointer:
      return fmt::format("0x{:0{}x}", word, 2 * type.bytes);
    case ValueKind::kEnumeration:
      for (const auto& [name, value] : type.enumerators) {
        if (value == (type.negative ? number : static_cast<std::int64_t>(word))) return name;
      }
      break;
    default:
      break;
  }
  return is_signed(type) ? fmt::format("{}", number) : fmt::format("{}", word);
}

std::string value_bytes(std::string_view text, const DebugType& type, const VariablePlace& place,
                        std::span<std::uint8_t> raw) {
  if (!place.writable || !place.constant.empty()) return "is a constant: it cannot be set";
  const unsigned width = width_of(type, place);
  bool negative = false;
  std::uint64_t size = 0;
  if (type.kind == ValueKind::kReal) {
    double value = 0.0;
    if (!real(text, value))
      return fmt::format("\"{}\" is not allowed for a {}: allowed: a number, nan, inf", text, type.name);
    put_bits(type.bytes == 4 ? std::bit_cast<std::uint32_t>(static_cast<float>(value))
                             : std::bit_cast<std::uint64_t>(value),
             type, place, raw);
    return {};
  }
  if (type.kind == ValueKind::kEnumeration) {
    for (const auto& [name, value] : type.enumerators) {
      if (name != text) continue;
      put_bits(static_cast<std::uint64_t>(value), type, place, raw);
      return {};
    }
  }
  if (type.kind == ValueKind::kBool && (text == "true" || text == "false")) {
    put_bits(text == "true" ? 1 : 0, type, place, raw);
    return {};
  }
  const std::uint64_t most = type.kind == ValueKind::kBool ? 1
                             : is_signed(type)             ? mask_of(width - 1)
                                                           : mask_of(width);
  const std::uint64_t least = is_signed(type) ? most + 1 : 0;  // as a size
  if (!integer(text, negative, size) || size > (negative ? least : most)) {
    std::string names;
    for (const auto& [name, value] : type.enumerators) names += (names.empty() ? "" : ", ") + name;
    return fmt::format("\"{}\" is not allowed for a {}{}: allowed: {} to {}{}{}", text, type.name,
                       place.bits > 0 ? fmt::format(" of {} bits", place.bits) : "",
                       least > 0 ? fmt::format("-{}", least) : "0", most, names.empty() ? "" : "; ", names);
  }
  put_bits(negative ? ~size + 1 : size, type, place, raw);
  return {};
}

}  // namespace omnihil
