#include "hil/debugger/svd.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <map>

#include "firmware_iface/mcu/stm32/register_block.h"

namespace omnihil {
namespace {

struct CoreRow {
  const char *block, *name;
  std::uint32_t address;
};
// DDI 0403E.e, B3.2 to B3.4 and C1.8.
constexpr CoreRow kCore[] = {
    {"DWT", "CTRL", 0xE0001000},     {"DWT", "CYCCNT", 0xE0001004},  {"SysTick", "CTRL", 0xE000E010},
    {"SysTick", "LOAD", 0xE000E014}, {"SysTick", "VAL", 0xE000E018}, {"SysTick", "CALIB", 0xE000E01C},
    {"NVIC", "ISER0", 0xE000E100},   {"NVIC", "ISER1", 0xE000E104},  {"NVIC", "ISER2", 0xE000E108},
    {"NVIC", "ISPR0", 0xE000E200},   {"NVIC", "ISPR1", 0xE000E204},  {"NVIC", "ISPR2", 0xE000E208},
    {"NVIC", "IABR0", 0xE000E300},   {"NVIC", "IABR1", 0xE000E304},  {"NVIC", "IABR2", 0xE000E308},
    {"SCB", "CPUID", 0xE000ED00},    {"SCB", "ICSR", 0xE000ED04},    {"SCB", "VTOR", 0xE000ED08},
    {"SCB", "AIRCR", 0xE000ED0C},    {"SCB", "SCR", 0xE000ED10},     {"SCB", "CCR", 0xE000ED14},
    {"SCB", "SHCSR", 0xE000ED24},    {"SCB", "CFSR", 0xE000ED28},    {"SCB", "HFSR", 0xE000ED2C},
    {"SCB", "MMFAR", 0xE000ED34},    {"SCB", "BFAR", 0xE000ED38},    {"SCB", "CPACR", 0xE000ED88},
};
constexpr CoreRow kCoreOfV6M[] = {
    {"SysTick", "CTRL", 0xE000E010},  {"SysTick", "LOAD", 0xE000E014}, {"SysTick", "VAL", 0xE000E018},
    {"SysTick", "CALIB", 0xE000E01C}, {"NVIC", "ISER", 0xE000E100},    {"NVIC", "ISPR", 0xE000E200},
    {"SCB", "CPUID", 0xE000ED00},     {"SCB", "ICSR", 0xE000ED04},     {"SCB", "AIRCR", 0xE000ED0C},
    {"SCB", "SCR", 0xE000ED10},       {"SCB", "CCR", 0xE000ED14},
};

std::string identifier(std::string_view name) {
  std::string text(name);
  std::ranges::replace_if(
      text, [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
  return text;
}

void add_core(const mcu::ChipSpec& spec, std::vector<NamedRegister>& all) {
  const auto add = [&all](const auto& rows) {
    for (const CoreRow& row : rows) all.push_back({row.block, row.name, row.address, 0});
  };
  if (spec.core.arch == mcu::Arch::kV6M) {
    add(kCoreOfV6M);
  } else {
    add(kCore);
  }
}

}  // namespace

std::vector<NamedRegister> named_registers(const mcu::Chip& chip) {
  std::vector<NamedRegister> all;
  std::vector<mcu::Chip::Mapped> blocks = chip.blocks();
  std::ranges::sort(blocks, {}, &mcu::Chip::Mapped::base);
  for (const mcu::Chip::Mapped& block : blocks) {
    const auto* registers = dynamic_cast<const mcu::RegisterBlock*>(block.peripheral);
    if (registers == nullptr) continue;
    for (const mcu::RegisterInfo& r : registers->registers()) {
      if (r.offset >= block.bytes) continue;
      all.push_back(
          {identifier(block.peripheral->name()), identifier(r.name), block.base + r.offset, r.reset});
    }
  }
  add_core(chip.spec(), all);
  return all;
}

std::string svd_text(const mcu::ChipSpec& spec, std::string_view name) {
  mcu::Machine machine(mcu::machine_config(spec));
  const mcu::Chip chip(spec, machine);
  std::map<std::string, std::vector<NamedRegister>> blocks;
  std::vector<std::string> order;
  for (const NamedRegister& r : named_registers(chip)) {
    if (blocks[r.block].empty()) order.push_back(r.block);
    blocks[r.block].push_back(r);
  }
  std::string xml = fmt::format(
      "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n<device schemaVersion=\"1.3\">\n  <name>{}</name>\n"
      "  <version>1.0</version>\n  <description>Registers as omnihil models them</description>\n"
      "  <addressUnitBits>8</addressUnitBits>\n  <width>32</width>\n  <size>32</size>\n"
      "  <access>read-write</access>\n  <peripherals>\n",
      name);
  for (const std::string& block : order) {
    const std::vector<NamedRegister>& rows = blocks[block];
    const std::uint32_t base = std::ranges::min(rows, {}, &NamedRegister::address).address & ~0xFu,
                        end = std::ranges::max(rows, {}, &NamedRegister::address).address + 4;
    xml += fmt::format(
        "    <peripheral>\n      <name>{}</name>\n      <baseAddress>0x{:08X}</baseAddress>\n"
        "      <addressBlock><offset>0</offset><size>0x{:X}</size><usage>registers</usage></addressBlock>\n"
        "      <registers>\n",
        block, base, end - base);
    for (const NamedRegister& r : rows) {
      xml += fmt::format(
          "        <register><name>{}</name><addressOffset>0x{:X}</addressOffset>"
          "<resetValue>0x{:08X}</resetValue></register>\n",
          r.name, r.address - base, r.reset);
    }
    xml += "      </registers>\n    </peripheral>\n";
  }
  return xml + "  </peripherals>\n</device>\n";
}

}  // namespace omnihil
