// One item of a DMA transfer: a read and a write, addresses that advance.
#pragma once
#include <cstdint>

#include "firmware_iface/mcu/peripheral.h"

namespace omnihil::mcu {

struct DmaTransfer {
  std::uint32_t peripheral = 0, memory = 0;  // of the next item
  unsigned peripheral_bytes = 1, memory_bytes = 1;
  bool peripheral_steps = false, memory_steps = false, to_peripheral = false;
};

inline void move_item(System& system, DmaTransfer& t) {
  const DmaTransfer at = t;  // the write may set off what changes this transfer
  if (at.peripheral_steps) t.peripheral += at.peripheral_bytes;
  if (at.memory_steps) t.memory += at.memory_bytes;
  if (at.to_peripheral) {
    system.bus_write(at.peripheral, at.peripheral_bytes, system.bus_read(at.memory, at.memory_bytes));
  } else {
    system.bus_write(at.memory, at.memory_bytes, system.bus_read(at.peripheral, at.peripheral_bytes));
  }
}

// A controller of which a transfer can be made to fail from outside: its channel is off, with the error flag and the
// interrupt that goes with it (RM0316 §13.4.4, RM0090 §10.3.18).
class DmaErrors {
 public:
  virtual ~DmaErrors() = default;
  virtual bool fail_transfer() = 0;  // false: none is going on
};

}  // namespace omnihil::mcu
