// What the bytes of a variable mean: as a number, as text, and back.
//
//   double integral = number_of_value(type, place, raw);          // of the place's bytes, little-endian
//   std::string text = text_of_value(type, place, raw);           // "0.25", "true", "kBraking", "0x20000010"
//   std::string problem = value_bytes("0.5", type, place, raw);   // raw: as it was, and as it is to be
//
// Numbers are doubles: whole ones beyond 2^53 lose their last bits, in text they do not.
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "hil/variables/variable_place.h"

namespace omnihil {

double number_of_value(const DebugType& type, const VariablePlace& place, std::span<const std::uint8_t> raw);
std::string text_of_value(const DebugType& type, const VariablePlace& place,
                          std::span<const std::uint8_t> raw);
// A number, true or false, an enumerator's name; bits beside a bit-field stay. Empty: done; else what is allowed.
std::string value_bytes(std::string_view text, const DebugType& type, const VariablePlace& place,
                        std::span<std::uint8_t> raw);

}  // namespace omnihil
