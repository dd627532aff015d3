// A source that the chip does not change is asked at the end of its conversion: with the same results as one that is asked
// at the end of its sampling.
#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "tests/firmware_iface/mcu/chip_bench.h"

namespace omnihil::mcu {
namespace {

struct Outcome {
  std::vector<std::pair<Cycles, std::uint32_t>> results;  // when they were there, and what
  int events = 0;
  bool operator==(const Outcome& other) const { return results == other.results; }
};

// Two inputs in turn, 13.5 clocks of sampling and 12.5 of converting, in a circle; `meddle` is called at its instant.
template <typename Meddle>
Outcome outcome(bool steady, Cycles step_after, Cycles meddle_at, Meddle meddle) {
  ChipBench b("stm32f031");
  Adc& adc = *b.chip.find<Adc>("ADC1");
  double volts = 1.0;
  for (const unsigned input : {0u, 1u}) {
    adc.set_source(
        input, [&volts, input](std::int64_t) { return volts + 0.5 * input; }, steady);
  }
  b.set("ADC1", 0x10, 1u << 30);  // half of the bus clock
  b.set("ADC1", 0x14, 2);
  b.set("ADC1", 0x28, 3);
  b.set("ADC1", 0x0C, 1u << 13 | 1u << 12);  // continuous, the latest result counts
  b.switch_adc_on("ADC1");
  b.start_adc("ADC1");
  Outcome seen;
  for (Cycles at = 1; at < 600; ++at) {
    b.system.run_until(at);
    if (at == step_after) {
      adc.take_samples();
      volts = 2.0;
    }
    if (at == meddle_at) meddle(b);
    if ((b.get("ADC1", 0x00) & 4u) != 0) seen.results.emplace_back(at, b.get("ADC1", 0x40));
  }
  seen.events = b.system.events;
  return seen;
}

TEST(SteadySource, GivesTheCodeOfTheInstantAtWhichSamplingEnds) {
  for (Cycles step_after = 1; step_after < 200; ++step_after) {
    const auto nothing = [](ChipBench&) {};
    const Outcome late = outcome(true, step_after, 1, nothing),
                  at_once = outcome(false, step_after, 1, nothing);
    EXPECT_EQ(late, at_once) << step_after;
    ASSERT_GT(at_once.results.size(), 5u);
    EXPECT_LT(late.events, at_once.events * 2 / 3) << "one event a conversion";
  }
}

TEST(SteadySource, RegistersThatChangeMeanwhileCountAsTheyDidThen) {
  const std::pair<std::uint32_t, std::uint32_t> writes[] = {
      {0x14, 5}, {0x0C, 1u << 13 | 1u << 12 | 2u << 3}, {0x28, 2}, {0x10, 2u << 30}, {0x08, 0x10}};
  for (const auto& [offset, word] : writes) {
    for (Cycles at = 300; at < 360; ++at) {
      const auto meddle = [o = offset, w = word](ChipBench& b) { b.set("ADC1", o, w); };
      EXPECT_EQ(outcome(true, 1, at, meddle), outcome(false, 1, at, meddle)) << offset << " " << at;
    }
  }
}

TEST(SteadySource, AClockThatChangesMeanwhileCountsAsItDidThen) {
  for (Cycles at = 300; at < 360; ++at) {
    const auto faster = [](ChipBench& b) { b.system.set_core_hz(48e6); };
    EXPECT_EQ(outcome(true, 1, at, faster), outcome(false, 1, at, faster)) << at;
  }
}

}  // namespace
}  // namespace omnihil::mcu
