// What every block of a chip may use of the rest of it.
#pragma once
#include <cstdint>
#include <string_view>
#include <vector>

#include "firmware_iface/mcu/stm32/clock/clock_tree.h"
#include "firmware_iface/mcu/stm32/dma/dma_router.h"
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
  // Memories that only the core reaches: a controller that is sent there fails with a bus error.
  struct Range {
    std::uint32_t base, bytes;
  };
  std::vector<Range> core_only;
  bool reaches(std::uint32_t address, std::string_view controller) const {
    for (const Range& range : core_only) {
      if (address - range.base >= range.bytes) continue;
      system.report_unmodelled(controller, "is sent to memory that only the core reaches: a transfer error");
      return false;
    }
    return true;
  }
};

}  // namespace omnihil::mcu
