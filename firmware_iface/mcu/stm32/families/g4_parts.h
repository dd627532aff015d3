// What the chips of the G4 family have alike, for the files of chips/ (RM0440; category 2: G431, G441, category 3: G47x, G48x).
//
//   build_g4(chip, {.flash_bytes = 128 * 1024, .device_id = 0x20006468});
#pragma once
#include <cstdint>

#include "firmware_iface/mcu/stm32/chip.h"

namespace omnihil::mcu {

struct G4Parts {
  std::uint32_t flash_bytes = 0, device_id = 0;  // DBGMCU's
  bool large = false;         // category 3: TIM5, TIM20, ADC3 to ADC5, UART5, SPI4, I2C4, FDCAN2 and 3, HRTIM
  unsigned dma_channels = 6;  // of each controller
};

void build_g4(Chip& chip, const G4Parts& parts);

}  // namespace omnihil::mcu
