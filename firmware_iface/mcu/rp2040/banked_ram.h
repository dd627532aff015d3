// The first four banks of the RP2040's RAM each in one piece, at 0x21000000: another view of what 0x20000000 stripes.
//
//   chip.add(0x21000000, 0x40000, std::make_unique<BankedRam>(context));
//
// Law: RP2040 datasheet §2.6.2: word i of bank b is word 4 i + b of the striped view. Data alone: no code runs from here.
#pragma once
#include "firmware_iface/mcu/stm32/chip_context.h"

namespace omnihil::mcu::rp2040 {

class BankedRam final : public Peripheral {
 public:
  explicit BankedRam(ChipContext& context) : Peripheral("SRAM banks"), system_(context.system) {
    next_event_is(kNever);
  }
  void reset() override {}
  std::uint32_t read(std::uint32_t offset, unsigned bytes) override {
    return system_.bus_read(striped(offset), bytes);
  }
  std::uint32_t peek(std::uint32_t offset) override { return read(offset, 4); }
  void write(std::uint32_t offset, unsigned bytes, std::uint32_t value) override {
    system_.bus_write(striped(offset), bytes, value);
  }
  static std::uint32_t striped(std::uint32_t offset) {
    const std::uint32_t bank = offset >> 16 & 3u, word = offset >> 2 & 0x3FFFu;
    return 0x20000000u + (word << 4 | bank << 2 | (offset & 3u));
  }

 private:
  System& system_;
};

}  // namespace omnihil::mcu::rp2040
