// STM32G0B0, of the value line (RM0454).
#include "firmware_iface/mcu/stm32/families/g0_parts.h"

namespace omnihil::mcu {
namespace {
constexpr std::uint32_t kFlashBytes = 512 * 1024;
void build(Chip& chip) {
  build_g0(chip,
           {.size = G0Size::k0B, .flash_bytes = kFlashBytes, .device_id = 0x10000467, .value_line = true});
}
}  // namespace

const ChipSpec& chip_stm32g0b0() {
  static const ChipSpec spec{
      .name = "stm32g0b0",
      .variants = {},
      .core = kCortexM0Plus,
      .blocks = BlockFamily::kG0,
      .memories = {{"flash", 0x08000000, kFlashBytes, true}, {"sram", 0x20000000, 144 * 1024}},
      .build = build};
  return spec;
}

}  // namespace omnihil::mcu
