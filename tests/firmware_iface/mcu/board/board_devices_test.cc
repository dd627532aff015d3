// What board files say of gate drivers, brakes, phases and numbers set by switches; alarms of devices.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "firmware_iface/mcu/board/board_spec.h"
#include "firmware_iface/mcu/board/device_alarm.h"
#include "firmware_iface/mcu/stm32/device.h"
#include "tests/firmware_iface/mcu/fake_system.h"

namespace omnihil::mcu {
namespace {

std::optional<BoardSpec> read(const std::string& rest, std::vector<BoardProblem>& problems) {
  const std::string head = R"(format = "omnihil-board/1"
name = "test"
chip = "stm32f405"
[[motor]]
wheel = 0
pwm = ["TIM1.1", "TIM1.2", "TIM1.3"]
)";
  return read_board(head + rest, "test.toml", problems);
}

std::string all(const std::vector<BoardProblem>& problems) {
  std::string text;
  for (const BoardProblem& problem : problems) text += problem.text() + "\n";
  return text;
}

TEST(BoardDevices, ReadsBrakesDriversPhasesAndSwitches) {
  std::vector<BoardProblem> problems;
  const auto spec = read(R"(brake = "PB1"
[[device]]
kind = "drv8323"
name = "driver"
bus = "SPI1"
select = "PA4"
pins = { enable = "PA11", fault = "PB2" }
breaks = "TIM1"
[[analog]]
adc = "ADC1"
channel = 3
signal = "phase_current"
phase = 2
volts_per_unit = 0.04
[[pin]]
pin = "PC1"
robot_id_bit = 2
inverted = true
)",
                         problems);
  ASSERT_TRUE(spec) << all(problems);
  EXPECT_EQ(spec->motors[0].brake->pin, 1u);
  EXPECT_EQ(spec->devices[0].breaks, "TIM1");
  EXPECT_EQ(spec->analog[0].signal, AnalogSignal::kPhaseCurrent);
  EXPECT_EQ(spec->analog[0].phase, 2);
  EXPECT_TRUE(spec->pins[0].inverted);
  EXPECT_FALSE(spec->pins[0].break_beam);
}

TEST(BoardDevices, RefusesWhatDoesNotFit) {
  const std::pair<const char*, const char*> rows[] = {
      {"brake = \"PZ1\"\n", "no pin \"PZ1\""},
      {"[[device]]\nkind = \"ma7xx\"\nname = \"a\"\nbus = \"SPI1\"\nselect = \"PA4\"\nbreaks = \"TIM1\"\n",
       "the device has no fault pin"},
      {"[[device]]\nkind = \"drv8301\"\nname = \"a\"\nbus = \"SPI1\"\nselect = \"PA4\"\nbreaks = \"TIM2\"\n",
       "no timer with a break input"},
      {"[[analog]]\nadc = \"ADC1\"\nchannel = 1\nsignal = \"phase\"\n", "unknown"},
      {"[[analog]]\nadc = \"ADC1\"\nchannel = 1\nsignal = \"phase_current\"\nphase = 3\n", "phase"},
      {"[[pin]]\npin = \"PC1\"\nlevel = true\ninverted = true\n", "without a robot_id_bit"}};
  for (const auto& [rest, problem] : rows) {
    std::vector<BoardProblem> problems;
    EXPECT_FALSE(read(rest, problems)) << rest;
    EXPECT_NE(all(problems).find(problem), std::string::npos) << all(problems);
  }
}

TEST(DeviceAlarm, RingsOnceAtItsInstantWhateverTheClockDoes) {
  FakeSystem system;
  std::vector<std::int64_t> rung;
  DeviceAlarm alarm("radio", system, [&] { rung.push_back(system.to_ns(system.now())); });
  system.attach(0x5FFE0000, 4, alarm);
  alarm.set(40'000);
  alarm.set(50'000);  // the last one counts
  system.run_for_ns(20'000);
  system.set_core_hz(100e6);
  alarm.clock_changed();
  system.run_for_ns(29'980);  // two cycles before
  EXPECT_TRUE(rung.empty());
  system.run_for_ns(1'000'000);
  ASSERT_EQ(rung.size(), 1u);
  EXPECT_NEAR(static_cast<double>(rung[0]), 50'000.0, 10.0) << "at the first cycle not before it";
  alarm.set(2'000'000);
  alarm.set(kNoWake);
  system.run_for_ns(5'000'000);
  EXPECT_EQ(rung.size(), 1u);
}

TEST(DeviceAlarm, AnInstantThatIsOverRingsAtTheNextCycle) {
  FakeSystem system;
  int rung = 0;
  DeviceAlarm alarm("radio", system, [&] { ++rung; });
  system.attach(0x5FFE0000, 4, alarm);
  system.run_for(1000);
  alarm.set(1);
  EXPECT_EQ(rung, 0) << "never within an access";
  system.run_for(1);
  EXPECT_EQ(rung, 1);
}

}  // namespace
}  // namespace omnihil::mcu
