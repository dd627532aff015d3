// Two timers on a system without a core: TIM1, an advanced one, and TIM2, which triggers it.
#pragma once
#include <gtest/gtest.h>

#include "firmware_iface/mcu/stm32/timer/timer.h"
#include "tests/firmware_iface/mcu/fake_system.h"

namespace omnihil::mcu {
inline constexpr std::uint32_t kBase = 0x40010000, kOther = 0x40000000;
enum : std::uint32_t {
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
  kCcr2 = 0x38,
  kBdtr = 0x44
};

struct TimerTest : testing::Test {
  TimerTest() {
    system.attach(kBase, 0x400, timer);
    system.attach(kOther, 0x400, other);
    ClockState state;
    state.hclk_hz = 16e6;
    context.clocks.set(state);
    timer.on_output([this](std::int64_t) { last_output_at = system.now(); });
  }
  void set(std::uint32_t offset, std::uint32_t value) { system.write(kBase + offset, value); }
  std::uint32_t get(std::uint32_t offset) { return system.read(kBase + offset); }
  void set_other(std::uint32_t offset, std::uint32_t value) { system.write(kOther + offset, value); }

  FakeSystem system;
  ChipContext context{system};
  Timer timer{{.number = 1,
               .bus = Bus::kApb2,
               .advanced = true,
               .irq_update = 25,
               .irq_compare = 27,
               .internal_triggers = {"TIM5_TRGO", "TIM2_TRGO"}},
              context};
  Timer other{
      {.number = 2, .bus = Bus::kApb1, .bits32 = true, .irq_update = 28, .internal_triggers = {"TIM1_TRGO"}},
      context};
  Cycles last_output_at = 0;
};

}  // namespace omnihil::mcu
