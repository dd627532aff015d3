// What every block of a chip may use of the rest of it.
#pragma once
#include "firmware_iface/mcu/stm32/clock/clock_tree.h"
#include "firmware_iface/mcu/stm32/dma_router.h"
#include "firmware_iface/mcu/stm32/irq_hub.h"
#include "firmware_iface/mcu/stm32/timer/trigger_bus.h"

namespace omnihil::mcu {

struct ChipContext {
  explicit ChipContext(System& of) : system(of), irqs(of), clocks(of), triggers(of) {}
  System& system;
  IrqHub irqs;
  ClockTree clocks;
  TriggerBus triggers;
  DmaRouter dma;
};

}  // namespace omnihil::mcu
