// What the F103's densities have alike, for the files of chips/ (RM0008; medium: x8, xB; high: xC to xE).
//
//   build_f1(chip, {.flash_bytes = 128 * 1024, .page_bytes = 1024, .device_id = 0x20036410});
#pragma once
#include <cstdint>

#include "firmware_iface/mcu/stm32/chip.h"

namespace omnihil::mcu {

struct F1Parts {
  std::uint32_t flash_bytes = 0, page_bytes = 0, device_id = 0;  // DBGMCU's
  bool high_density = false;  // ports F and G, TIM5 to TIM8, ADC3, DMA2, UART4 and 5, SPI3, DAC, SDIO, FSMC
};

void build_f1(Chip& chip, const F1Parts& parts);

}  // namespace omnihil::mcu
