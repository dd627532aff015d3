#include "hil/debugger/gdb_target.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

namespace omnihil {
namespace {

using mcu::Cpu;

constexpr std::string_view kProfile = "org.gnu.gdb.arm.m-profile", kVfp = "org.gnu.gdb.arm.vfp",
                           kSystem = "org.gnu.gdb.arm.m-system", kMasks = "omnihil.arm.masks";

std::uint32_t word(std::uint64_t value) { return static_cast<std::uint32_t>(value); }

void go_to(Cpu& cpu, std::uint32_t pc) {
  cpu.reg.r[15] = pc & ~1u;
  cpu.resume_it(cpu.reg.r[15], 0);
}

// The stack pointer that is in use is r13, the other one lies beside it.
void set_stack(Cpu& cpu, bool process, std::uint32_t value) {
  (cpu.reg.uses_psp() == process ? cpu.reg.r[13] : cpu.reg.other_sp) = value & ~3u;
}

GdbRegister core_register(unsigned i) {
  constexpr const char* kNames[] = {"sp", "lr", "pc"};
  GdbRegister r;
  r.name = i < 13 ? fmt::format("r{}", i) : kNames[i - 13];
  r.feature = kProfile;
  r.type = i == 13 ? "data_ptr" : i == 15 ? "code_ptr" : "uint32";
  r.index = i;
  r.read = [](Cpu& cpu, unsigned n) { return std::uint64_t{cpu.reg.r[n]}; };
  r.write = [](Cpu& cpu, unsigned n, std::uint64_t value) {
    if (n == 15) return go_to(cpu, word(value));
    cpu.reg.r[n] = n == 13 ? word(value) & ~3u : word(value);
  };
  return r;
}

GdbRegister double_register(unsigned i) {
  GdbRegister r;
  r.name = fmt::format("d{}", i);
  r.feature = kVfp;
  r.type = "ieee_double";
  r.bytes = 8;
  r.index = i;
  r.read = [](Cpu& cpu, unsigned n) { return cpu.reg.u64(2 * n); };
  r.write = [](Cpu& cpu, unsigned n, std::uint64_t value) { cpu.reg.set_u64(2 * n, value); };
  return r;
}

GdbRegister plain(std::string name, std::string_view feature, std::uint64_t (*read)(Cpu&, unsigned),
                  void (*write)(Cpu&, unsigned, std::uint64_t)) {
  GdbRegister r;
  r.name = std::move(name);
  r.feature = feature;
  r.type = "uint32";
  r.read = read;
  r.write = write;
  return r;
}

}  // namespace

std::vector<GdbRegister> gdb_registers(const mcu::Variant& variant) {
  std::vector<GdbRegister> all;
  for (unsigned i = 0; i < 16; ++i) all.push_back(core_register(i));
  all.push_back(plain(
      "xpsr", kProfile, [](Cpu& cpu, unsigned) { return std::uint64_t{cpu.xpsr()}; },
      [](Cpu& cpu, unsigned, std::uint64_t value) { cpu.reg.set_apsr(word(value)); }));
  if (variant.fpu != mcu::Fpu::kNone) {
    for (unsigned i = 0; i < 16; ++i) all.push_back(double_register(i));
    all.push_back(plain(
        "fpscr", kVfp, [](Cpu& cpu, unsigned) { return std::uint64_t{cpu.reg.fpscr}; },
        [](Cpu& cpu, unsigned, std::uint64_t value) { cpu.reg.fpscr = word(value) & 0xF7C0009F; }));
  }
  all.push_back(plain(
      "msp", kSystem, [](Cpu& cpu, unsigned) { return std::uint64_t{cpu.reg.msp()}; },
      [](Cpu& cpu, unsigned, std::uint64_t value) { set_stack(cpu, false, word(value)); }));
  all.push_back(plain(
      "psp", kSystem, [](Cpu& cpu, unsigned) { return std::uint64_t{cpu.reg.psp()}; },
      [](Cpu& cpu, unsigned, std::uint64_t value) { set_stack(cpu, true, word(value)); }));
  all.push_back(plain(
      "primask", kMasks, [](Cpu& cpu, unsigned) { return std::uint64_t{cpu.reg.primask}; },
      [](Cpu& cpu, unsigned, std::uint64_t value) { cpu.reg.primask = word(value) & 1; }));
  all.push_back(plain(
      "basepri", kMasks, [](Cpu& cpu, unsigned) { return std::uint64_t{cpu.reg.basepri}; },
      [](Cpu& cpu, unsigned, std::uint64_t value) { cpu.reg.basepri = word(value) & 0xFF; }));
  all.push_back(plain(
      "faultmask", kMasks, [](Cpu& cpu, unsigned) { return std::uint64_t{cpu.reg.faultmask}; },
      [](Cpu& cpu, unsigned, std::uint64_t value) { cpu.reg.faultmask = word(value) & 1; }));
  all.push_back(plain(
      "control", kMasks, [](Cpu& cpu, unsigned) { return std::uint64_t{cpu.reg.control}; }, nullptr));
  return all;
}

std::string gdb_target_xml(const std::vector<GdbRegister>& registers) {
  std::string xml =
      "<?xml version=\"1.0\"?>\n<!DOCTYPE target SYSTEM \"gdb-target.dtd\">\n<target>\n"
      "<architecture>arm</architecture>\n";
  std::string_view feature;
  for (const GdbRegister& r : registers) {
    if (r.feature != feature) {
      xml += feature.empty() ? "" : "</feature>\n";
      xml += fmt::format("<feature name=\"{}\">\n", r.feature);
      feature = r.feature;
    }
    xml += fmt::format("<reg name=\"{}\" bitsize=\"{}\" type=\"{}\"/>\n", r.name, 8 * r.bytes, r.type);
  }
  return xml + "</feature>\n</target>\n";
}

std::string gdb_memory_map_xml(const mcu::Memory& memory) {
  std::map<std::uint64_t, std::uint64_t> roms;  // begin and end
  for (const auto& region : memory.regions()) {
    if (!region->writable()) roms[region->base] = std::uint64_t{region->base} + region->size;
  }
  std::string xml =
      "<?xml version=\"1.0\"?>\n<!DOCTYPE memory-map PUBLIC \"+//IDN gnu.org//DTD GDB Memory Map V1.0//EN\" "
      "\"http://sourceware.org/gdb/gdb-memory-map.dtd\">\n<memory-map>\n";
  std::uint64_t at = 0;
  const auto add = [&xml](const char* type, std::uint64_t begin, std::uint64_t end) {
    if (begin < end)
      xml +=
          fmt::format("<memory type=\"{}\" start=\"0x{:x}\" length=\"0x{:x}\"/>\n", type, begin, end - begin);
  };
  for (const auto& [begin, end] : roms) {
    add("ram", at, begin);
    add("rom", std::max(at, begin), end);
    at = std::max(at, end);
  }
  add("ram", at, std::uint64_t{1} << 32);
  return xml + "</memory-map>\n";
}

}  // namespace omnihil
