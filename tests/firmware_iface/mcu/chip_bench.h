// A chip on a machine without a core: registers poked by the name of their block.
#pragma once
#include <string>
#include <string_view>

#include "firmware_iface/mcu/stm32/chip.h"
#include "tests/firmware_iface/mcu/fake_system.h"

namespace omnihil::mcu {

struct ChipBench {
  explicit ChipBench(std::string_view name) : chip(*find_chip(name), system) {
    for (const Chip::Mapped& block : chip.blocks()) system.attach(block.base, block.bytes, *block.peripheral);
  }
  std::uint32_t base(std::string_view block) const {
    for (const Chip::Mapped& at : chip.blocks()) {
      if (at.peripheral->name() == block) return at.base;
    }
    return 0;
  }
  void set(std::string_view block, std::uint32_t offset, std::uint32_t value) {
    system.write(base(block) + offset, value);
  }
  std::uint32_t get(std::string_view block, std::uint32_t offset) {
    return system.read(base(block) + offset);
  }

  FakeSystem system;
  Chip chip;
};

}  // namespace omnihil::mcu
