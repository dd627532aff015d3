// STM32H723, H725, H733, H735 (RM0468; DS13313), with the shared RAM on the AXI bus as delivered.
#include "firmware_iface/mcu/stm32/families/h7_parts.h"

namespace omnihil::mcu {
namespace {
constexpr H7Parts kParts{.flash_bytes = 1024 * 1024,
                         .flash_banks = 1,
                         .sram_bytes = 320 * 1024,
                         .d2_bytes = 32 * 1024,
                         .sram4_bytes = 16 * 1024,
                         .device_id = 0x10016483,
                         .newer = true};
}  // namespace

const ChipSpec& chip_stm32h723() {
  static const ChipSpec spec = h7_spec("stm32h723", {"stm32h725", "stm32h733", "stm32h735"}, kParts,
                                       [](Chip& chip) { build_h7(chip, kParts); });
  return spec;
}

}  // namespace omnihil::mcu
