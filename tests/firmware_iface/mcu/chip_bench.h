// A chip on a machine without a core: registers poked by the name of their block.
#pragma once
#include <string>
#include <string_view>

#include "firmware_iface/mcu/stm32/chip.h"
#include "firmware_iface/mcu/stm32/usart.h"
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
  // FLASH's lock opens by two keys at its key register.
  void unlock_flash(std::uint32_t key_register) {
    for (const std::uint32_t key : {0x45670123u, 0xCDEF89ABu}) set("FLASH", key_register, key);
  }
  // An ADC with the registers of adc_v2.h: voltage regulator on, then the converter; and a conversion of what is selected.
  static constexpr std::uint32_t kRegulator = 1u << 28;
  void switch_adc_on(std::string_view adc) {
    set(adc, 0x08, kRegulator);
    set(adc, 0x08, kRegulator | 1);
  }
  void start_adc(std::string_view adc) { set(adc, 0x08, kRegulator | 1 | 4); }
  // What this serial port (with the registers of v2) sends by DMA at 1/16 of its clock, from now on.
  std::string sent_by_dma(std::string_view serial) {
    std::string sent;
    chip.find<Usart>(serial)->on_transmit([&sent](std::uint8_t c, Cycles) { sent += static_cast<char>(c); });
    set(serial, 0x0C, 16);
    set(serial, 0x08, 1u << 7);
    set(serial, 0x00, 1u << 3 | 1);
    system.run_for(3000);
    chip.find<Usart>(serial)->on_transmit({});
    return sent;
  }

  FakeSystem system;
  Chip chip;
};

}  // namespace omnihil::mcu
