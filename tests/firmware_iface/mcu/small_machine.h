// A machine whose program is a few instructions, written as halfwords.
//
//   SmallMachine small({kNopCode, kForever});
//   small.start();
//   small.machine.run_until(3);
#pragma once
#include <cstdint>
#include <cstring>
#include <utility>
#include <vector>

#include "firmware_iface/mcu/machine/machine.h"

namespace omnihil::mcu {

inline constexpr std::uint32_t kFlashBase = 0x08000000, kRamBase = 0x20000000, kCode = kFlashBase + 0x100;

// A machine that runs `code` from reset, with 64 KB of flash and of RAM.
class SmallMachine {
 public:
  explicit SmallMachine(std::vector<std::uint16_t> code, MachineConfig config = {})
      : machine(small(std::move(config))), code_(std::move(code)) {}
  void start() {
    put(kFlashBase, kRamBase + 0x8000);
    put(kFlashBase + 4, kCode | 1);
    std::uint32_t at = kCode;
    for (const std::uint16_t halfword : code_) {
      const std::uint8_t raw[2] = {static_cast<std::uint8_t>(halfword),
                                   static_cast<std::uint8_t>(halfword >> 8)};
      machine.memory().write(at, raw);
      at += 2;
    }
    machine.power_on();
  }
  void put(std::uint32_t address, std::uint32_t value) {
    std::uint8_t raw[4];
    std::memcpy(raw, &value, 4);
    machine.memory().write(address, raw);
  }
  std::uint32_t get(std::uint32_t address) {
    std::uint8_t raw[4] = {};
    machine.memory().read(address, raw);
    std::uint32_t value;
    std::memcpy(&value, raw, 4);
    return value;
  }
  std::uint32_t r(int i) { return machine.cpu().reg.r[i]; }

  Machine machine;

 private:
  static MachineConfig small(MachineConfig config) {
    config.flash_bytes = config.ram_bytes = 64 << 10;
    return config;
  }
  std::vector<std::uint16_t> code_;
};

inline constexpr std::uint16_t kForever = 0xE7FE, kNopCode = 0xBF00;

}  // namespace omnihil::mcu
