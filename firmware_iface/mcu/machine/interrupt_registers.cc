// Enable, pending, active bits and priorities of interrupts and system handlers (DDI 0403E.e B3.4, B3.2.10).
#include "firmware_iface/mcu/machine/machine.h"

namespace omnihil::mcu {
namespace {

enum Offset : std::uint32_t {
  kSetEnable = 0x100,
  kClearEnable = 0x180,
  kSetPending = 0x200,
  kClearPending = 0x280,
  kActiveBits = 0x300,
  kPriorities = 0x400,
  kPrioritiesEnd = 0x4F0,
  kSystemPriorities = 0xD18,
  kSystemPrioritiesEnd = 0xD24,
};

bool is_bits(std::uint32_t offset) {
  return offset >= kSetEnable && offset < kPriorities && (offset & 0x7F) < 0x20;
}
bool is_priority(std::uint32_t offset) {
  return (offset >= kPriorities && offset < kPrioritiesEnd) ||
         (offset >= kSystemPriorities && offset < kSystemPrioritiesEnd);
}
// The exception whose priority this byte is.
int priority_of(std::uint32_t offset) {
  if (offset < kPrioritiesEnd) return kFirstIrq + static_cast<int>(offset - kPriorities);
  return kMemManage + static_cast<int>(offset - kSystemPriorities);
}

}  // namespace

bool Machine::is_interrupt_register(std::uint32_t offset) { return is_bits(offset) || is_priority(offset); }

// Banks of one bit per interrupt.
std::uint32_t Machine::read_bits(std::uint32_t offset) const {
  std::uint32_t value = 0;
  const int first = kFirstIrq + static_cast<int>(offset & 0x7F) * 8;
  for (int i = 0; i < 32 && first + i < Nvic::kExceptions; ++i) {
    const bool set = offset >= kActiveBits   ? nvic_.active(first + i)
                     : offset >= kSetPending ? nvic_.pending(first + i)
                                             : nvic_.enabled(first + i);
    value |= static_cast<std::uint32_t>(set) << i;
  }
  return value;
}

void Machine::write_bits(std::uint32_t offset, std::uint32_t value) {
  if (offset >= kActiveBits) return;  // read-only
  const int first = kFirstIrq + static_cast<int>(offset & 0x7F) * 8;
  for (int i = 0; i < 32 && first + i < Nvic::kExceptions; ++i) {
    if (!(value >> i & 1)) continue;
    const int e = first + i;
    if (offset < kSetPending) {
      nvic_.set_enabled(e, offset < kClearEnable);
    } else if (offset < kClearPending) {
      pend(e);
    } else {
      nvic_.clear_pending(e);
    }
  }
}

std::uint32_t Machine::read_interrupts(std::uint32_t offset) const {
  if (is_bits(offset)) return read_bits(offset);
  std::uint32_t value = 0;
  for (std::uint32_t i = 4; i-- > 0;) value = value << 8 | nvic_.priority(priority_of(offset + i));
  return value;
}

void Machine::write_interrupts(std::uint32_t offset, unsigned bytes, std::uint32_t value) {
  if (is_bits(offset)) {
    write_bits(offset, value);
  } else {
    for (std::uint32_t i = 0; i < bytes; ++i) {
      nvic_.set_priority(priority_of(offset + i), static_cast<std::uint8_t>(value >> (8 * i)));
    }
  }
  cpu_.stop_soon();
}

}  // namespace omnihil::mcu
