// The two watchdogs: an image that does not feed them is reset, and the reset names which.
//
//   auto iwdg = make_iwdg(context);     // its own oscillator (LSI)
//   auto wwdg = make_wwdg(0, 7, 2, context);  // window, from APB1; WDGTB at bit 7, 2 bits
//
// Law: IWDG: reset after 4 * 2^PR * (RL + 1) LSI periods without 0xAAAA (RM0090 §21.3); with a window (F0,
// F3, F7, G4: WINR below 0xFFF) also when fed too early. A prescaler written while it runs counts what is
// left on at the new rate, and SR says for five LSI periods that the write is on its way (RM0090 §21.4.4).
// WWDG: T counts down at PCLK1 (H7: PCLK3) / (4096 * 2^WDGTB), reset when it falls below 0x40 or is written while
// above W; early wake-up interrupt at 0x40 (RM0090 §22).
// Not modelled: freezing in debug; the LSI's tolerance (take it as exact).
#pragma once
#include <memory>

#include "firmware_iface/mcu/stm32/chip_context.h"
#include "firmware_iface/mcu/stm32/register_block.h"

namespace omnihil::mcu {

std::unique_ptr<RegisterBlock> make_iwdg(ChipContext& context);
std::unique_ptr<RegisterBlock> make_wwdg(int irq, unsigned prescaler_at, unsigned prescaler_bits,
                                         ChipContext& context, Bus bus = Bus::kApb1);

}  // namespace omnihil::mcu
