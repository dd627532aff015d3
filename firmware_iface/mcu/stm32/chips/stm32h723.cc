// STM32H723, H725, H733, H735 (RM0468; DS13313), with the shared RAM on the AXI bus as delivered.
#include "firmware_iface/mcu/stm32/families/h7_parts.h"

namespace omnihil::mcu {
namespace {
void build(Chip& chip) {
  build_h7(chip, {.flash_bytes = 1024 * 1024, .flash_banks = 1, .device_id = 0x10016483, .newer = true});
}
}  // namespace

const ChipSpec& chip_stm32h723() {
  static const ChipSpec spec{.name = "stm32h723",
                             .variants = {"stm32h725", "stm32h733", "stm32h735"},
                             .core = kCortexM7,
                             .blocks = BlockFamily::kH7,
                             .reset_hz = 64e6,
                             .memories = {{"flash", 0x08000000, 1024 * 1024, true},
                                          {"itcm", 0x00000000, 64 * 1024, false, true},
                                          {"dtcm", 0x20000000, 128 * 1024, false, true},
                                          {"sram", 0x24000000, 320 * 1024},
                                          {"sram of D2", 0x30000000, 32 * 1024},
                                          {"sram4", 0x38000000, 16 * 1024},
                                          {"backup", 0x38800000, 4096}},
                             .aliases = {{"sram of D2", 0x10000000}},
                             .build = build};
  return spec;
}

}  // namespace omnihil::mcu
