// The 24-bit down counter of the core (DDI 0403E.e B3.3). Counts the core clock, or an eighth of it.
#pragma once
#include <cstdint>

#include "firmware_iface/mcu/peripheral.h"

namespace omnihil::mcu {

class SysTick {
 public:
  void reset() { *this = SysTick{}; }
  std::uint32_t read(std::uint32_t offset, Cycles now);
  void write(std::uint32_t offset, std::uint32_t value, Cycles now);
  // When it reaches 0 next, if that raises the exception.
  Cycles next_event() const { return (control_ & 3) == 3 && load_ != 0 ? zero_at_ + period() : kNever; }
  // Until when reading `offset` gives what it gives now and changes nothing; 0: not even now.
  Cycles stable_until(std::uint32_t offset, Cycles now) const;
  // Brings the state to `now`; true if the counter has reached 0 since with its exception enabled.
  bool advance(Cycles now);

 private:
  Cycles divider() const { return control_ & 4 ? 1 : 8; }
  Cycles period() const { return (Cycles{reload_} + 1) * divider(); }
  std::uint32_t value(Cycles now) const;

  std::uint32_t control_ = 0, load_ = 0;
  std::uint32_t reload_ = 0;   // of the period that runs
  std::uint32_t stopped_ = 0;  // the value while it stands
  Cycles zero_at_ = 0;         // when it last was 0
  bool reached_ = false;       // COUNTFLAG
};

}  // namespace omnihil::mcu
