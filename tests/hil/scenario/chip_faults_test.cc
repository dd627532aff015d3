// Faults in an emulated chip: each does what it says, and the fuzz finds a planted weakness and makes it small.
#include <cmath>
#include <filesystem>
#include <fstream>

#include "firmware_iface/mcu/board/boards_chip.h"
#include "firmware_iface/mcu/stm32/usart.h"
#include "hil/scenario/chip_fuzz.h"
#include "hil/variables/variable_watch.h"
#include "tests/hil/observe/observed_image.h"
#include "tests/tools/cli.h"

namespace omnihil {
namespace {

namespace fs = std::filesystem;

const std::string kImages = OMNIHIL_BUILD_DIR "/images/";
const std::string kReference = kImages + "omni_reference_f405.elf";
const std::string kBoardFile = OMNIHIL_SOURCE_DIR "/boards/omni_reference_f405.toml";
constexpr int kControl = 16 + 54;  // TIM6

std::uint32_t address_of(const std::string& variable) {
  const VariableNames names(debug_info_of(kReference), {});
  std::string problem;
  const auto place = names.find(variable, problem);
  EXPECT_TRUE(place) << problem;
  return place ? static_cast<std::uint32_t>(place->piece.address) : 0;
}

ScenarioRun run_with(const std::string& steps, const std::string& image = kReference) {
  const ScenarioReading reading = read_scenario(
      "format = \"omnihil-scenario/1\"\ntitle = \"faults\"\nstand = true\nduration_s = 0.6\n"
      "[[step]]\nat_s = 0.1\ndo = \"command\"\nomega_wheel_rad_s = 20.0\n" +
          steps + "[[check]]\nis = \"signal\"\nsignal = \"yaw_rad\"\nat_most_rad = 10\n",
      "faults.toml");
  for (const ModelProblem& problem : reading.problems) ADD_FAILURE() << problem.text();
  SuiteOptions options;
  options.firmware = {.file = image, .board = kBoardFile};
  options.watch = {"main.c:now_us", "state(reference_state).ticks"};
  options.model_folders = {OMNIHIL_SOURCE_DIR "/models"};
  return run_of(*reading.scenario, options);
}

double at(const ScenarioRun& run, const std::string& signal, double at_s) {
  const auto t = run.trace.time_s();
  const auto found = std::ranges::lower_bound(t, at_s - 1e-7);
  return run.trace.column(signal)[static_cast<std::size_t>(found - t.begin())];
}

class ChipFaults : public testing::Test {
 protected:
  void SetUp() override {
    if (!fs::exists(kReference)) GTEST_SKIP() << "arm-none-eabi-gcc is not installed";
  }
};

// Bit 5 of the third byte of a counter is 2^21 of it.
TEST_F(ChipFaults, ABitOfRamTurnsOver) {
  const ScenarioRun plain = run_with("");
  const ScenarioRun hit = run_with("[[step]]\nat_s = 0.3000004\ndo = \"flip_ram\"\naddress = " +
                                   std::to_string(address_of("main.c:now_us") + 2) + "\nbit = 5\n");
  const std::string now = "var:main.c:now_us";
  EXPECT_EQ(at(hit, now, 0.29), at(plain, now, 0.29));
  EXPECT_EQ(at(hit, now, 0.4) - at(plain, now, 0.4), std::ldexp(1.0, 21));
}

TEST_F(ChipFaults, ABrownOutResetStartsTheImageAnew) {
  const ScenarioRun run = run_with("[[step]]\nat_s = 0.3\ndo = \"brown_out_reset\"\n");
  const std::string ticks = "var:state(reference_state).ticks";
  EXPECT_NEAR(at(run, ticks, 0.29), 290, 5);
  EXPECT_NEAR(at(run, ticks, 0.5), 200, 5);  // of the new life
}

// 0.9 of the rate from 0.2 to 0.4 s: 180 control periods where there are 200.
TEST_F(ChipFaults, AClockThatIsOffStretchesTheControlPeriod) {
  const ScenarioRun plain = run_with("");
  const ScenarioRun off = run_with("[[step]]\nat_s = 0.2\nfor_s = 0.2\ndo = \"clock_off\"\nratio = 0.9\n");
  const std::string ticks = "var:state(reference_state).ticks";
  EXPECT_NEAR(at(plain, ticks, 0.4) - at(plain, ticks, 0.2), 200, 1);
  EXPECT_NEAR(at(off, ticks, 0.4) - at(off, ticks, 0.2), 180, 1.5);
  EXPECT_NEAR(at(off, ticks, 0.5) - at(off, ticks, 0.4), 100, 1.5);  // and back
}

TEST_F(ChipFaults, AStormRaisesItsInterrupt) {
  ObservedImage plain, hit;
  mcu::BoardsChip chip(*hit.firmware, hit.elf);
  EXPECT_EQ(chip.schedule({.kind = ChipFaultKind::kInterruptStorm,
                           .at_ns = 50'000'000,
                           .until_ns = 60'000'000,
                           .irq = 54,
                           .rate_Hz = 5000.0}),
            "");
  plain.run_ms(100);
  hit.run_ms(100);
  const auto count = [](ObservedImage& run) { return run.machine().report().exceptions.at(kControl).count; };
  EXPECT_NEAR(static_cast<double>(count(hit) - count(plain)), 50.0, 2.0);  // 10 ms at 5 kHz
}

// The image that hangs is bitten 20 ms after its last feed; with half of the rate 40 ms after it.
TEST_F(ChipFaults, AWatchdogThatIsLateBitesLater) {
  ObservedImage plain(kImages + "reference_hangs.elf"), late(kImages + "reference_hangs.elf");
  mcu::BoardsChip chip(*late.firmware, late.elf);
  EXPECT_EQ(chip.schedule({.kind = ChipFaultKind::kWatchdogLate, .at_ns = 0, .ratio = 0.5}), "");
  plain.run_ms(2500);
  late.run_ms(2500);
  const auto first_ns = [](ObservedImage& run) {
    const mcu::MachineReport report = run.machine().report();
    EXPECT_GE(report.resets.size(), 2u);
    return report.resets.size() < 2 ? 0 : run.machine().to_ns(report.resets[1].at);
  };
  EXPECT_NEAR(static_cast<double>(first_ns(late) - first_ns(plain)) * 1e-6, 20.0, 0.5);
}

TEST_F(ChipFaults, ABitOfTheFlashStaysTurned) {
  ObservedImage run;
  mcu::BoardsChip chip(*run.firmware, run.elf);
  const auto flash = chip.flash_in_use();
  ASSERT_FALSE(flash.empty());
  const std::uint32_t address = flash.front().begin + 8;  // the vector of NMI, which never comes
  std::uint8_t before = 0, after = 0;
  run.machine().memory().read(address, {&before, 1});
  EXPECT_EQ(
      chip.schedule({.kind = ChipFaultKind::kFlashBit, .at_ns = 1'000'000, .address = address, .bit = 6}),
      "");
  run.run_ms(5);
  run.machine().reset("pin");
  run.run_ms(5);
  run.machine().memory().read(address, {&after, 1});
  EXPECT_EQ(after, before ^ 0x40);
}

// A hundred bytes to a serial port at 115,200 baud: 86.8 us each. The fault leaves those that had not been fetched, the
// stream's error flag and its enable bit off; what is in the port still leaves.
TEST_F(ChipFaults, ADmaErrorEndsTheTransferThatIsOn) {
  constexpr std::uint32_t kUsart3 = 0x40004800, kDma1 = 0x40026000, kStream3 = kDma1 + 0x10 + 3 * 0x18;
  struct Outcome {
    int sent = 0;
    std::uint32_t left = 0, flags = 0, control = 0;
  };
  const auto run_one_transfer = [&](bool fails) {
    ObservedImage run;
    mcu::BoardsChip chip(*run.firmware, run.elf);
    Outcome outcome;
    run.firmware->board(0).chip().find<mcu::Usart>("USART3")->on_transmit(
        [&outcome](std::uint8_t, mcu::Cycles) { ++outcome.sent; });
    if (fails) {
      EXPECT_EQ(chip.schedule({.kind = ChipFaultKind::kDmaError, .at_ns = 14'000'000}), "");
    }
    run.run_ms(10);
    const auto set = [&run](std::uint32_t address, std::uint32_t value) {
      run.machine().bus_write(address, 4, value);
    };
    set(kUsart3 + 0x08, 365);                           // 42 MHz / 115,200
    set(kUsart3 + 0x14, 1u << 7);                       // DMAT
    set(kUsart3 + 0x0C, 1u << 13 | 1u << 3);            // UE, TE
    set(kStream3 + 0x04, 100);                          // NDTR
    set(kStream3 + 0x08, kUsart3 + 0x04);               // to DR
    set(kStream3 + 0x0C, 0x08000000);                   // from flash
    set(kStream3, 4u << 25 | 1u << 10 | 1u << 6 | 1u);  // channel 4, MINC, memory to peripheral, EN
    run.run_ms(20);
    outcome.left = run.machine().bus_read(kStream3 + 0x04, 4);
    outcome.flags = run.machine().bus_read(kDma1, 4);  // LISR
    outcome.control = run.machine().bus_read(kStream3, 4);
    return outcome;
  };
  constexpr std::uint32_t kComplete = 1u << 27, kError = 1u << 25;
  const Outcome whole = run_one_transfer(false), cut = run_one_transfer(true);
  EXPECT_EQ(whole.sent, 100);
  EXPECT_EQ(whole.left, 0u);
  EXPECT_EQ(whole.flags & (kComplete | kError), kComplete);
  EXPECT_NEAR(cut.sent, 4.0e-3 / 86.9e-6, 2.5);  // in 4 ms, and what had been fetched
  EXPECT_EQ(cut.left, 100u - static_cast<std::uint32_t>(cut.sent));
  EXPECT_EQ(cut.flags & (kComplete | kError), kError);
  EXPECT_EQ(cut.control & 1u, 0u);
}

TEST_F(ChipFaults, WhatCannotBeBrokenIsRefused) {
  ObservedImage run;
  mcu::BoardsChip chip(*run.firmware, run.elf);
  EXPECT_NE(chip.schedule({.kind = ChipFaultKind::kRamBit, .address = 0x08000000}).find("is no RAM"),
            std::string::npos);
  EXPECT_NE(chip.schedule({.kind = ChipFaultKind::kFlashBit, .address = 0x20000000}).find("is no flash"),
            std::string::npos);
  EXPECT_NE(chip.schedule({.kind = ChipFaultKind::kRegisterBit, .bit = 32}).find("bits 0 to 31"),
            std::string::npos);
  EXPECT_NE(chip.schedule({.kind = ChipFaultKind::kRegisterBit, .board = 1}).find("the robot has 1"),
            std::string::npos);
  EXPECT_THROW(run_with("[[step]]\nat_s = 0.1\ndo = \"flip_ram\"\naddress = 16\nbit = 0\n"),
               std::invalid_argument);
}

SuiteOptions suite_of(const std::string& image) {
  SuiteOptions suite;
  suite.firmware = {.file = kImages + image, .board = kBoardFile};
  suite.model_folders = {OMNIHIL_SOURCE_DIR "/models"};
  return suite;
}

Scenario drive_and_silence() {
  const ScenarioReading reading = read_scenario(
      "format = \"omnihil-scenario/1\"\ntitle = \"drive, then silence\"\nstand = true\nduration_s = 1.5\n"
      "[[step]]\nat_s = 0.05\ndo = \"command\"\nomega_wheel_rad_s = 20.0\n"
      "[[step]]\nat_s = 0.25\ndo = \"radio_silence\"\n"
      "[[check]]\nis = \"stops_safely\"\nat_most_s = 1.0\n",
      "drive.toml");
  for (const ModelProblem& problem : reading.problems) ADD_FAILURE() << problem.text();
  return *reading.scenario;
}

// An image that nothing resets when it hangs: the fuzz finds cases in which its wheels go on, makes each as small as it
// gets, and what it writes fails the same way when it is run by itself. The same image with its watchdog stops in all.
TEST_F(ChipFaults, SlowTheFuzzFindsAPlantedWeaknessAndShrinksIt) {
  const FuzzOptions options{.kinds = {ChipFaultKind::kFlashBit}, .cases = 120, .most = 3, .seed = 1};
  const SuiteOptions weak = suite_of("reference_no_watchdog.elf");
  const FuzzOutcome found = fuzz_scenario(drive_and_silence(), weak, options);
  ASSERT_FALSE(found.failures.empty());
  const SuiteOptions robust = suite_of("omni_reference_f405.elf");
  for (const FuzzFailure& f : found.failures) {
    EXPECT_EQ(f.faults.size(), 1u) << f.why;  // one bit is enough
    const ScenarioReading again = read_scenario(f.file_text, "again.toml");
    for (const ModelProblem& problem : again.problems) ADD_FAILURE() << problem.text();
    const ScenarioOutcome outcome = run_one(*again.scenario, weak);
    EXPECT_FALSE(outcome.passed()) << f.file_text;
  }
  const FuzzOutcome same = fuzz_scenario(drive_and_silence(), weak, options);
  ASSERT_EQ(same.failures.size(), found.failures.size());  // the same seed
  EXPECT_EQ(same.failures.front().faults, found.failures.front().faults);
}

// Registers, resets, clocks, storms, late watchdogs: the reference image stops in each case.
TEST_F(ChipFaults, SlowARobustImagePasses) {
  const FuzzOptions options{
      .kinds = {ChipFaultKind::kRegisterBit, ChipFaultKind::kBrownOutReset, ChipFaultKind::kClockOff,
                ChipFaultKind::kInterruptStorm, ChipFaultKind::kWatchdogLate},
      .cases = 60,
      .most = 3,
      .seed = 1};
  const FuzzOutcome outcome =
      fuzz_scenario(drive_and_silence(), suite_of("omni_reference_f405.elf"), options);
  for (const FuzzFailure& f : outcome.failures)
    ADD_FAILURE() << f.number << ": " << f.why << "\n" << f.file_text;
  EXPECT_EQ(outcome.runs, 61u);  // and one without a fault
}

TEST_F(ChipFaults, TheFuzzNeedsAChipAndASilence) {
  Scenario no_silence = drive_and_silence();
  std::erase_if(no_silence.steps, [](const ScenarioStep& s) { return s.kind == StepKind::kRadioSilence; });
  EXPECT_THROW(fuzz_scenario(no_silence, suite_of("omni_reference_f405.elf"), {.cases = 1}),
               std::invalid_argument);
  SuiteOptions reference;
  reference.model_folders = {OMNIHIL_SOURCE_DIR "/models"};
  EXPECT_THROW(fuzz_scenario(drive_and_silence(), reference, {.cases = 1}), std::invalid_argument);
}

}  // namespace
}  // namespace omnihil
