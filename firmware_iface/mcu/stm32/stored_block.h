// Blocks that are there but not modelled, and constants in memory.
//
//   StoredBlock usb("OTG_FS", {{0x10, 0x80000000}}, 0x1000, context);   // GRSTCTL: AHB idle, so that an init ends
//   Signature id("unique id", context, 12);
//
// A StoredBlock keeps what is written and gives it back with the fixed bits set; its first use is reported.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "firmware_iface/mcu/stm32/chip_context.h"

namespace omnihil::mcu {

class StoredBlock final : public Peripheral {
 public:
  struct Fixed {
    std::uint32_t offset, ones, zeros = 0;  // bits that always read as one, as zero
  };
  StoredBlock(std::string name, std::vector<Fixed> fixed, std::uint32_t bytes, ChipContext& context)
      : Peripheral(std::move(name)),
        system_(context.system),
        fixed_(std::move(fixed)),
        words_((bytes + 3) / 4, 0) {}
  void reset() override { words_.assign(words_.size(), 0); }
  std::uint32_t read(std::uint32_t offset, unsigned bytes) override;
  std::uint32_t peek(std::uint32_t offset) override;
  void write(std::uint32_t offset, unsigned bytes, std::uint32_t value) override;

 private:
  System& system_;
  std::vector<Fixed> fixed_;
  std::vector<std::uint32_t> words_;
};

// Read-only bytes: unique id, flash size, device id.
class Signature final : public Peripheral {
 public:
  Signature(std::string name, ChipContext& context, std::uint32_t bytes)
      : Peripheral(std::move(name)), system_(context.system), bytes_(bytes, 0xFF) {}
  void put(std::uint32_t offset, std::uint32_t value, unsigned bytes) {
    for (unsigned i = 0; i < bytes; ++i) bytes_[offset + i] = static_cast<std::uint8_t>(value >> (8 * i));
  }
  void reset() override {}
  std::uint32_t read(std::uint32_t offset, unsigned bytes) override;
  std::uint32_t peek(std::uint32_t offset) override { return read(offset, 4); }
  void write(std::uint32_t, unsigned, std::uint32_t) override {
    system_.report_unmodelled(name(), "write to read-only memory ignored");
  }

 private:
  System& system_;
  std::vector<std::uint8_t> bytes_;
};

}  // namespace omnihil::mcu
