// The exception model, played by images/exceptions.c: what its handlers log, in order.
#include "tests/firmware_iface/mcu/image_bench.h"

namespace omnihil::mcu {
namespace {

enum Scenario : std::uint32_t {
  kNesting = 1,
  kPendInHandler,
  kPrimask,
  kBasepri,
  kWfiMasked,
  kExcReturns,
  kFpContext,
  kFpContextLost,
  kSvc,
  kPendSvLast,
  kEverywhere,
  kLateArrival,
  kFaults,
  kToArmState,
  kLockUp,
  kLevel,
  kSysTickPeriod,
  kEvents,
  kCycles,
  kBusyWait,
  kNullPointer,
  kUnalignedAccess,
  kBitBand,
};
using Log = std::vector<std::uint32_t>;

class ExceptionTest : public ::testing::Test {
 protected:
  void SetUp() override { OMNIHIL_NEED_IMAGES(); }
  static Log play(Scenario scenario) {
    ImageBench bench("exceptions");
    bench.probe.scenario = scenario;
    EXPECT_TRUE(bench.run());
    return bench.probe.log;
  }
};

TEST_F(ExceptionTest, MoreUrgentPreemptsAndLessUrgentWaits) {
  EXPECT_EQ(play(kNesting), (Log{10, 1, 11, 2, 99}));
}
TEST_F(ExceptionTest, PendedInItsOwnHandlerRunsAgainAfterIt) {
  EXPECT_EQ(play(kPendInHandler), (Log{10, 20, 11, 20, 99}));
}
TEST_F(ExceptionTest, PrimaskHoldsBackAndReleases) { EXPECT_EQ(play(kPrimask), (Log{10, 1, 99})); }
TEST_F(ExceptionTest, BasepriLetsMoreUrgentThrough) { EXPECT_EQ(play(kBasepri), (Log{2, 10, 1, 99})); }
TEST_F(ExceptionTest, WfiWakesByAMaskedInterrupt) { EXPECT_EQ(play(kWfiMasked), (Log{10, 1, 99})); }
TEST_F(ExceptionTest, SixValuesOfExcReturn) {
  EXPECT_EQ(play(kExcReturns),
            (Log{0xFFFFFFF9, 0xFFFFFFFD, 0xFFFFFFF1, 0xFFFFFFE9, 0xFFFFFFED, 0xFFFFFFE1, 99}));
}
TEST_F(ExceptionTest, FpRegistersSurvivePreemption) { EXPECT_EQ(play(kFpContext), Log{0}); }
TEST_F(ExceptionTest, WithoutFpStackingTheyDoNot) {
  const Log log = play(kFpContextLost);
  ASSERT_EQ(log.size(), 1u);
  EXPECT_GT(log[0], 0u);
}
TEST_F(ExceptionTest, SvcFromThreadAndHandlerAndEscalatedWhereItMayNot) {
  constexpr std::uint32_t kForced = 1u << 30;
  EXPECT_EQ(play(kSvc), (Log{3, 10, 3, 11, 3, 0, kForced, 99}));
}
TEST_F(ExceptionTest, PendSvRunsLast) { EXPECT_EQ(play(kPendSvLast), (Log{10, 2, 3, 99})); }
TEST_F(ExceptionTest, AnInterruptMayComeAnywhereInItBlocksAndLists) {
  EXPECT_EQ(play(kEverywhere), (Log{0, 1}));
}
TEST_F(ExceptionTest, LateArrivalIsServedFirst) { EXPECT_EQ(play(kLateArrival), (Log{2, 1, 99})); }

TEST_F(ExceptionTest, EveryFaultHasItsStatusAndEscalatesWhenDisabled) {
  constexpr std::uint32_t kForced = 1u << 30;
  constexpr std::uint32_t kStatus[] = {kUndefinedInstruction,          kDivideByZero, kUnaligned, kUnaligned,
                                       kPreciseBus | kBusAddressValid, kNoCp};
  Log expected;
  for (const bool enabled : {true, false}) {
    for (const std::uint32_t status : kStatus) {
      const bool bus = status & 0xFF00;
      const std::uint32_t number = !enabled ? kHardFault : bus ? kBusFault : kUsageFault;
      expected.insert(expected.end(), {number, status, enabled ? 0 : kForced});
      if (bus) expected.push_back(0x30000000);
    }
  }
  expected.push_back(99);
  EXPECT_EQ(play(kFaults), expected);
}

TEST_F(ExceptionTest, AJumpToAnEvenAddressIsAnInvalidState) {
  const Log log = play(kToArmState);
  EXPECT_EQ(log, (Log{kUsageFault, kInvalidState, 0, 99}));
}

TEST_F(ExceptionTest, AFaultInTheHardFaultHandlerLocksUp) {
  ImageBench bench("exceptions");
  bench.probe.scenario = kLockUp;
  EXPECT_FALSE(bench.run());
  EXPECT_TRUE(bench.machine.stopped());
  EXPECT_TRUE(bench.machine.report().locked_up);
  EXPECT_EQ(bench.image.function_at(bench.machine.report().lock_up_pc).substr(0, 11), "fault_again");
}

TEST_F(ExceptionTest, ALineThatStaysHighPendsAgain) { EXPECT_EQ(play(kLevel), (Log{10, 11, 12, 99})); }

TEST_F(ExceptionTest, SysTickComesEveryLoadPlusOneCycles) {
  ImageBench bench("exceptions");
  bench.probe.scenario = kSysTickPeriod;
  ASSERT_TRUE(bench.run());
  ASSERT_EQ(bench.probe.times.size(), 5u);
  for (std::size_t i = 1; i < 5; ++i) EXPECT_EQ(bench.probe.times[i] - bench.probe.times[i - 1], 1000u) << i;
}

TEST_F(ExceptionTest, WfeGoesOnWithAnEventAndWaitsWithoutOne) {
  ImageBench bench("exceptions");
  bench.probe.scenario = kEvents;
  ASSERT_TRUE(bench.run());
  EXPECT_EQ(bench.probe.log, (Log{1, 1, 2}));
  EXPECT_GT(bench.machine.report().sleep_cycles, 400u);
}

TEST_F(ExceptionTest, TheCycleCounterCountsCycles) {
  const Log log = play(kCycles);
  ASSERT_EQ(log.size(), 1u);
  EXPECT_EQ(log[0], 10u + 2u);  // ten NOPs and the load that reads it
}

TEST_F(ExceptionTest, BitBandReachesOneBitOfRamAndOfPeripherals) {
  EXPECT_EQ(play(kBitBand), (Log{512, 1, 1}));
}

TEST_F(ExceptionTest, EntryTakesTwelveCyclesFromTheCause) {
  ImageBench bench("exceptions");
  bench.probe.scenario = kEvents;
  ASSERT_TRUE(bench.run());
  const InterruptLoad load = bench.machine.report().exceptions.at(kFirstIrq);
  EXPECT_EQ(load.count, 1u);
  EXPECT_EQ(load.longest_latency, 12u);  // raised while asleep
}

TEST_F(ExceptionTest, NullPointersAreReportedWithTheirPlace) {
  ImageBench bench("exceptions");
  bench.probe.scenario = kNullPointer;
  ASSERT_TRUE(bench.run());
  const MachineReport report = bench.machine.report();
  ASSERT_EQ(report.null_accesses.size(), 2u);
  EXPECT_FALSE(report.null_accesses[0].is_write);
  EXPECT_EQ(report.null_accesses[0].address, 4u);
  EXPECT_TRUE(report.null_accesses[1].is_write);
  EXPECT_EQ(report.null_accesses[1].address, 8u);
  EXPECT_NE(bench.image.function_at(report.null_accesses[1].pc).find("null_pointer"), std::string::npos);
}

TEST_F(ExceptionTest, UnalignedAccessWorksAndIsCounted) {
  ImageBench bench("exceptions");
  bench.probe.scenario = kUnalignedAccess;
  ASSERT_TRUE(bench.run());
  EXPECT_EQ(bench.probe.log, Log{0x55443322});
  EXPECT_EQ(bench.machine.report().unaligned_count, 1u);
}

// ---- the same bytes however the time is cut

struct Outcome {
  Log log;
  std::vector<Cycles> times;
  std::uint64_t instructions;
  Cycles thread, sleep;
  bool operator==(const Outcome&) const = default;
};

Outcome outcome(Scenario scenario, Cycles quantum, bool fast_forward, double cpi_scale = 1.0) {
  MachineConfig config;
  config.fast_forward = fast_forward;
  config.cpi_scale = cpi_scale;
  ImageBench bench("exceptions", config);
  bench.probe.scenario = scenario;
  for (Cycles at = quantum; at <= 300'000; at += quantum) bench.machine.run_until(at);
  bench.machine.run_until(300'000);
  const MachineReport report = bench.machine.report();
  return {bench.probe.log, bench.probe.times, report.instructions, report.thread_cycles, report.sleep_cycles};
}

TEST_F(ExceptionTest, AnyQuantumGivesTheSame) {
  for (const Scenario scenario :
       {kNesting, kWfiMasked, kFpContext, kLateArrival, kSysTickPeriod, kBusyWait, kEverywhere}) {
    const Outcome once = outcome(scenario, 300'000, true, 1.3);
    for (const Cycles quantum : {Cycles{7}, Cycles{100}, Cycles{999}, Cycles{31'337}}) {
      const Outcome cut = outcome(scenario, quantum, true, 1.3);
      EXPECT_EQ(cut.log, once.log) << scenario << " " << quantum;
      EXPECT_EQ(cut.times, once.times) << scenario << " " << quantum;
      EXPECT_EQ(cut.instructions, once.instructions) << scenario << " " << quantum;
      EXPECT_EQ(cut.sleep, once.sleep) << scenario << " " << quantum;
    }
  }
}

TEST_F(ExceptionTest, FastForwardChangesNothingButTheWork) {
  for (const Scenario scenario : {kFpContext, kBusyWait, kWfiMasked, kEverywhere}) {
    EXPECT_EQ(outcome(scenario, 300'000, true), outcome(scenario, 300'000, false)) << scenario;
  }
  ImageBench bench("exceptions");
  bench.probe.scenario = kBusyWait;
  ASSERT_TRUE(bench.run());
  EXPECT_GT(bench.machine.report().skipped_cycles, 90'000u);
}

}  // namespace
}  // namespace omnihil::mcu
