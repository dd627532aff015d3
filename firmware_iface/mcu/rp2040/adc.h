// The RP2040's converter: five inputs, the last one its temperature sensor.
//
//   chip.add(0x4004C000, kBlockBytes, make_adc(context)).reference_V = 3.0;
#pragma once
#include <memory>

#include "firmware_iface/mcu/rp2040/rp2040_block.h"
#include "firmware_iface/mcu/stm32/adc/adc.h"

namespace omnihil::mcu::rp2040 {

std::unique_ptr<Atomic<Adc>> make_adc(ChipContext& context);

}  // namespace omnihil::mcu::rp2040
