// Offsets and bits of the timers' registers (RM0090 §17.4).
#pragma once
#include <cstdint>

namespace omnihil::mcu::timer_registers {

enum : std::uint16_t {
  kCr1 = 0x00,
  kCr2 = 0x04,
  kSmcr = 0x08,
  kDier = 0x0C,
  kSr = 0x10,
  kEgr = 0x14,
  kCcmr1 = 0x18,
  kCcmr2 = 0x1C,
  kCcer = 0x20,
  kCnt = 0x24,
  kPsc = 0x28,
  kArr = 0x2C,
  kRcr = 0x30,
  kCcr1 = 0x34,
  kBdtr = 0x44,
  kDcr = 0x48,
  kDmar = 0x4C,
  kNewDcr = 0x3DC,
  kNewDmar = 0x3E0
};
using Bits = std::uint32_t;
// CR1
inline constexpr Bits kCen = 1u << 0, kUdis = 1u << 1, kUrs = 1u << 2, kOpm = 1u << 3, kDir = 1u << 4,
                      kArpe = 1u << 7;
// SR, and DIER but for the capture overruns
inline constexpr Bits kUpdate = 1u << 0, kCompare1 = 1u << 1, kCom = 1u << 5, kTrigger = 1u << 6,
                      kBreak = 1u << 7;
inline constexpr Bits kOverCapture1 = 1u << 9;
// DIER: DMA requests
inline constexpr Bits kUpdateDma = 1u << 8, kCompare1Dma = 1u << 9, kComDma = 1u << 13,
                      kTriggerDma = 1u << 14;
// BDTR
inline constexpr Bits kOssi = 1u << 10, kOssr = 1u << 11, kBke = 1u << 12, kBkp = 1u << 13, kAoe = 1u << 14;
inline constexpr Bits kMoe = 1u << 15;

}  // namespace omnihil::mcu::timer_registers
