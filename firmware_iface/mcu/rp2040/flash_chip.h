// The serial flash beside an RP2040: its contents are the machine's flash, its commands those of a W25Q16JV.
//
//   flash.select(true);  flash.exchange(0x9F);  flash.exchange(0);      // the first byte of its identity
//
// Law: Winbond W25Q16JV data sheet, §8: read, page program, erase of 4, 32 and 64 KiB, status registers, identities. What
// is written comes at once; its duration is charged by the boot ROM's functions alone. Cannot represent: protection,
// suspend, quad commands by hand (what XIP reads needs none).
#pragma once
#include <cstdint>
#include <string_view>

#include "firmware_iface/mcu/peripheral.h"

namespace omnihil::mcu::rp2040 {

inline constexpr std::uint32_t kFlashBase = 0x10000000, kFlashBytes = 2u << 20;

class FlashChip {
 public:
  explicit FlashChip(System& system) : system_(system) {}
  void select(bool selected);
  bool selected() const { return selected_; }
  std::uint8_t exchange(std::uint8_t out);
  void erase(std::uint32_t offset, std::uint32_t bytes);
  void program(std::uint32_t offset, std::uint8_t byte);

 private:
  std::uint8_t answer(std::uint8_t out);
  std::uint32_t address() const { return address_ & (kFlashBytes - 1); }

  System& system_;
  bool selected_ = false, writable_ = false;
  std::uint8_t command_ = 0;
  std::uint32_t place_ = 0, address_ = 0;  // bytes since the selection
};

}  // namespace omnihil::mcu::rp2040
