// STM32G031, G041 (RM0444; DS12992).
#include "firmware_iface/mcu/stm32/families/g0_parts.h"

namespace omnihil::mcu {
namespace {
constexpr std::uint32_t kFlashBytes = 64 * 1024;
void build(Chip& chip) {
  build_g0(chip, {.size = G0Size::k03, .flash_bytes = kFlashBytes, .device_id = 0x10000466});
}
}  // namespace

const ChipSpec& chip_stm32g031() {
  static const ChipSpec spec{
      .name = "stm32g031",
      .variants = {"stm32g041"},
      .core = kCortexM0Plus,
      .blocks = BlockFamily::kG0,
      .memories = {{"flash", 0x08000000, kFlashBytes, true}, {"sram", 0x20000000, 8 * 1024}},
      .build = build};
  return spec;
}

}  // namespace omnihil::mcu
