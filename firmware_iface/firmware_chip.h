// The chip that a firmware runs on, and what can go wrong with it from outside.
//
//   FirmwareChip* chip = firmware.chip();                        // null: nothing of it is emulated
//   const ChipFault fault{.kind = ChipFaultKind::kRamBit, .at_ns = 1'234'567'000, .address = 0x20000010, .bit = 3};
//   std::string problem = chip->schedule(fault);                 // empty: it will happen
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace omnihil {

enum class ChipFaultKind : std::uint8_t {
  kRamBit,          // a bit of RAM turns over
  kRegisterBit,     // a bit of r0 to r12, sp or lr
  kFlashBit,        // a bit of the flash, for good
  kClockOff,        // all oscillators run at `ratio` of their rate
  kBrownOutReset,   // the supply dips, and the chip is reset
  kInterruptStorm,  // an interrupt is raised `rate_Hz` times a second
  kDmaError,        // a transfer that is going on ends with the error flag
  kWatchdogLate,    // the watchdog's own oscillator runs at `ratio` of its rate
};
inline constexpr int kChipFaultKinds = 8;

struct ChipFault {
  ChipFaultKind kind = ChipFaultKind::kRamBit;
  std::int64_t at_ns = 0, until_ns = 0;  // `until_ns`: of those that last; 0: to the end
  std::uint32_t board = 0;
  std::uint32_t address = 0;  // kRamBit, kFlashBit
  std::uint32_t bit = 0;      // of the byte (0 to 7), or of the register (0 to 31)
  std::uint32_t reg = 0;      // kRegisterBit: 0 to 14
  std::int32_t irq = 0;       // kInterruptStorm
  double rate_Hz = 0.0;       // kInterruptStorm
  double ratio = 1.0;         // kClockOff, kWatchdogLate
  bool operator==(const ChipFault&) const = default;
};

struct ChipMemoryRange {
  std::uint32_t begin = 0, bytes = 0;
};

class FirmwareChip {
 public:
  virtual ~FirmwareChip() = default;
  // Empty: it will happen, at the first instruction at or after its instant. Else why not.
  virtual std::string schedule(const ChipFault& fault) = 0;
  // Where faults are worth drawing: the RAM that the image uses, its code and constants.
  virtual std::vector<ChipMemoryRange> ram_in_use() const = 0;
  virtual std::vector<ChipMemoryRange> flash_in_use() const = 0;
  virtual std::vector<int> interrupts_in_use() const = 0;  // that have come so far
};

}  // namespace omnihil
