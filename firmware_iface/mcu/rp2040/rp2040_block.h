// A block of the RP2040 on APB or AHB: its registers, and the same at three more addresses that change bits at once.
//
//   class Tbman : public Rp2040Block { … };      // 0x1000 on: exclusive or, 0x2000: set, 0x3000: clear
//
// Law: RP2040 datasheet §2.1.2 (atomic access), §2.1.4 (bytes and half-words are written to all lanes), §2.14 (a block
// held in reset keeps its reset values; what is done with it meanwhile is reported).
#pragma once
#include <functional>
#include <string>

#include "firmware_iface/mcu/stm32/chip_context.h"
#include "firmware_iface/mcu/stm32/register_block.h"
#include "firmware_iface/mcu/stm32/register_table.h"

namespace omnihil::mcu::rp2040 {

inline constexpr std::uint32_t kBlockBytes = 0x4000;  // with its aliases

// What RESETS holds.
class Held {
 public:
  virtual ~Held() = default;
  virtual void hold(bool held) = 0;
};

template <class Base>
class Atomic : public Base, public Held {
 public:
  using Base::Base;
  std::uint32_t read(std::uint32_t offset, unsigned bytes) final {
    if (held_) [[unlikely]]
      this->system().report_unmodelled(this->name(), "is read while RESETS holds it in reset");
    return Base::read(offset & 0xFFFu, bytes);
  }
  void write(std::uint32_t offset, unsigned bytes, std::uint32_t value) final {
    if (held_) [[unlikely]] {
      return this->system().report_unmodelled(this->name(),
                                              "is written while RESETS holds it in reset: ignored");
    }
    if (bytes == 1) value = (value & 0xFFu) * 0x01010101u;
    if (bytes == 2) value = (value & 0xFFFFu) * 0x00010001u;
    const unsigned way = offset >> 12 & 3u;
    const std::uint32_t at = offset & 0xFFCu;
    if (way != 0) {
      const std::uint32_t old = this->peek(at);
      value = way == 1 ? old ^ value : way == 2 ? old | value : old & ~value;
    }
    Base::write(at, 4, value);
  }
  // From the first to the second it is as after reset.
  void hold(bool held) final {
    if (held && !held_) this->reset();
    held_ = held;
  }

 private:
  bool held_ = false;
};
using Rp2040Block = Atomic<RegisterBlock>;

// Raw, enabled, forced and shown interrupts of a block: INTR, INTE, INTF, INTS.
struct Interrupts {
  std::uint32_t raw = 0, enabled = 0, forced = 0;
  std::uint32_t shown() const { return (raw & enabled) | forced; }
};

}  // namespace omnihil::mcu::rp2040
