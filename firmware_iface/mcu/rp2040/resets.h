// RESETS and PSM of the RP2040: which blocks are held in reset.
//
//   resets.control(22, uart0);      // bit 22 of RESET holds UART0
//
// Law: RP2040 datasheet §2.14. All of them are held after reset; RESET_DONE follows at once. Of the power-on state machine
// (PSM) the registers are kept, and a core that is forced off is said.
#pragma once
#include <utility>
#include <vector>

#include "firmware_iface/mcu/rp2040/rp2040_block.h"

namespace omnihil::mcu::rp2040 {

class Resets final : public Rp2040Block {
 public:
  explicit Resets(ChipContext& context);
  void control(unsigned bit, Held& block) { held_.emplace_back(bit, &block); }
  void reset() override;

 protected:
  std::uint32_t load(std::uint32_t offset) override;
  void store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) override;

 private:
  void apply();
  std::vector<std::pair<unsigned, Held*>> held_;
};

class Psm final : public Rp2040Block {
 public:
  explicit Psm(ChipContext& context);

 protected:
  std::uint32_t load(std::uint32_t offset) override;
};

}  // namespace omnihil::mcu::rp2040
