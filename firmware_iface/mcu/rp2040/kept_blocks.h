// Blocks of the RP2040 that say who it is, or whose registers do nothing that is seen here.
//
//   chip.add(0x40000000, kBlockBytes, make_sysinfo(context));
//
// Law: RP2040 datasheet §2.20 (SYSINFO), §2.21 (SYSCFG), §2.10 (VREG, CHIP_RESET), §2.1.5 (BUSCTRL), §2.22 (TBMAN).
#pragma once
#include <memory>

#include "firmware_iface/mcu/rp2040/rp2040_block.h"

namespace omnihil::mcu::rp2040 {

std::unique_ptr<Rp2040Block> make_sysinfo(ChipContext& context);
std::unique_ptr<Rp2040Block> make_syscfg(ChipContext& context);
std::unique_ptr<Rp2040Block> make_vreg_and_chip_reset(ChipContext& context);
std::unique_ptr<Rp2040Block> make_busctrl(ChipContext& context);
std::unique_ptr<Rp2040Block> make_tbman(ChipContext& context);
std::unique_ptr<Rp2040Block> make_pads_qspi(ChipContext& context);

}  // namespace omnihil::mcu::rp2040
