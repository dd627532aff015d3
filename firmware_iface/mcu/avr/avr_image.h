// What an AVR is programmed with: flash and EEPROM, from an ELF file of avr-gcc or from Intel HEX.
//
//   AvrImage image;
//   std::vector<std::string> problems;
//   if (!read_avr_image(bytes, image, problems)) …
//
// ELF: segments by their load address, the EEPROM at 0x810000 as avr-gcc has it; fuses, lock bits and
// signature are left out. HEX: flash alone, record types 0 to 5. Nothing in a file is trusted.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "firmware_iface/mcu/machine/elf_image.h"

namespace omnihil::mcu {

// What avr-gcc adds in an ELF file to addresses of memories that each count from 0; nothing to those of the flash.
inline constexpr std::uint32_t kAvrData = 0x800000, kAvrEeprom = 0x810000, kAvrFuses = 0x820000;

struct AvrImage {
  std::vector<ElfSegment> flash, eeprom;
  std::optional<std::uint32_t> main;  // where the function is, in bytes of the flash; HEX does not say
};

bool is_avr_image(std::span<const std::uint8_t> file);
bool read_avr_image(std::span<const std::uint8_t> file, AvrImage& image, std::vector<std::string>& problems);

}  // namespace omnihil::mcu
