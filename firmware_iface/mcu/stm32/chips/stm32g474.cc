// STM32G474, G473, G483, G484 (RM0440; DS12288).
#include "firmware_iface/mcu/stm32/families/g4_parts.h"

namespace omnihil::mcu {
namespace {
void build(Chip& chip) {
  build_g4(chip, {.flash_bytes = 512 * 1024, .device_id = 0x20006469, .large = true, .dma_channels = 8});
}
}  // namespace

const ChipSpec& chip_stm32g474() {
  static const ChipSpec spec{.name = "stm32g474",
                             .variants = {"stm32g473", "stm32g483", "stm32g484"},
                             .core = kCortexM4F,
                             .blocks = BlockFamily::kG4,
                             .memories = {{"flash", 0x08000000, 512 * 1024, true},
                                          {"sram", 0x20000000, 96 * 1024},
                                          {"ccm", 0x20018000, 32 * 1024}},
                             .aliases = {{"ccm", 0x10000000}},
                             .build = build};
  return spec;
}

}  // namespace omnihil::mcu
