#include "firmware_iface/mcu/stm32/families/timer_rows.h"

#include <utility>

#include "firmware_iface/mcu/stm32/chip_parts.h"

namespace omnihil::mcu {

std::vector<TimerRow> timers_1_to_8(const FirstTimers& first) {
  const auto advanced = [](int number, int irq_break, std::vector<std::string> itr) {
    return TimerSpec{.number = number,
                     .bus = Bus::kApb2,
                     .advanced = true,
                     .irq_update = irq_break + 1,
                     .irq_compare = irq_break + 3,
                     .irq_break = irq_break,
                     .irq_trigger = irq_break + 2,
                     .internal_triggers = std::move(itr)};
  };
  const auto general = [](int number, int irq, std::vector<std::string> itr) {
    return TimerSpec{.number = number,
                     .bits32 = number == 2 || number == 5,
                     .irq_update = irq,
                     .internal_triggers = std::move(itr)};
  };
  return {{first.tim1, advanced(1, 24, {first.itr, "TIM2_TRGO", "TIM3_TRGO", "TIM4_TRGO"})},
          {first.tim8, advanced(8, 43, {"TIM1_TRGO", "TIM2_TRGO", "TIM4_TRGO", "TIM5_TRGO"})},
          {0x40000000, general(2, 28, {"TIM1_TRGO", "TIM8_TRGO", "TIM3_TRGO", "TIM4_TRGO"})},
          {0x40000400, general(3, 29, {"TIM1_TRGO", "TIM2_TRGO", first.itr, "TIM4_TRGO"})},
          {0x40000800, general(4, 30, {"TIM1_TRGO", "TIM2_TRGO", "TIM3_TRGO", "TIM8_TRGO"})},
          {0x40000C00, general(5, 50, {"TIM2_TRGO", "TIM3_TRGO", "TIM4_TRGO", "TIM8_TRGO"})},
          {0x40001000, {.number = 6, .channels = 0, .irq_update = 54}},
          {0x40001400, {.number = 7, .channels = 0, .irq_update = 55}}};
}

std::vector<TimerRow> timers_12_to_14() {
  return {{0x40001800,
           {.number = 12,
            .channels = 2,
            .irq_update = 43,
            .internal_triggers = {"TIM4_TRGO", "TIM5_TRGO", "TIM13_CC1", "TIM14_CC1"}}},
          {0x40001C00, {.number = 13, .channels = 1, .irq_update = 44}},
          {0x40002000, {.number = 14, .channels = 1, .irq_update = 45}}};
}

std::vector<TimerRow> timers_15_to_17(int irq, std::vector<std::string> internal_triggers_of_15) {
  const auto one_channel = [irq](int number) {
    return TimerSpec{.number = number,
                     .bus = Bus::kApb2,
                     .channels = 1,
                     .advanced = true,
                     .irq_update = irq + number - 15};
  };
  TimerSpec two_channels = one_channel(15);
  two_channels.channels = 2;
  two_channels.internal_triggers = std::move(internal_triggers_of_15);
  return {
      {0x40014000, std::move(two_channels)}, {0x40014400, one_channel(16)}, {0x40014800, one_channel(17)}};
}

std::vector<TimerRow> timers_of_f0() {
  return {{0x40012C00,
           {.number = 1,
            .advanced = true,
            .irq_update = 13,
            .irq_compare = 14,
            .internal_triggers = {"TIM15_TRGO", "TIM2_TRGO", "TIM3_TRGO", "TIM17_CC1"}}},
          {0x40000000,
           {.number = 2,
            .bits32 = true,
            .irq_update = 15,
            .internal_triggers = {"TIM1_TRGO", "TIM15_TRGO", "TIM3_TRGO", "TIM14_CC1"}}},
          {0x40000400,
           {.number = 3,
            .irq_update = 16,
            .internal_triggers = {"TIM1_TRGO", "TIM2_TRGO", "TIM15_TRGO", "TIM14_CC1"}}},
          {0x40002000, {.number = 14, .channels = 1, .irq_update = 19}},
          {0x40014400, {.number = 16, .channels = 1, .advanced = true, .irq_update = 21}},
          {0x40014800, {.number = 17, .channels = 1, .advanced = true, .irq_update = 22}}};
}

void add_timers(Chip& chip, std::span<const TimerRow> rows) {
  for (const TimerRow& row : rows) add_timer(chip, row.base, row.spec);
}

}  // namespace omnihil::mcu
