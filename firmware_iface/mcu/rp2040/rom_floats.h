// The floating-point functions of the RP2040's boot ROM, by their place in its two tables.
//
//   RomWords words{0x3FC00000, 0x3FC00000};        // 1.5, 1.5
//   rom_float(0, words);                           // words[0]: 3.0
//
// Law: RP2040 datasheet §2.8.3.2: operands in r0 to r3, results alike; rounded to nearest, denormal numbers are zero;
// conversions to integers go down and end at their bounds. The trigonometric functions' last bits may differ.
#pragma once
#include <array>
#include <cstdint>

namespace omnihil::mcu::rp2040 {

using RomWords = std::array<std::uint32_t, 4>;
inline constexpr unsigned kRomFloats = 32;

struct RomResult {
  unsigned words = 1;   // results, from r0 on
  unsigned cycles = 0;  // about
  int order = 2;        // of a comparison that leaves flags: -1, 0, 1; 2: none
};

RomResult rom_float(unsigned place, RomWords& words);
RomResult rom_double(unsigned place, RomWords& words);

}  // namespace omnihil::mcu::rp2040
