// Where a variable of an AVR's ELF file lies. An AVR has three memories that each count from 0; avr-gcc keeps them
// apart by what it adds: nothing to flash, 0x800000 to data memory, 0x810000 to the EEPROM, more to fuses and lock bits.
//
//   std::optional<AvrSpace> avr = AvrSpace::of(elf);       // nothing: the file is for another machine
//   std::string why = avr->why_no_data(0x68);              // "lies in flash (PROGMEM), which is not read"
#pragma once
#include <gelf.h>

#include <cstdint>
#include <optional>
#include <set>
#include <string>

namespace omnihil {

class AvrSpace {
 public:
  static std::optional<AvrSpace> of(Elf* elf);
  // Empty: it is a variable in data memory.
  std::string why_no_data(std::uint64_t address) const;

 private:
  std::set<std::uint64_t> objects_;  // what the symbol table has in flash
  std::uint64_t data_begin_ = 0;  // of the lowest section in data memory; below it are the chip's registers
};

}  // namespace omnihil
