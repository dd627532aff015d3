// STM32G0B1, G0C1 (RM0444; DS13560).
#include "firmware_iface/mcu/stm32/families/g0_parts.h"

namespace omnihil::mcu {
namespace {
constexpr std::uint32_t kFlashBytes = 512 * 1024;
void build(Chip& chip) {
  build_g0(chip, {.size = G0Size::k0B, .flash_bytes = kFlashBytes, .device_id = 0x10000467});
}
}  // namespace

const ChipSpec& chip_stm32g0b1() {
  static const ChipSpec spec{
      .name = "stm32g0b1",
      .variants = {"stm32g0c1"},
      .core = kCortexM0Plus,
      .blocks = BlockFamily::kG0,
      .memories = {{"flash", 0x08000000, kFlashBytes, true}, {"sram", 0x20000000, 144 * 1024}},
      .build = build};
  return spec;
}

}  // namespace omnihil::mcu
