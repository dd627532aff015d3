// The parts of an ELF file that a microcontroller is loaded with, read from its bytes.
//
//   ElfImage image;
//   std::vector<std::string> problems;
//   if (!read_elf(bytes, image, problems)) …
//   image.address_of("main");
//
// 32-bit, little-endian executables for ARM or AVR. Nothing in the file is trusted: every offset is checked.
// Symbols are for reports and tests; a broken symbol table is no problem, the image then has fewer.
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace omnihil::mcu {

struct ElfSegment {
  std::uint32_t address;  // where it is loaded: the physical address
  std::vector<std::uint8_t> bytes;
};

struct ElfRange {  // of addresses that a segment occupies while the program runs
  std::uint32_t begin, bytes;
};

struct ElfImage {
  std::uint32_t entry = 0;
  std::vector<ElfSegment> segments;
  std::vector<ElfRange> occupied = {};
  std::map<std::string, std::uint32_t, std::less<>> symbols;
  std::map<std::uint32_t, std::string> functions;  // by address, bit 0 clear

  std::optional<std::uint32_t> address_of(std::string_view name) const;
  std::string function_at(std::uint32_t pc) const;  // "name+0x12", empty when none is known
};

enum class ElfMachine : std::uint16_t { kArm = 40, kAvr = 83 };

bool read_elf(std::span<const std::uint8_t> file, ElfImage& image, std::vector<std::string>& problems,
              ElfMachine machine = ElfMachine::kArm);

}  // namespace omnihil::mcu
