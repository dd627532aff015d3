// Rows of UBC Thunderbots' frames between the robot's computer and a motor board, in both directions.
//
//   AA BB CC · sequence · opcode, or what an answer holds · four bytes (big-endian) · CRC-8/AUTOSAR of all before it
//
// Source: UBC-Thunderbots/MDv6_Firmware (Src/interface.c, frames of ten bytes), UBC-Thunderbots/Software 0139338.
#pragma once
#include <array>

#include "protocols/field_rows.h"

namespace omnihil::thunderbots {

inline constexpr int kBytes = 10;
inline constexpr ChecksumRule kCrc{.kind = &kCrc8Autosar, .until = -1};

inline constexpr std::array kHead{
    enveloped(constant("delimiter[0]", 8, 0xAA, "begins each frame")),
    enveloped(constant("delimiter[1]", 8, 0xBB, "begins each frame")),
    enveloped(constant("delimiter[2]", 8, 0xCC, "begins each frame")),
    number("sequence", 8, "", "counts frames; that of the latest one taken, in an answer"),
};
inline constexpr std::array kTail{enveloped(checksum("crc", 8, "of all before it", &kCrc))};

constexpr Field word(std::string_view name, std::string_view unit, std::string_view what) {
  return signed_number(name, 16, unit, what);
}
template <std::size_t kCount>
constexpr auto frame(std::string_view code, std::string_view what, const std::array<Field, kCount>& data) {
  return in_order(kHead, std::array{enveloped(type_code(code, 8, what))}, data, kTail);
}
constexpr Message row(std::string_view name, std::uint32_t type, std::span<const Field> fields,
                      std::string_view what) {
  return {name, type, kBytes, false, Direction::kInside, BitOrder::kMsbFirst, fields, what};
}

}  // namespace omnihil::thunderbots
