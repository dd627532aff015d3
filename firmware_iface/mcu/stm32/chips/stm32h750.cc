// STM32H750 (RM0433; DS12556): one sector of flash.
#include "firmware_iface/mcu/stm32/families/h7_parts.h"

namespace omnihil::mcu {
namespace {
constexpr H7Parts kParts{.flash_bytes = 128 * 1024,
                         .flash_banks = 1,
                         .sram_bytes = 512 * 1024,
                         .d2_bytes = 288 * 1024,
                         .sram4_bytes = 64 * 1024,
                         .device_id = 0x20036450};
}  // namespace

const ChipSpec& chip_stm32h750() {
  static const ChipSpec spec =
      h7_spec("stm32h750", {"stm32h750vb"}, kParts, [](Chip& chip) { build_h7(chip, kParts); });
  return spec;
}

}  // namespace omnihil::mcu
