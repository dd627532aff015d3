// Timers that families have alike, as rows to be changed where one differs, and added.
//
//   std::vector<TimerRow> rows = timers_1_to_8({.tim1 = 0x40012C00, .tim8 = 0x40013400, .itr = "TIM15_TRGO"});
//   rows.front().spec.fast_clock = true;
//   add_timers(chip, rows);
//
// Law: RM0008 tables 86, 87 (F1); RM0433 tables 312, 319, 333, 340 (H7).
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "firmware_iface/mcu/stm32/chip.h"
#include "firmware_iface/mcu/stm32/timer/timer.h"

namespace omnihil::mcu {

struct TimerRow {
  std::uint32_t base = 0;
  TimerSpec spec{};
};

struct FirstTimers {
  std::uint32_t tim1 = 0, tim8 = 0;  // their bases
  std::string itr = "TIM5_TRGO";     // ITR0 of TIM1 and ITR2 of TIM3
};

// TIM1, 8, 2, 3, 4, 5, 6, 7, in this order; 2 and 5 of 32 bits.
std::vector<TimerRow> timers_1_to_8(const FirstTimers& first);
std::vector<TimerRow> timers_12_to_14();
// `irq`: of TIM15; the next two are those of 16 and 17.
std::vector<TimerRow> timers_15_to_17(int irq, std::vector<std::string> internal_triggers_of_15);
// TIM1, 2, 3, 14, 16, 17 of F0 and G0, which have one APB, of two address ranges. Internal triggers: RM0091 tables 74, 82,
// 87; G0 has them at the same places.
std::vector<TimerRow> timers_of_f0();
void add_timers(Chip& chip, std::span<const TimerRow> rows);

}  // namespace omnihil::mcu
