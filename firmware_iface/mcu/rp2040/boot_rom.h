// The boot ROM of the RP2040: its tables where the SDK looks for them, its functions by our own code.
//
//   auto rom = std::make_shared<BootRom>(flash);
//   rom->install(machine);                       // 16 KiB at 0, whose functions are calls to the host
//
// Law: RP2040 datasheet §2.8: header at 0x10, tables of functions and data by two letters, and what the functions do. Each
// is a BKPT at its own address, so that a call, a trace and a debugger see it. Boot: the first 256 bytes of flash must end
// in their checksum (CRC-32, §2.8.1.3.1), as the chip demands; the second stage in them is not run, since flash is read
// as memory from the start, and the vectors behind it are entered. Durations are near the datasheet's (§2.8.3.2), a guess
// of 30 %. Cannot represent: USB and its mass storage; NaN payloads; denormal numbers are zero, as in the ROM.
#pragma once
#include <array>
#include <memory>

#include "firmware_iface/mcu/machine/machine.h"
#include "firmware_iface/mcu/rp2040/flash_chip.h"

namespace omnihil::mcu::rp2040 {

inline constexpr std::uint32_t kRomBytes = 16384;
// Where a program reads by pointers that would be null elsewhere: identity, version and the tables' addresses.
inline constexpr std::uint32_t kRomHeader = 0x10, kRomHeaderBytes = 12;

// Of the 252 bytes of a second stage; its checksum stands behind them.
std::uint32_t boot_checksum(std::span<const std::uint8_t> bytes);

class BootRom {
 public:
  explicit BootRom(std::shared_ptr<FlashChip> flash) : flash_(std::move(flash)) {}
  void install(Machine& machine);

 private:
  bool call(Machine& machine, unsigned number);
  void boot(Machine& machine);
  void park(Machine& machine);
  void erase(Machine& machine, std::uint32_t offset, std::uint32_t bytes);
  void program(Machine& machine, std::uint32_t offset, std::uint32_t from, std::uint32_t bytes);

  std::shared_ptr<FlashChip> flash_;
};

}  // namespace omnihil::mcu::rp2040
