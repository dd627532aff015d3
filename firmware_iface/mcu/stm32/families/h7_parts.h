// What the single-core chips of the H7 family have alike, for the files of chips/ (RM0433: H742, H743, H750, H753;
// RM0468: H723, H725, H730, H733).
//
//   static constexpr H7Parts kParts{.flash_bytes = 2 << 20, .flash_banks = 2, .device_id = 0x20036450};
//   const ChipSpec spec = h7_spec("stm32h743", {}, kParts, [](Chip& chip) { build_h7(chip, kParts); });
#pragma once
#include <cstdint>
#include <string_view>
#include <vector>

#include "firmware_iface/mcu/stm32/chip.h"

namespace omnihil::mcu {

struct H7Parts {
  std::uint32_t flash_bytes = 0;
  unsigned flash_banks = 1;
  std::uint32_t sram_bytes = 512 * 1024, d2_bytes = 288 * 1024,
                sram4_bytes = 64 * 1024;  // on AXI, of D2, of D3
  std::uint32_t device_id = 0;            // DBGMCU's
  // RM0468: TIM23, TIM24, UART9, USART10, I2C5, FDCAN3, CORDIC, an ADC3 of 12 bits; without HRTIM, QUADSPI, OTG_FS.
  bool newer = false;
};

void build_h7(Chip& chip, const H7Parts& parts);
ChipSpec h7_spec(std::string_view name, std::vector<std::string_view> variants, const H7Parts& parts,
                 void (*build)(Chip& chip));

}  // namespace omnihil::mcu
