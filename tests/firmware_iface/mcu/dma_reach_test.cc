// Memories that a chip's DMA controllers do not reach (RM0090 2.3.1, RM0316 3.3: CCM; RM0433 2.4: ITCM and DTCM).
#include <gtest/gtest.h>

#include "tests/firmware_iface/mcu/chip_bench.h"

namespace omnihil::mcu {
namespace {

struct Reach {
  const char* chip;
  std::uint32_t memory;
  bool reached;
};
class DmaReach : public testing::TestWithParam<Reach> {};

// Stream 0 of DMA2 copies four bytes from memory to memory, its error interrupt on.
TEST_P(DmaReach, ATransferFailsWhereOnlyTheCoreReaches) {
  ChipBench b(GetParam().chip);
  const std::uint32_t from = b.chip.spec().memories[0].base;
  for (unsigned i = 0; i < 4; ++i) b.system.memory[from + i] = static_cast<std::uint8_t>(0x10 + i);
  b.set("DMA2", 0x14, 4);
  b.set("DMA2", 0x18, from);
  b.set("DMA2", 0x1C, GetParam().memory);
  b.set("DMA2", 0x10, 2u << 6 | 1u << 9 | 1u << 10 | 1u << 2 | 1);
  const std::uint32_t error = 1u << 3, complete = 1u << 5;
  EXPECT_EQ(b.get("DMA2", 0x00) & (error | complete), GetParam().reached ? complete : error);
  EXPECT_EQ(b.system.irq_high[56], !GetParam().reached);
  EXPECT_EQ(b.system.memory[GetParam().memory + 3], GetParam().reached ? 0x13 : 0);
  EXPECT_EQ(b.system.unmodelled.size(), GetParam().reached ? 0u : 1u);
}

INSTANTIATE_TEST_SUITE_P(
    Memories, DmaReach,
    testing::Values(Reach{"stm32f405", 0x20000100, true}, Reach{"stm32f405", 0x10000100, false},
                    Reach{"stm32f767", 0x20000100, true}, Reach{"stm32h743", 0x24000100, true},
                    Reach{"stm32h743", 0x20000100, false}, Reach{"stm32h723", 0x00000100, false}));

TEST(DmaReachOfChannels, F3sCcmIsTheCoresAlone) {
  ChipBench b("stm32f303");
  b.set("DMA1", 0x0C, 1);
  b.set("DMA1", 0x10, 0x20000000);
  b.set("DMA1", 0x14, 0x10000000);
  b.set("DMA1", 0x08, 1u << 14 | 1);
  EXPECT_EQ(b.get("DMA1", 0x00) & 0xF, 1u | 8u) << "an error, nothing complete";
  EXPECT_EQ(b.get("DMA1", 0x08) & 1u, 0u);
}

}  // namespace
}  // namespace omnihil::mcu
