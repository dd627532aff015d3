// Flash controller: wait states, unlock keys, erase and programming of the chip's flash.
//
//   Flash flash(FlashFamily::kF4, context);
//   flash.attach_memory(0x08000000, bytes, changed);        // the array itself, and who must hear of new
//   contents flash.program(0x0801F000, 4, 0x12345678);               // the bus: a store into flash, now
//
// Programming and erasing take no time (BSY is never seen). A store without PG is ignored, as silicon does
// (F4: the stores of a null pointer through the alias at 0), and counted by the machine. Option bytes:
// registers only.
#pragma once
#include <functional>
#include <span>

#include "firmware_iface/mcu/stm32/chip_context.h"
#include "firmware_iface/mcu/stm32/register_block.h"

namespace omnihil::mcu {

enum class FlashFamily { kF0F3, kF4, kF7, kG4 };

class Flash final : public RegisterBlock {
 public:
  Flash(FlashFamily family, std::uint32_t page_bytes, int irq, ChipContext& context);
  void reset() override;
  void attach_memory(std::uint32_t base, std::span<std::uint8_t> bytes,
                     std::function<void(std::uint32_t address, std::uint32_t bytes)> changed);
  // A store of the core into flash: true if it was programming, false if it is to be ignored.
  bool program(std::uint32_t address, unsigned bytes, std::uint32_t value);

 protected:
  std::uint32_t load(std::uint32_t offset) override;
  void store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) override;

 private:
  bool locked() const;
  void key(std::uint32_t written);
  void control(std::uint32_t written, std::uint32_t lanes);
  void erase(std::uint32_t from, std::uint32_t count);
  void erase_sector(std::uint32_t sector);

  FlashFamily family_;
  std::uint32_t page_bytes_;
  IrqLine irq_;
  std::uint32_t base_ = 0x08000000;
  std::span<std::uint8_t> bytes_;
  std::function<void(std::uint32_t, std::uint32_t)> changed_;
  unsigned keys_ = 0;
};

}  // namespace omnihil::mcu
