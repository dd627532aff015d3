// STM32H742, H743, H753 (RM0433; DS12110).
#include "firmware_iface/mcu/stm32/families/h7_parts.h"

namespace omnihil::mcu {
namespace {
constexpr H7Parts kParts{.flash_bytes = 2048 * 1024,
                         .flash_banks = 2,
                         .sram_bytes = 512 * 1024,
                         .d2_bytes = 288 * 1024,
                         .sram4_bytes = 64 * 1024,
                         .device_id = 0x20036450};
}  // namespace

const ChipSpec& chip_stm32h743() {
  static const ChipSpec spec =
      h7_spec("stm32h743", {"stm32h742", "stm32h753"}, kParts, [](Chip& chip) { build_h7(chip, kParts); });
  return spec;
}

}  // namespace omnihil::mcu
