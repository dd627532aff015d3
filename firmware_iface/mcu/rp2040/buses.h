// SPI and I2C of the RP2040: ARM's PL022 and Synopsys' DW_apb_i2c, both as masters.
//
//   chip.add(0x4003C000, kBlockBytes, make_spi_pl022(0, 18, context));
//   chip.add(0x40044000, kBlockBytes, make_i2c_dw(0, 23, context));
//
// What hangs on them is connected as on every other chip's Spi and I2c.
#pragma once
#include <memory>

#include "firmware_iface/mcu/rp2040/rp2040_block.h"
#include "firmware_iface/mcu/stm32/i2c.h"
#include "firmware_iface/mcu/stm32/spi.h"

namespace omnihil::mcu::rp2040 {

std::unique_ptr<Atomic<Spi>> make_spi_pl022(unsigned number, int irq, ChipContext& context);
std::unique_ptr<Atomic<I2c>> make_i2c_dw(unsigned number, int irq, ChipContext& context);

}  // namespace omnihil::mcu::rp2040
