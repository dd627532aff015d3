// The machine around the core: bus, time, resets, reports. Programs are a few instructions, written as
// halfwords.
#include "firmware_iface/mcu/machine/machine.h"

#include <gtest/gtest.h>

#include "tests/firmware_iface/mcu/small_machine.h"

namespace omnihil::mcu {
namespace {

// A register that reads as `value` from the cycle `from` on and as 0 before.
class Later final : public Peripheral {
 public:
  Later(System& system, Cycles from, bool says_until_when)
      : Peripheral("later"), system_(system), from_(from), says_until_when_(says_until_when) {}
  void reset() override {}
  std::uint32_t read(std::uint32_t, unsigned) override {
    ++reads;
    return system_.now() >= from_ ? 1 : 0;
  }
  void write(std::uint32_t offset, unsigned, std::uint32_t) override {
    if (offset == 4) system_.request_reset("watchdog");
    if (offset == 8) system_.set_core_hz(32e6);
  }
  Cycles stable_until(std::uint32_t) const override {
    return !says_until_when_ ? 0 : system_.now() < from_ ? from_ : kNever;
  }
  std::uint64_t reads = 0;

 private:
  System& system_;
  Cycles from_;
  bool says_until_when_;
};

constexpr std::uint16_t kLdrR0FromR1 = 0x6808, kStrR0ToR1 = 0x6008;

TEST(MachineTest, TimeGoesByTheTableOfCycles) {
  SmallMachine small({kNopCode, kNopCode, kNopCode, kForever});
  small.start();
  small.machine.run_until(3);
  EXPECT_EQ(small.r(15), kCode + 6);
  EXPECT_EQ(small.machine.now(), 3u);
}

// Each round changes the instruction three places ahead of its store into a longer or a shorter one.
TEST(MachineTest, CodeThatChangesWhatFollowsTakesTheTimeOfWhatItBecomes) {
  // 1: strh r1, [r0]; eors r1, r2; nop; ldr r3, [r4] or movs r3, #1; adds r5, #1; b 1b
  constexpr std::uint32_t kLdr = 0x6823, kMovs = 0x2301, kAt = kRamBase + 0x100;
  constexpr Cycles kTwoRounds = 2 * (1 + 1 + 1 + 1 + (1 + kCortexM4F.taken_branch_cycles())) + 2 + 1;
  for (const Cycles quantum : {Cycles{1}, Cycles{7}, 1000 * kTwoRounds}) {
    SmallMachine small({kForever});
    small.start();
    small.put(kAt, 0x40518001);
    small.put(kAt + 4, kLdr << 16 | 0xBF00);
    small.put(kAt + 8, 0xE7F93501);
    Registers& reg = small.machine.cpu().reg;
    reg.r[0] = kAt + 6;
    reg.r[1] = kMovs;
    reg.r[2] = kLdr ^ kMovs;
    reg.r[4] = kRamBase;
    reg.r[15] = kAt;
    for (Cycles at = quantum; at < 1000 * kTwoRounds; at += quantum) small.machine.run_until(at);
    small.machine.run_until(1000 * kTwoRounds);
    EXPECT_EQ(small.r(5), 2000u) << quantum;
    EXPECT_EQ(small.r(15), kAt) << quantum;
    EXPECT_EQ(small.machine.report().instructions, 2000u * 6u) << quantum;
  }
}

// A row of more instructions than are added up at once.
TEST(MachineTest, ALongRowOfInstructionsStopsAtEveryInstant) {
  SmallMachine small(std::vector<std::uint16_t>(5000, kNopCode));
  for (const Cycles end : {Cycles{1}, Cycles{127}, Cycles{128}, Cycles{129}, Cycles{300}, Cycles{4999}}) {
    small.start();
    small.machine.run_until(end);
    EXPECT_EQ(small.r(15), kCode + 2 * end);
    EXPECT_EQ(small.machine.report().instructions, end);
  }
}

TEST(MachineTest, CpiScaleStretchesEveryCost) {
  SmallMachine small(std::vector<std::uint16_t>(400, kNopCode), {.cpi_scale = 1.25});
  small.start();
  small.machine.run_until(250);
  EXPECT_EQ(small.r(15), kCode + 2 * 200);  // 250 cycles / 1.25
}

TEST(MachineTest, PollingARegisterThatNamesItsNextChangeIsSkippedExactly) {
  // 1: ldr r0, [r1]; cmp r0, #0; beq 1b; b .
  const std::vector<std::uint16_t> code = {0xF04F, 0x4180, kLdrR0FromR1, 0x2800, 0xD0FC, kForever};
  Cycles left[2];
  std::uint64_t reads[2], instructions[2];
  for (const bool says : {false, true}) {
    SmallMachine small(code);
    Later later(small.machine, 50'000, says);
    small.machine.attach(0x40000000, 0x400, later);
    small.start();
    Cycles at = 0;
    while (small.r(15) < kCode + 10 && at < 100'000) small.machine.run_until(at += 1);
    small.machine.run_until(60'000);
    left[says] = at;
    instructions[says] = small.machine.report().instructions;
    small.start();
    later.reads = 0;
    small.machine.run_until(60'000);
    reads[says] = later.reads;
  }
  EXPECT_EQ(left[0], left[1]);
  EXPECT_EQ(instructions[0], instructions[1]);
  EXPECT_GT(left[0], 50'000u);
  EXPECT_LT(left[0], 50'010u);
  EXPECT_GT(reads[0], 5'000u);
  EXPECT_LT(reads[1], 500u);
}

TEST(MachineTest, WhatIsNotModelledIsNamedOnceWithItsPlaceAndReadsBack) {
  // movs r0, #5; mov r1, 0x40000000; str r0, [r1]; ldr r0, [r1]; ldr r0, [r1]
  SmallMachine small({0x2005, 0xF04F, 0x4180, kStrR0ToR1, kLdrR0FromR1, kLdrR0FromR1, kForever});
  small.start();
  small.machine.run_until(100);
  const MachineReport report = small.machine.report();
  ASSERT_EQ(report.unmodelled.size(), 2u);
  EXPECT_EQ(report.unmodelled[0].what, "0x40000000 written");
  EXPECT_EQ(report.unmodelled[0].pc, kCode + 6);
  EXPECT_EQ(report.unmodelled[1].what, "0x40000000 read");
  EXPECT_EQ(report.unmodelled[1].pc, kCode + 8);
  EXPECT_EQ(report.unmodelled[1].count, 2u);
  EXPECT_EQ(small.r(0), 5u);
}

TEST(MachineTest, AResetStartsAnewKeepsRamAndNamesItsCause) {
  // ldr r0, [pc, #8]; ldr r1, [r0]; adds r1, #1; str r1, [r0]; mov r1, 0x40000000; str r0, [r1, #4]; b .
  SmallMachine small({0x4803, 0x6801, 0x3101, 0x6001, 0xF04F, 0x4180, 0x6048, kForever, 0x0000, 0x2000});
  Later later(small.machine, 0, false);
  small.machine.attach(0x40000000, 0x400, later);
  small.start();
  small.machine.run_until(1000);
  EXPECT_EQ(small.machine.reset_cause(), "watchdog");
  EXPECT_GT(small.get(kRamBase), 20u);  // counted over the resets
  EXPECT_EQ(small.machine.report().resets[0].cause, "power-on");
  EXPECT_EQ(small.machine.report().resets[1].cause, "watchdog");
}

TEST(MachineTest, NanosecondsFollowAChangeOfTheClock) {
  // mov r1, 0x40000000; str r0, [r1, #8]; b .   The clock doubles from 16 to 32 MHz within the first
  // microsecond.
  SmallMachine small({0xF04F, 0x4180, 0x6088, kForever});
  Later later(small.machine, 0, false);
  small.machine.attach(0x40000000, 0x400, later);
  small.start();
  small.machine.run_until_ns(1'000'000);
  EXPECT_NEAR(static_cast<double>(small.machine.now()), 32'000.0, 4.0);
  EXPECT_GE(small.machine.to_ns(small.machine.now()), 1'000'000);
  EXPECT_LT(small.machine.to_ns(small.machine.now()), 1'000'200);
}

TEST(MachineTest, CodeInRamThatIsOverwrittenRunsAsWritten) {
  // movs r0, #0; ldr r1, [pc, #8]; ldr r2, [pc, #12]; strh r2, [r1]; bx (r1 | 1) twice by the caller below
  SmallMachine small({0x4904, 0x4A05, 0x800A, 0x1C4B, 0x4718, kForever, kForever, kForever, kForever,
                      kForever, 0x0000, 0x2000, 0x2007, 0x0000});
  small.start();
  small.put(kRamBase, 0xE7FE2001);  // movs r0, #1; b .
  small.machine.cpu().reg.r[15] = kRamBase;
  small.machine.run_until(100);
  EXPECT_EQ(small.r(0), 1u);
  small.machine.cpu().reg.r[15] = kCode;  // writes movs r0, #7 over it and jumps there
  small.machine.run_until(200);
  EXPECT_EQ(small.r(0), 7u);
}

TEST(MachineTest, ABusFaultWithoutAHandlerLocksUpAtTheVector) {
  // mov r1, 0x30000000; ldr r0, [r1]: HardFault, whose vector is erased flash.
  SmallMachine small({0xF04F, 0x5140, kLdrR0FromR1, kForever});
  small.start();
  small.machine.run_until(1000);
  const MachineReport report = small.machine.report();
  EXPECT_TRUE(report.locked_up);
  ASSERT_FALSE(report.faults.empty());
  EXPECT_EQ(report.faults[0].status, kPreciseBus | kBusAddressValid);
  EXPECT_EQ(report.faults[0].address, 0x30000000u);
  EXPECT_EQ(report.faults[0].pc, kCode + 4);
  EXPECT_EQ(small.machine.now(), 1000u);  // time goes on
}

TEST(MachineTest, OnACortexM0EveryFaultIsAHardFault) {
  // movs r0, #1; ldr r1, [r0] (unaligned); udf. The handler steps over: its frame's PC is at sp + 24.
  MachineConfig config;
  config.variant = kCortexM0;
  SmallMachine small({0x2001, 0x6801, 0xDE00, kForever, /* handler: */ 0x9806, 0x3002, 0x9006, 0x4770},
                     config);
  small.put(kFlashBase + 4 * kHardFault, (kCode + 8) | 1);
  small.start();
  small.machine.run_until(1000);
  const MachineReport report = small.machine.report();
  ASSERT_EQ(report.faults.size(), 2u);
  EXPECT_EQ(report.faults[0].exception, kHardFault);
  EXPECT_EQ(report.faults[0].status, kUnaligned);
  EXPECT_EQ(report.faults[1].exception, kHardFault);
  EXPECT_EQ(report.faults[1].status, kUndefinedInstruction);
  EXPECT_EQ(small.r(15), kCode + 6);
}

// A Cortex-M0+ has a vector table that moves in steps of 256 bytes; a Cortex-M0 has none.
TEST(MachineTest, OnACortexM0PlusTheVectorTableMoves) {
  for (const Variant& variant : {kCortexM0Plus, kCortexM0}) {
    MachineConfig config;
    config.variant = variant;
    // str r1, [r0] (VTOR); ldr r2, [r0]; udf. Handlers of HardFault: here r3 becomes 1, there 2.
    SmallMachine small(
        {0x6001, 0x6802, 0xDE00, kForever, /* here: */ 0x2301, kForever, /* there: */ 0x2302, kForever},
        config);
    small.put(kFlashBase + 4 * kHardFault, (kCode + 8) | 1);
    small.start();
    small.put(kRamBase + 0x100 + 4 * kHardFault, (kCode + 12) | 1);
    small.machine.cpu().reg.r[0] = 0xE000ED08u;
    small.machine.cpu().reg.r[1] = kRamBase + 0x1FF;
    small.machine.run_until(200);
    EXPECT_EQ(small.r(2), variant.plus ? kRamBase + 0x100 : kFlashBase);
    EXPECT_EQ(small.r(3), variant.plus ? 2u : 1u);
  }
}

// DDI 0484C table 3-1 against DDI 0439D table 3-1: a store 2 cycles instead of 1, a taken branch 2 instead of 3, BL 3.
TEST(MachineTest, ACortexM0PlusTakesItsOwnCyclesForStoresAndBranches) {
  for (const auto& [variant, cycles] :
       {std::pair{kCortexM0Plus, 1 + 2 + 2 + 3}, {kCortexM4, 1 + 1 + 3 + 3}}) {
    MachineConfig config;
    config.variant = variant;
    // movs r0, #0; str r0, [r1]; b +0; bl +0; movs r2, #1
    SmallMachine small({0x2000, 0x6008, 0xE7FF, 0xF000, 0xF800, 0x2201, kForever}, config);
    small.start();
    small.machine.cpu().reg.r[1] = kRamBase;
    small.machine.run_until(cycles);
    EXPECT_EQ(small.r(2), 0u) << variant.name;
    small.machine.run_until(cycles + 1);
    EXPECT_EQ(small.r(2), 1u) << variant.name;
  }
}

TEST(MachineTest, LoadOfInterruptsIsTheirCyclesWithoutWhatPreemptsThem) {
  // SysTick every 100 cycles: 12 to enter, 10 to leave, and its handler of 20 NOPs and BX.
  std::vector<std::uint16_t> code = {kForever, kNopCode};
  code.insert(code.end(), 20, kNopCode);
  code.push_back(0x4770);
  SmallMachine small(code);
  small.put(kFlashBase + 4 * kSysTick, (kCode + 4) | 1);
  small.start();
  for (const auto& [address, value] : {std::pair{0xE000E014u, 99u}, {0xE000E018u, 0u}, {0xE000E010u, 7u}}) {
    // By code, as DMA does not reach the core's registers: str r1, [r0]; b .
    small.machine.cpu().reg.r[0] = address;
    small.machine.cpu().reg.r[1] = value;
    small.put(kRamBase, 0xE7FE6001);
    small.machine.cpu().reg.r[15] = kRamBase;
    small.machine.run_until(small.machine.now() + 10);
  }
  small.machine.run_until(100'000);
  const MachineReport report = small.machine.report();
  const InterruptLoad& load = report.exceptions.at(kSysTick);
  EXPECT_NEAR(static_cast<double>(load.count), 1000.0, 2.0);
  EXPECT_EQ(load.longest, 20u + 1u);
  const double busy = static_cast<double>(load.busy) / static_cast<double>(load.count);
  EXPECT_GE(busy, 21.0);
  EXPECT_LE(busy, 21.0 + 10.0);  // leaving may be counted with it
  EXPECT_EQ(report.thread_cycles + load.busy + report.sleep_cycles, small.machine.now());
}

TEST(MachineTest, TheMainStacksHighWaterMarkIsKept) {
  SmallMachine small({0xB5F0, 0xB088, 0xB008, 0xBDF0});  // push {r4-r7, lr}; sub sp, #32; add sp, #32; pop
  small.start();
  small.machine.run_until(8);
  EXPECT_EQ(small.machine.report().main_stack_bytes, 5u * 4 + 32);
}

TEST(MachineTest, DmaReachesRamAndPeripheralsAndSpoilsNoCode) {
  SmallMachine small({kForever});
  Later later(small.machine, 0, false);
  small.machine.attach(0x40000000, 0x400, later);
  small.start();
  small.machine.bus_write(kRamBase + 2, 2, 0xABCD);
  EXPECT_EQ(small.get(kRamBase), 0xABCD0000u);
  EXPECT_EQ(small.machine.bus_read(kRamBase + 3, 1), 0xABu);
  EXPECT_EQ(small.machine.bus_read(0x40000000, 4), 1u);
  EXPECT_TRUE(small.machine.report().unmodelled.empty());
  small.machine.bus_write(0x90000000, 4, 1);
  EXPECT_EQ(small.machine.report().unmodelled.size(), 1u);
}

}  // namespace
}  // namespace omnihil::mcu
