// STM32F103xC, xD, xE: high density (RM0008; DS5792).
#include "firmware_iface/mcu/stm32/families/f1_parts.h"

namespace omnihil::mcu {
namespace {
void build(Chip& chip) {
  build_f1(chip,
           {.flash_bytes = 512 * 1024, .page_bytes = 2048, .device_id = 0x10036414, .high_density = true});
}
}  // namespace

const ChipSpec& chip_stm32f103_high() {
  static const ChipSpec spec{
      .name = "stm32f103ze",
      .variants = {"stm32f103rc", "stm32f103rd", "stm32f103re", "stm32f103vc", "stm32f103vd", "stm32f103ve",
                   "stm32f103zc", "stm32f103zd"},
      .core = kCortexM3,
      .blocks = BlockFamily::kF1,
      .reset_hz = 8e6,
      .memories = {{"flash", 0x08000000, 512 * 1024, true}, {"sram", 0x20000000, 64 * 1024}},
      .build = build};
  return spec;
}

}  // namespace omnihil::mcu
