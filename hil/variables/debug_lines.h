// Which line of which source file an address of a program comes from, read with libdw from its ELF file.
//
//   for (const DebugLine& row : read_lines(bytes)) …        // by address; each is valid up to the next one's
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace omnihil {

struct DebugLine {
  std::uint64_t begin = 0, end = 0;  // addresses
  std::string file;                  // as the compiler was given it, with its folder
  int line = 0;
  bool begins = false;  // of a statement
};

// Empty where there is no debug information. Code that the linker left out is not among them.
std::vector<DebugLine> read_lines(std::vector<std::uint8_t> bytes);

}  // namespace omnihil
