// STM32G431, G441 (RM0440; DS12589).
#include "firmware_iface/mcu/stm32/families/g4_parts.h"

namespace omnihil::mcu {
namespace {
void build(Chip& chip) { build_g4(chip, {.flash_bytes = 128 * 1024, .device_id = 0x20006468}); }
}  // namespace

const ChipSpec& chip_stm32g431() {
  static const ChipSpec spec{.name = "stm32g431",
                             .variants = {"stm32g441"},
                             .core = kCortexM4F,
                             .blocks = BlockFamily::kG4,
                             .memories = {{"flash", 0x08000000, 128 * 1024, true},
                                          {"sram", 0x20000000, 22 * 1024},
                                          {"ccm", 0x20005800, 10 * 1024}},
                             .aliases = {{"ccm", 0x10000000}},
                             .build = build};
  return spec;
}

}  // namespace omnihil::mcu
