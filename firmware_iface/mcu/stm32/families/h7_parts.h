// What the single-core chips of the H7 family have alike, for the files of chips/ (RM0433: H742, H743, H750, H753;
// RM0468: H723, H725, H730, H733).
//
//   build_h7(chip, {.flash_bytes = 2 << 20, .flash_banks = 2, .device_id = 0x20036450});
#pragma once
#include <cstdint>

#include "firmware_iface/mcu/stm32/chip.h"

namespace omnihil::mcu {

struct H7Parts {
  std::uint32_t flash_bytes = 0;
  unsigned flash_banks = 1;
  std::uint32_t device_id = 0;  // DBGMCU's
  // RM0468: TIM23, TIM24, UART9, USART10, I2C5, FDCAN3, CORDIC, an ADC3 of 12 bits; without HRTIM, QUADSPI, OTG_FS.
  bool newer = false;
};

void build_h7(Chip& chip, const H7Parts& parts);

}  // namespace omnihil::mcu
