// Power control and other blocks that are settings with ready flags: what a start-up polls is answered.
//
//   auto pwr = make_pwr(PwrFamily::kF4, context);
//
// Voltage scaling is ready at once; low-power modes are WFI to the core, stop and standby are reported.
#pragma once
#include <memory>

#include "firmware_iface/mcu/stm32/chip_context.h"
#include "firmware_iface/mcu/stm32/register_block.h"

namespace omnihil::mcu {

enum class PwrFamily { kF0F3, kF4, kF7, kG0, kG4, kH7, kL4 };
std::unique_ptr<RegisterBlock> make_pwr(PwrFamily family, ChipContext& context);

}  // namespace omnihil::mcu
