// Flash controller of H7 (RM0433 §4): one or two banks of 128 KiB sectors, with registers of their own 0x100 apart.
//
//   FlashH7 flash(2 << 20, 2, 4, context);
//
// As flash.h; a flash word of 32 bytes is programmed store by store, and EOP comes with each.
#pragma once
#include <array>

#include "firmware_iface/mcu/stm32/clock/flash.h"

namespace omnihil::mcu {

class FlashH7 final : public Flash {
 public:
  FlashH7(std::uint32_t bytes, unsigned banks, int irq, ChipContext& context);
  void reset() override;
  void flash_write(std::uint32_t address, unsigned bytes, std::uint32_t value) override;

 protected:
  std::uint32_t load(std::uint32_t offset) override { return value(offset); }
  void store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) override;

 private:
  void control(std::uint32_t bank, std::uint32_t written, std::uint32_t lanes);
  void done(std::uint32_t bank);
  void update();
  std::uint32_t bank_bytes_;
  std::array<unsigned, 2> keys_{};
};

}  // namespace omnihil::mcu
