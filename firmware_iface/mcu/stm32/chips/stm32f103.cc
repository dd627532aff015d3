// STM32F103x8, xB: medium density (RM0008; DS5319).
#include "firmware_iface/mcu/stm32/families/f1_parts.h"

namespace omnihil::mcu {
namespace {
void build(Chip& chip) {
  build_f1(chip, {.flash_bytes = 128 * 1024, .page_bytes = 1024, .device_id = 0x20036410});
}
}  // namespace

const ChipSpec& chip_stm32f103() {
  static const ChipSpec spec{
      .name = "stm32f103",
      .variants = {"stm32f103c8", "stm32f103cb", "stm32f103r8", "stm32f103rb", "stm32f103v8", "stm32f103vb"},
      .core = kCortexM3,
      .blocks = BlockFamily::kF1,
      .reset_hz = 8e6,
      .memories = {{"flash", 0x08000000, 128 * 1024, true}, {"sram", 0x20000000, 20 * 1024}},
      .build = build};
  return spec;
}

}  // namespace omnihil::mcu
