// STM32H742, H743, H753 (RM0433; DS12110).
#include "firmware_iface/mcu/stm32/families/h7_parts.h"

namespace omnihil::mcu {
namespace {
void build(Chip& chip) {
  build_h7(chip, {.flash_bytes = 2048 * 1024, .flash_banks = 2, .device_id = 0x20036450, .newer = false});
}
}  // namespace

const ChipSpec& chip_stm32h743() {
  static const ChipSpec spec{.name = "stm32h743",
                             .variants = {"stm32h742", "stm32h753"},
                             .core = kCortexM7,
                             .blocks = BlockFamily::kH7,
                             .reset_hz = 64e6,
                             .memories = {{"flash", 0x08000000, 2048 * 1024, true},
                                          {"itcm", 0x00000000, 64 * 1024, false, true},
                                          {"dtcm", 0x20000000, 128 * 1024, false, true},
                                          {"sram", 0x24000000, 512 * 1024},
                                          {"sram of D2", 0x30000000, 288 * 1024},
                                          {"sram4", 0x38000000, 64 * 1024},
                                          {"backup", 0x38800000, 4096}},
                             .aliases = {{"sram of D2", 0x10000000}},
                             .build = build};
  return spec;
}

}  // namespace omnihil::mcu
