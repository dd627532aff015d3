// A debugger's halts: where they are, and that they change nothing.
#include "firmware_iface/mcu/machine/debug_unit.h"

#include <gtest/gtest.h>

#include <functional>
#include <random>

#include "firmware_iface/mcu/board/mcu_firmware.h"
#include "firmware_iface/mcu/stm32/usart.h"
#include "tests/firmware_iface/mcu/image_bench.h"
#include "tests/firmware_iface/mcu/small_machine.h"

namespace omnihil::mcu {
namespace {

struct Seen {
  HaltCause cause;
  std::uint32_t pc;
  bool operator==(const Seen&) const = default;
};
std::ostream& operator<<(std::ostream& out, const Seen& seen) {
  return out << "cause " << static_cast<int>(seen.cause) << " at " << std::hex << seen.pc;
}

// Keeps every halt and does what it is told at each.
struct Script final : DebugListener {
  std::vector<Seen> halts;
  std::function<void(DebugUnit&, const Halt&)> then = [](DebugUnit&, const Halt&) {};
  void halted(DebugUnit& unit, const Halt& halt) override {
    halts.push_back({halt.cause, unit.machine().cpu().reg.r[15]});
    then(unit, halt);
  }
};

constexpr std::uint16_t kAddR0 = 0x3001, kCmpR0R0 = 0x4280, kItte = 0xBF06, kStrR0ToR1 = 0x6008,
                        kLdrR2FromR1 = 0x680A;

TEST(DebugUnit, HaltsBeforeTheInstructionAndGoesOnFromIt) {
  SmallMachine small({kAddR0, kAddR0, kAddR0, 0xE7FB});  // 1: adds r0, #1 three times; b 1b
  small.start();
  Script script;
  DebugUnit& debug = small.machine.debug(script);
  std::vector<std::uint32_t> r0;
  script.then = [&](DebugUnit& unit, const Halt&) { r0.push_back(unit.machine().cpu().reg.r[0]); };
  debug.set_breakpoints({kCode + 4});
  small.machine.run_until(3 * (3 + 1 + kCortexM4F.taken_branch_cycles()));
  EXPECT_EQ(script.halts, (std::vector<Seen>(3, {HaltCause::kBreakpoint, kCode + 4})));
  EXPECT_EQ(r0, (std::vector<std::uint32_t>{2, 5, 8}));
  EXPECT_EQ(small.r(0), 9u);
  EXPECT_EQ(small.get(kCode) >> 16, kAddR0) << "the image is as it was";
}

TEST(DebugUnit, HaltsInsideOfAnItBlockWithoutLosingItsConditions) {
  // cmp r0, r0; itte eq: adds, adds, (ne) adds; b .
  for (std::uint32_t at = kCode; at <= kCode + 8; at += 2) {
    SmallMachine small({kCmpR0R0, kItte, kAddR0, kAddR0, kAddR0, kForever});
    small.start();
    Script script;
    DebugUnit& debug = small.machine.debug(script);
    debug.set_breakpoints({at});
    script.then = [&](DebugUnit& unit, const Halt&) { unit.set_breakpoints({kCode + 8, kCode + 10}); };
    small.machine.run_until(20);
    EXPECT_EQ(script.halts.front(), (Seen{HaltCause::kBreakpoint, at}));
    EXPECT_EQ(small.r(0), 2u) << at;
  }
}

TEST(DebugUnit, AStepIsOneInstruction) {
  SmallMachine small({kAddR0, kNopCode, kAddR0, kForever});
  small.start();
  Script script;
  DebugUnit& debug = small.machine.debug(script);
  debug.ask();
  script.then = [&](DebugUnit& unit, const Halt&) {
    if (script.halts.size() < 5) unit.step();
  };
  small.machine.run_until(100);
  EXPECT_EQ(script.halts, (std::vector<Seen>{{HaltCause::kAsked, kCode},
                                             {HaltCause::kStep, kCode + 2},
                                             {HaltCause::kStep, kCode + 4},
                                             {HaltCause::kStep, kCode + 6},
                                             {HaltCause::kStep, kCode + 6}}));
}

TEST(DebugUnit, AWatchHaltsBehindTheInstructionThatTouches) {
  // str r0, [r1]; ldr r2, [r1]; b .
  for (const std::uint8_t kinds :
       {std::uint8_t{kWrites}, std::uint8_t{kReads}, std::uint8_t{kWrites | kReads}}) {
    SmallMachine small({kNopCode, kStrR0ToR1, kLdrR2FromR1, kForever});
    small.start();
    small.machine.cpu().reg.r[1] = kRamBase + 0x40;
    Script script;
    const AccessWatch watch{kRamBase + 0x42, 1, kinds};
    script.then = [&](DebugUnit&, const Halt& halt) { EXPECT_EQ(halt.hit.watch, watch); };
    small.machine.debug(script).set_watchpoints({watch, {kRamBase + 0x44, 4, kWrites | kReads}});
    small.machine.run_until(50);
    std::vector<Seen> expected;
    if ((kinds & kWrites) != 0) expected.push_back({HaltCause::kWatchpoint, kCode + 4});
    if ((kinds & kReads) != 0) expected.push_back({HaltCause::kWatchpoint, kCode + 6});
    EXPECT_EQ(script.halts, expected) << int{kinds};
  }
}

TEST(DebugUnit, AFaultHaltsAtItsInstructionWhenTheyAreCaught) {
  for (const bool caught : {true, false}) {
    SmallMachine small({kNopCode, 0xDE00, kForever});  // udf
    small.start();
    Script script;
    DebugUnit& debug = small.machine.debug(script);
    debug.set_catching(caught);
    small.machine.run_until(10);
    EXPECT_EQ(script.halts,
              caught ? (std::vector<Seen>{{HaltCause::kFault, kCode + 2}}) : std::vector<Seen>{});
  }
}

TEST(DebugUnit, GoesOnBehindABkptInstruction) {
  SmallMachine small({0xBE01, kAddR0, kForever});
  small.start();
  Script script;
  small.machine.debug(script).set_catching(true);
  small.machine.run_until(20);
  EXPECT_EQ(script.halts, (std::vector<Seen>{{HaltCause::kInstruction, kCode}}));
  EXPECT_EQ(small.r(0), 1u);
}

// The exceptions' image logs what its handlers do and when: steps, halts and watches at random instants change neither.
TEST(DebugUnit, HaltingChangesNoResult) {
  OMNIHIL_NEED_IMAGES();
  std::size_t halts = 0;
  for (std::uint32_t scenario = 0; scenario < 8; ++scenario) {
    ImageBench plain("exceptions");
    plain.probe.scenario = scenario;
    const bool ends = plain.run();
    ImageBench held("exceptions");
    held.probe.scenario = scenario;
    Script script;
    DebugUnit& debug = held.machine.debug(script);
    std::mt19937 random(scenario);
    script.then = [&](DebugUnit& unit, const Halt&) {
      const std::uint32_t pc = unit.machine().cpu().reg.r[15];
      const auto ahead = static_cast<std::uint32_t>(2 * (random() % 20)),
                 behind = static_cast<std::uint32_t>(2 * (random() % 10));
      unit.set_breakpoints({pc + ahead, pc, pc - behind});
      unit.set_watchpoints(
          random() % 3 != 0
              ? std::vector<AccessWatch>{}
              : std::vector<AccessWatch>{
                    {static_cast<std::uint32_t>(0x20000000u + 4 * (random() % 64)), 4, kReads | kWrites}});
      if (random() % 2 == 0) unit.step();
      if (random() % 8 == 0) unit.ask();
      if (script.halts.size() > 3000) unit.set_breakpoints({}), unit.set_watchpoints({});
    };
    for (Cycles at = 0; at < 20'000'000 && !held.done() && !held.machine.stopped();
         at += 1 + random() % 1000) {
      if (script.halts.size() < 3000) debug.ask();
      held.machine.run_until(at);
    }
    EXPECT_EQ(held.done(), ends);
    EXPECT_EQ(held.probe.log, plain.probe.log) << scenario;
    EXPECT_EQ(held.probe.times, plain.probe.times) << scenario;
    EXPECT_EQ(held.machine.report().instructions, plain.machine.report().instructions) << scenario;
    halts += script.halts.size();
  }
  EXPECT_GT(halts, 1000u);
}

TEST(DebugUnit, AStepPassesOverTheInterruptsThatComeIn) {
  OMNIHIL_NEED_IMAGES();
  ImageBench bench("exceptions");
  bench.probe.scenario = 0;
  Script script;
  DebugUnit& debug = bench.machine.debug(script);
  debug.ask();
  std::vector<std::uint32_t> levels;
  script.then = [&](DebugUnit& unit, const Halt&) {
    levels.push_back(unit.machine().cpu().reg.ipsr);
    if (levels.size() < 5000) unit.step();
  };
  bench.run();
  EXPECT_EQ(levels, std::vector<std::uint32_t>(levels.size(), 0));
  EXPECT_GT(bench.machine.report().exceptions.size(), 0u);
}

// ---- looking at registers

const std::string kBoard = OMNIHIL_SOURCE_DIR "/boards/omni_reference_f405.toml";

struct Driven {
  std::vector<double> duty;
  MachineReport report;
};

Driven drive_reference(bool look) {
  const std::vector<std::uint8_t> bytes = image_bytes("omni_reference_f405"), text = file_bytes(kBoard);
  ElfImage elf;
  std::vector<std::string> broken;
  read_elf(bytes, elf, broken);
  std::vector<BoardProblem> problems;
  const auto spec = read_board(std::string(text.begin(), text.end()), kBoard, problems, {});
  McuBoard board(*spec, elf);
  Driven driven;
  WorldState world;
  world.bus_voltage_V = 22.2;
  for (int tick = 0; tick < 400; ++tick) {
    world.at_ns = tick * 250'000;
    world.theta_rotor_rad.fill(0.01 * tick * (tick % 7 - 3));
    board.set_world(world);
    board.run_until_ns(world.at_ns + 250'000);
    for (const Chip::Mapped& block : board.chip().blocks()) {
      std::uint8_t raw[0x100];
      if (look) board.machine().peek(block.base, std::span(raw).first(std::min(block.bytes, 0x100u)));
    }
    std::uint8_t core[0x100];
    for (const std::uint32_t base : {0xE000E000u, 0xE000E100u, 0xE000ED00u, 0xE0001000u}) {
      if (look) board.machine().peek(base, core);
    }
    for (const MotorEntry& motor : spec->motors)
      driven.duty.push_back(board.wire(motor.wheel)->now().duty_ratio);
  }
  driven.report = board.machine().report();
  return driven;
}

TEST(DebugUnit, LookingAtEveryRegisterChangesNothing) {
  OMNIHIL_NEED_IMAGES();
  if (image_bytes("omni_reference_f405").empty()) GTEST_SKIP() << "no reference image";
  const Driven plain = drive_reference(false), looked = drive_reference(true);
  EXPECT_EQ(looked.duty, plain.duty);
  EXPECT_EQ(looked.report.instructions, plain.report.instructions);
  EXPECT_EQ(looked.report.unmodelled.size(), plain.report.unmodelled.size());
}

TEST(DebugUnit, AReceivedByteIsSeenWithoutBeingTaken) {
  const ChipSpec* spec = find_chip("stm32f405");
  Machine machine(machine_config(*spec));
  Chip chip(*spec, machine);
  attach(chip, machine);
  constexpr std::uint32_t kUsart1 = 0x40011000;
  std::uint8_t word[4] = {0x10, 0, 0, 0}, control[4] = {0x04, 0x20, 0, 0};  // BRR; UE, RE
  machine.power_on();
  machine.poke(kUsart1 + 8, word);
  machine.poke(kUsart1 + 0xC, control);
  const std::uint8_t sent[] = {0xA5};
  chip.find<Usart>("USART1")->feed(sent, 0);
  machine.run_until_ns(1'000'000);
  std::uint8_t status[1], data[1];
  for (int i = 0; i < 2; ++i) {
    ASSERT_TRUE(machine.peek(kUsart1 + 4, data) && machine.peek(kUsart1, status));
    EXPECT_EQ(data[0], 0xA5);
    EXPECT_EQ(status[0] & 0x20, 0x20) << "RXNE";
  }
}

}  // namespace
}  // namespace omnihil::mcu
