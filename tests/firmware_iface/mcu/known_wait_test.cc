// Waits that are passed without executing them: whatever comes in between from outside, everything is as if executed.
#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "tests/firmware_iface/mcu/small_machine.h"

namespace omnihil::mcu {
namespace {

using Program = std::vector<std::uint16_t>;

// Waits for a word at the start of RAM, counts in r2 and behind it, clears it.
const Program kFlagInRam = {0x2020,   // movs r0, #0x20
                            0x0600,   // lsls r0, #24
                            0x6801,   // wait: ldr r1, [r0]
                            0x2900,   // cmp r1, #0
                            0xD0FC,   // beq wait
                            0x3201,   // adds r2, #1
                            0x6042,   // str r2, [r0, #4]
                            0x2100,   // movs r1, #0
                            0x6001,   // str r1, [r0]
                            0xE7F7};  // b wait

// Waits for SysTick's COUNTFLAG, every 3201 cycles, storing r4 at the start of RAM at each turn; counts in r4.
const Program kCountFlag = {0x20E0, 0x0600,          // r0 = 0xE0000000
                            0x23E0, 0x021B, 0x18C0,  // + 0xE000
                            0x2520, 0x062D,          // r5 = 0x20000000
                            0x22C8, 0x0112,          // r2 = 3200
                            0x6142, 0x6182,          // reload and value
                            0x2205, 0x6102,          // on, by the core's clock
                            0x602C,                  // wait: str r4, [r5]
                            0x6901,                  // ldr r1, [r0, #0x10]
                            0x0C49,                  // lsrs r1, #17
                            0xD3FB,                  // bcc wait
                            0x3401,                  // adds r4, #1
                            0xE7F9};                 // b wait

struct Pair {
  explicit Pair(const Program& program, bool fpu)
      : passed(program, config(fpu, true)), executed(program, config(fpu, false)) {
    passed.start();
    executed.start();
  }
  static MachineConfig config(bool fpu, bool fast_forward) {
    MachineConfig c;
    c.variant = fpu ? kCortexM4F : kCortexM0;
    c.fast_forward = fast_forward;
    return c;
  }
  template <class Work>
  void both(Work&& work) {
    work(passed);
    work(executed);
  }
  void expect_same(int step) {
    ASSERT_EQ(passed.machine.now(), executed.machine.now()) << step;
    ASSERT_TRUE(passed.machine.cpu().reg == executed.machine.cpu().reg) << step;
    ASSERT_EQ(passed.machine.report().instructions, executed.machine.report().instructions) << step;
    for (std::uint32_t at = kRamBase; at < kRamBase + 16; at += 4)
      ASSERT_EQ(passed.get(at), executed.get(at)) << step;
  }
  SmallMachine passed, executed;
};

// One of many things that come from outside between two runs; most often nothing.
void disturb(SmallMachine& small, unsigned which, unsigned random) {
  const std::uint32_t word = kRamBase + 4 * (random % 3);
  if (which == 0) small.put(word, random);
  if (which == 1) small.machine.cpu().reg.r[1u << random % 3] ^= 1u << random % 8;  // no address: r1, r2, r4
  if (which == 2) small.machine.bus_write(word, 2, random);
  if (which == 3) small.put(kCode + 0x40, random);  // flash that the loop does not read
}

void hold_to_execution(const Program& program, bool fpu) {
  Pair pair(program, fpu);
  std::mt19937 random(3);
  for (int step = 0; step < 4000; ++step) {
    const unsigned which = random() % 40, number = random();
    pair.both([&](SmallMachine& small) { disturb(small, which, number); });
    const Cycles until = pair.passed.machine.now() + 1 + random() % 300;
    pair.both([&](SmallMachine& small) { small.machine.run_until(until); });
    pair.expect_same(step);
    if (testing::Test::HasFatalFailure()) return;
  }
  const MachineReport report = pair.passed.machine.report();
  EXPECT_GT(static_cast<double>(report.skipped_cycles), 0.5 * static_cast<double>(pair.passed.machine.now()));
  EXPECT_EQ(pair.executed.machine.report().skipped_cycles, 0u);
}

TEST(KnownWait, ForAWordInRamIsAsIfExecuted) {
  hold_to_execution(kFlagInRam, false);
  hold_to_execution(kFlagInRam, true);
}

TEST(KnownWait, ForSysTickWithAStoreInItIsAsIfExecuted) {
  hold_to_execution(kCountFlag, false);
  hold_to_execution(kCountFlag, true);
}

TEST(KnownWait, EndsWhenItsCodeIsAnother) {
  Pair pair(kFlagInRam, false);
  pair.both([](SmallMachine& small) {
    for (Cycles until = 100; until < 2000; until += 100) small.machine.run_until(until);
    const std::uint8_t compare[] = {
        0x01, 0x29};  // cmp r1, #1: 0 is no longer waited for, and it goes round counting
    small.machine.program_flash(kCode + 6, compare);
    small.machine.run_until(3000);
  });
  pair.expect_same(0);
  pair.both([](SmallMachine& small) {
    const std::uint8_t branch[] = {0xFC, 0xD1};  // bne wait
    small.machine.program_flash(kCode + 8, branch);
    small.machine.run_until(4000);
  });
  pair.expect_same(1);
  pair.both([](SmallMachine& small) {
    small.put(kRamBase, 1);
    small.machine.run_until(5000);
  });
  pair.expect_same(2);
  EXPECT_GT(pair.passed.get(kRamBase + 4), 1u);
}

// SysTick's interval is changed by somebody else while the core waits for it: a debugger, at no instruction of the core.
TEST(KnownWait, EndsWhenSysTickIsSetFromOutside) {
  Pair pair(kCountFlag, false);
  for (int step = 0; step < 200; ++step) {
    pair.both([&](SmallMachine& small) {
      if (step % 20 == 7)
        small.machine.poke(0xE000E014,
                           std::vector<std::uint8_t>{static_cast<std::uint8_t>(40 + step), 0, 0, 0});
      if (step % 20 == 9) small.machine.poke(0xE000E018, std::vector<std::uint8_t>{0, 0, 0, 0});
      small.machine.run_until(small.machine.now() + 77);
    });
    pair.expect_same(step);
  }
}

}  // namespace
}  // namespace omnihil::mcu
