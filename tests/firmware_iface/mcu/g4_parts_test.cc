// The G4's two categories: what the small one lacks, and where its DMA channels hang on the request multiplexer.
#include <gtest/gtest.h>

#include <string>

#include "tests/firmware_iface/mcu/chip_bench.h"

namespace omnihil::mcu {
namespace {

TEST(G4Parts, TheSmallOneLacksWhatTheLargeOneHasMore) {
  const ChipBench small("stm32g441"), large("stm32g474");
  for (const char* block :
       {"TIM5", "TIM20", "ADC3", "ADC345", "UART5", "SPI4", "I2C4", "FDCAN2", "FDCAN3", "HRTIM"}) {
    EXPECT_EQ(small.base(block), 0u) << block;
    EXPECT_NE(large.base(block), 0u) << block;
  }
  for (const Chip::Mapped& block : small.chip.blocks()) {
    EXPECT_EQ(large.base(block.peripheral->name()), block.base) << block.peripheral->name();
  }
}

// Channel 1 of DMA2 is channel 6 of the multiplexer in category 2, channel 8 in category 3 (RM0440 §13.3.2).
TEST(G4Parts, TheSecondControllerFollowsTheFirstOnesChannels) {
  for (const auto& [chip, channel] : {std::pair{"stm32g431", 6u}, {"stm32g474", 8u}}) {
    ChipBench b(chip);
    b.chip.find<Adc>("ADC1")->set_source(1, [](std::int64_t) { return 1.65; });
    b.switch_adc_on("ADC1");
    b.set("ADC1", 0x30, 1u << 6);
    b.set("ADC1", 0x0C, 1);
    b.set("DMAMUX", 4 * channel, 5);  // ADC1
    b.set("DMA2", 0x0C, 1);
    b.set("DMA2", 0x10, b.base("ADC1") + 0x40);
    b.set("DMA2", 0x14, 0x20000000);
    b.set("DMA2", 0x08, 1u << 10 | 1u << 8 | 1);
    b.start_adc("ADC1");
    b.system.run_for(300);
    EXPECT_EQ(b.system.bus_read(0x20000000, 2), 2048u) << chip;
  }
}

TEST(G4Parts, SaysWhichItIsAndHowMuchFlashItHas) {
  ChipBench small("stm32g431"), large("stm32g474");
  EXPECT_EQ(small.get("DBGMCU", 0) & 0xFFF, 0x468u);
  EXPECT_EQ(large.get("DBGMCU", 0) & 0xFFF, 0x469u);
  EXPECT_EQ(small.system.bus_read(0x1FFF75E0, 2), 128u);
  EXPECT_EQ(large.system.bus_read(0x1FFF75E0, 2), 512u);
}

}  // namespace
}  // namespace omnihil::mcu
