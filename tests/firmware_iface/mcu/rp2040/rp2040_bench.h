// An RP2040 with its clocks as the SDK leaves them: crystal of 12 MHz, clk_sys 125 MHz, a tick every microsecond; nothing
// in reset.
//
//   Rp2040Bench b;  b.give(6, IoBank::kPwm);  b.set("PWM", 0x3C + kSet, 1);
#pragma once
#include <string>

#include "firmware_iface/mcu/rp2040/io_bank.h"
#include "firmware_iface/mcu/stm32/timer/pwm_outputs.h"
#include "tests/firmware_iface/mcu/chip_bench.h"

namespace omnihil::mcu {
using namespace rp2040;
// Of a register's address: what is written changes bits.
inline constexpr std::uint32_t kSet = 0x2000, kClear = 0x3000, kFlip = 0x1000;

struct Rp2040Bench : ChipBench {
  Rp2040Bench() : ChipBench("rp2040") {
    chip.context().clocks.hse_hz = 12e6;
    set("RESETS", kClear, 0x01FFFFFF);
    set("XOSC", 0, 0xFABAA0);
    set("PLL_SYS", 8, 125);
    set("PLL_SYS", 4, 4);
    set("PLL_SYS", 0x0C, 6u << 16 | 2u << 12);
    set("CLOCKS", 0x30, 2);
    set("CLOCKS", 0x3C, 1);
    set("CLOCKS", 0x48, 1u << 11);
    set("WATCHDOG", 0x2C, 1u << 9 | 12);
  }
  PwmOutputs& slice(const std::string& name) { return *chip.find<PwmOutputs>(name); }
  PinBank& pins() { return *chip.port(PinBank::kGp); }
  void give(unsigned pin, IoBank::Function to) { set("IO_BANK0", 8 * pin + 4, to); }
};

}  // namespace omnihil::mcu
