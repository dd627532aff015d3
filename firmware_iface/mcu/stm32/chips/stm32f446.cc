// STM32F446 (RM0390; DS10693).
#include "firmware_iface/mcu/stm32/chip_parts.h"

namespace omnihil::mcu {
namespace {
void build(Chip& chip) {
  add_common_f4(chip, "ABCDEFGH", 512 * 1024);
  add_spi(chip, 0x40013400, {.name = "SPI4", .bus = Bus::kApb2, .irq = 84});
  add_stored(chip, 0x40006000, 0x400, "FMPI2C1");
  add_stored(chip, 0xA0001000, 0x400, "QUADSPI", {{0x08, 0x2}});
  add_identity(chip, {0x1FFF7A10, 0x1FFF7A22, 0xE0042000, 0x10006421, 512});
}
}  // namespace

const ChipSpec& chip_stm32f446() {
  static const ChipSpec spec{.name = "stm32f446",
                             .variants = {},
                             .core = kCortexM4F,
                             .blocks = BlockFamily::kF446,
                             .memories = {{"flash", 0x08000000, 512 * 1024, true},
                                          {"sram", 0x20000000, 128 * 1024},
                                          {"backup", 0x40024000, 4096}},
                             .build = build};
  return spec;
}

}  // namespace omnihil::mcu
