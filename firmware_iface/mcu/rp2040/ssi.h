// How an RP2040 speaks to its flash: SSI (Synopsys DW_apb_ssi), the XIP cache's registers, and the pins' IO_QSPI.
//
//   Ssi ssi(flash, qspi, context);
//
// Law: RP2040 datasheet §2.6, §4.10. Frames of a byte to the flash chip by DR0, at once; while the image forces the select
// pin by IO_QSPI, one selection is what it says, else one ends when SR is read. XIP itself is memory: reads take no time
// beside the core's, and the cache's counters stand at 0. Not there: XIP streaming, SSI's DMA and interrupts.
#pragma once
#include <deque>
#include <memory>

#include "firmware_iface/mcu/rp2040/flash_chip.h"
#include "firmware_iface/mcu/rp2040/rp2040_block.h"

namespace omnihil::mcu::rp2040 {

class IoQspi final : public Rp2040Block {
 public:
  IoQspi(std::shared_ptr<FlashChip> flash, ChipContext& context);
  bool forces_select() const;  // the select pin's output is overridden

 protected:
  void store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) override;

 private:
  std::shared_ptr<FlashChip> flash_;
};

class Ssi final : public RegisterBlock {
 public:
  Ssi(std::shared_ptr<FlashChip> flash, const IoQspi& pins, ChipContext& context);
  void reset() override;
  Cycles stable_until(std::uint32_t) const override { return 0; }

 protected:
  std::uint32_t load(std::uint32_t offset) override;
  std::uint32_t shown(std::uint32_t offset) override;
  void store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) override;

 private:
  std::shared_ptr<FlashChip> flash_;
  const IoQspi& pins_;
  std::deque<std::uint8_t> received_;
};

class XipControl final : public RegisterBlock {
 public:
  explicit XipControl(ChipContext& context);

 protected:
  std::uint32_t load(std::uint32_t offset) override;
};

}  // namespace omnihil::mcu::rp2040
