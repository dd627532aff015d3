#include "firmware_iface/mcu/stm32/chip.h"

#include <algorithm>
#include <cctype>

namespace omnihil::mcu {
namespace {
bool same_word(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); });
}
}  // namespace

const ChipSpec* find_chip(std::string_view name) {
  for (const ChipSpec* chip : all_chips()) {
    if (same_word(chip->name, name)) return chip;
    for (const std::string_view variant : chip->variants) {
      if (same_word(variant, name)) return chip;
    }
  }
  return nullptr;
}

std::string chip_name(std::string_view name) {
  std::string lower(name);
  std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) { return std::tolower(c); });
  return lower;
}

MachineConfig machine_config(const ChipSpec& spec) {
  MachineConfig config;
  config.variant = spec.core;
  config.block_name = [family = spec.blocks](std::uint32_t address) {
    const BlockPlace* place = block_at(family, address);
    return place != nullptr ? std::pair(place->name, place->base) : std::pair(std::string_view{}, 0u);
  };
  config.reset_hz = spec.reset_hz;
  for (const MemorySpec& memory : spec.memories) {
    if (memory.flash) {
      config.flash_base = memory.base;
      config.flash_bytes = memory.bytes;
      config.boot_address = spec.boot_address != 0 ? spec.boot_address : memory.base;
    } else if (memory.name == "sram") {
      config.ram_base = memory.base;
      config.ram_bytes = memory.bytes;
    } else {
      config.memories.push_back(
          {std::string(memory.name), memory.base, memory.bytes, memory.rom ? kFlash : kRam});
      if (memory.base == 0) config.flash_at_zero = false;
    }
  }
  if (spec.boots_from_rom) config.boot_address = 0;
  config.used_low = spec.used_low;
  for (const auto& [name, base] : spec.aliases) {
    config.aliases.emplace_back(name == "sram" ? "ram" : std::string(name), base);
  }
  return config;
}

void attach(Chip& chip, Machine& machine) {
  for (const Chip::Mapped& block : chip.blocks()) machine.attach(block.base, block.bytes, *block.peripheral);
  machine.set_flash_writes(chip.flash());
  for (const auto& work : chip.when_attached_) work(machine);
}

Chip::Chip(const ChipSpec& spec, System& system) : spec_(spec), context_(system) {
  for (const MemorySpec& memory : spec.memories) {
    if (memory.core_only) context_.core_only.push_back({memory.base, memory.bytes});
  }
  spec.build(*this);
  reset();
}

void Chip::reset() {
  for (const Mapped& block : blocks_) block.peripheral->reset();
}

Peripheral* Chip::peripheral(std::string_view name) const {
  for (const Mapped& block : blocks_) {
    if (block.peripheral->name() == name) return block.peripheral;
  }
  return nullptr;
}

PinBank* Chip::port(char letter) const {
  for (PinBank* port : ports_) {
    if (port->letter() == letter) return port;
  }
  return nullptr;
}

Flash* Chip::flash() const { return find<Flash>("FLASH"); }

}  // namespace omnihil::mcu
