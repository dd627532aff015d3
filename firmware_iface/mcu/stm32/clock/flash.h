// Flash controller: wait states, unlock keys, erase and programming of the chip's flash.
//
//   Flash flash(FlashFamily::kF4, 1 << 20, 16 << 10, irq, context);
//   machine.set_flash_writes(&flash);       // stores of the core into flash
//
// Programming and erasing take no time (BSY is never seen). A store without PG is ignored, as silicon does
// (F4: the stores of a null pointer through the alias at 0), and counted by the machine. Option bytes:
// registers only.
#pragma once
#include "firmware_iface/mcu/stm32/chip_context.h"
#include "firmware_iface/mcu/stm32/register_block.h"

namespace omnihil::mcu {

enum class FlashFamily { kF0F3, kF4, kF7, kG0, kG4, kL4 };

class Flash : public RegisterBlock, public FlashWrites {
 public:
  Flash(FlashFamily family, std::uint32_t bytes, std::uint32_t page_bytes, int irq, ChipContext& context);
  void reset() override;
  // BOOT_ADD0 as OPTCR1 shows it (F7): in units of 16 KiB.
  void set_boot_address(std::uint32_t address);
  void flash_write(std::uint32_t address, unsigned bytes, std::uint32_t value) override;

 protected:
  Flash(std::span<const RegisterInfo> registers, std::uint32_t bytes, int irq, ChipContext& context);
  std::uint32_t load(std::uint32_t offset) override;
  void store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) override;

  // The next word at a key register. True: with it both keys have been given, and the lock opens.
  static bool opens(unsigned& keys, std::uint32_t written);
  void erase(std::uint32_t from, std::uint32_t count);  // from the flash's base
  void program(std::uint32_t address, unsigned bytes, std::uint32_t value);
  std::uint32_t bytes() const { return bytes_; }
  IrqLine irq_;

 private:
  bool locked() const;
  bool one_bank() const { return family_ == FlashFamily::kG0 && bytes_ <= 128 * 1024; }
  void control(std::uint32_t written, std::uint32_t lanes);
  void erase_sector(std::uint32_t sector);

  FlashFamily family_;
  std::uint32_t bytes_, page_bytes_;
  unsigned keys_ = 0;
  std::uint32_t boot_option_ = 0x0080;  // as delivered: 0x00200000
};

}  // namespace omnihil::mcu
