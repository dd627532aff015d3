// A chip's registers by name: as CMSIS-SVD, which debuggers read, and one by one.
//
//   std::string xml = svd_text(*mcu::find_chip("stm32f405"), "stm32f407");
//   for (const NamedRegister& r : named_registers(chip)) …        // {"TIM1", "CNT", 0x40010024}
//
// From the tables that the emulation itself works with (register_block.h), so what is listed is what is modelled; the
// core's own (SysTick, SCB, NVIC, DWT) by DDI 0403E.e. Law of the file: CMSIS-SVD 1.3, a device with peripherals and
// registers of 32 bits. Cannot: fields, since the tables have none; blocks that are only kept have no registers.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "firmware_iface/mcu/stm32/chip.h"

namespace omnihil {

struct NamedRegister {
  std::string block, name;
  std::uint32_t address = 0, reset = 0;
};

// By block, in order of address.
std::vector<NamedRegister> named_registers(const mcu::Chip& chip);
// `name`: as the user wrote the chip's.
std::string svd_text(const mcu::ChipSpec& spec, std::string_view name);

}  // namespace omnihil
