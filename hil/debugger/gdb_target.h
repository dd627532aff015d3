// A Cortex-M as GDB sees it: its registers in GDB's order, and the XML that says which they are and where memory is.
//
//   const std::vector<GdbRegister> registers = gdb_registers(machine.cpu().variant());
//   std::uint64_t pc = registers[15].get(machine.cpu());
//   gdb_target_xml(registers);
//
// Features of the GDB manual, "ARM Features": m-profile, vfp (16 double registers, of which GDB makes the single ones)
// where there is an FPU, m-system (both stack pointers).
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "firmware_iface/mcu/machine/machine.h"

namespace omnihil {

struct GdbRegister {
  std::string name;
  std::string_view feature, type;
  unsigned bytes = 4;
  std::uint64_t (*read)(mcu::Cpu& cpu, unsigned index) = nullptr;
  // Null: GDB may not set it.
  void (*write)(mcu::Cpu& cpu, unsigned index, std::uint64_t value) = nullptr;
  unsigned index = 0;

  std::uint64_t get(mcu::Cpu& cpu) const { return read(cpu, index); }
};

std::vector<GdbRegister> gdb_registers(const mcu::Variant& variant);
std::string gdb_target_xml(const std::vector<GdbRegister>& registers);
// Flash as "rom", so that GDB takes hardware breakpoints there; all else "ram": registers are told by reading them.
std::string gdb_memory_map_xml(const mcu::Memory& memory);

}  // namespace omnihil
