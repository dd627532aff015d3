// The chips of a robot's boards as something that faults are put into: firmware_chip.h's FirmwareChip.
//
//   BoardsChip chip(mcu_firmware, image);
//   chip.schedule({.kind = ChipFaultKind::kRegisterBit, .at_ns = 1'000'000, .bit = 4, .reg = 3});
//
// Bits of RAM may be any byte of RAM, of flash any byte of flash. A register's bit turns over between two instructions,
// whatever then runs; pc is left out (a jump to nowhere is a fault at once, and shows little). A storm raises the line of
// an interrupt whether the image has it on or not. A DMA error ends the first transfer that is on, of any controller.
#pragma once
#include "firmware_iface/firmware_chip.h"
#include "firmware_iface/mcu/board/mcu_firmware.h"

namespace omnihil::mcu {

class BoardsChip final : public FirmwareChip {
 public:
  BoardsChip(McuFirmware& firmware, const ElfImage& image) : firmware_(firmware), image_(image) {}

  std::string schedule(const ChipFault& fault) override;
  std::vector<ChipMemoryRange> ram_in_use() const override;
  std::vector<ChipMemoryRange> flash_in_use() const override;
  std::vector<int> interrupts_in_use() const override;

 private:
  std::string problem(const ChipFault& fault) const;

  McuFirmware& firmware_;
  const ElfImage& image_;
};

}  // namespace omnihil::mcu
