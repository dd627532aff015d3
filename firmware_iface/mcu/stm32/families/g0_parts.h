// What the chips of the G0 family have alike, for the files of chips/ (RM0444: G031, G041, G051, G061, G071, G081, G0B1, G0C1;
// RM0454, the value line: G030, G050, G070, G0B0).
//
//   build_g0(chip, {.size = G0Size::k07, .flash_bytes = 128 * 1024, .device_id = 0x10000460});
#pragma once
#include <cstdint>

#include "firmware_iface/mcu/stm32/chip.h"

namespace omnihil::mcu {

enum class G0Size : std::uint8_t { k03, k05, k07, k0B };  // each has what the one before it has

struct G0Parts {
  G0Size size = G0Size::k07;
  std::uint32_t flash_bytes = 0, device_id = 0;  // DBGMCU's
  // Without TIM2, LPUARTs, low-power timers, DAC, comparators, voltage reference, CEC, UCPD and FDCAN.
  bool value_line = false;
};

void build_g0(Chip& chip, const G0Parts& parts);

}  // namespace omnihil::mcu
