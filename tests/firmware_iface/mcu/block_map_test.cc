#include "firmware_iface/mcu/stm32/block_map.h"

#include <gtest/gtest.h>

#include "tests/firmware_iface/mcu/chip_bench.h"

namespace omnihil::mcu {
namespace {

TEST(BlockMap, NamesWhatIsNotModelled) {
  struct Row {
    const char* chip;
    std::uint32_t address;
    const char* name;
  };
  for (const Row& row : {Row{"stm32f767", 0x40012C34, "SDMMC1"}, Row{"stm32f767", 0x40016800, "LTDC"},
                         Row{"stm32f767", 0xA0001004, "QUADSPI"}, Row{"stm32f407", 0x40012C34, "SDIO"},
                         Row{"stm32f446", 0x40004000, "SPDIFRX"}, Row{"stm32f303", 0x40015000, "TIM20"},
                         Row{"stm32f031", 0x40007800, "CEC"}, Row{"stm32g474", 0x4000A000, "UCPD1"}}) {
    const BlockPlace* place = block_at(find_chip(row.chip)->blocks, row.address);
    ASSERT_NE(place, nullptr) << row.chip;
    EXPECT_EQ(place->name, row.name) << row.chip;
  }
  EXPECT_EQ(block_at(BlockFamily::kF7, 0x40008000), nullptr) << "reserved";
}

// Every block that a chip has modelled stands in its family's map under the same name.
TEST(BlockMap, AgreesWithTheChipsOwnBlocks) {
  int compared = 0;
  for (const ChipSpec* spec : all_chips()) {
    ChipBench bench(spec->name);
    for (const Chip::Mapped& block : bench.chip.blocks()) {
      const std::string& name = block.peripheral->name();
      const BlockPlace* place = block_at(spec->blocks, block.base);
      // Other parts of a chip than peripherals, and pieces of a block with names of their own.
      const bool apart = name == "system memory" || name == "DBGMCU" || name.starts_with("ADC") ||
                         name.starts_with("COMP") || name.starts_with("GPIO") || place == nullptr;
      if (apart) continue;
      EXPECT_EQ(place->name, name) << spec->name;
      ++compared;
    }
  }
  EXPECT_GT(compared, 150);
}

}  // namespace
}  // namespace omnihil::mcu
