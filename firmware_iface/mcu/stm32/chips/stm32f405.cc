// STM32F405, F407, F415, F417 (RM0090; DS8626).
#include "firmware_iface/mcu/stm32/chip_parts.h"

namespace omnihil::mcu {
namespace {
void build(Chip& chip) {
  add_common_f4(chip, "ABCDEFGHI", 1024 * 1024);
  add_stored(chip, 0x40028000, 0x2000, "ETH", {{0x1000, 0, 1}});
  add_stored(chip, 0x50060800, 0x400, "RNG", {{0x04, 1}});
  add_identity(chip, {0x1FFF7A10, 0x1FFF7A22, 0xE0042000, 0x10076413, 1024});
}
}  // namespace

const ChipSpec& chip_stm32f405() {
  static const ChipSpec spec{.name = "stm32f405",
                             .variants = {"stm32f407", "stm32f415", "stm32f417"},
                             .core = kCortexM4F,
                             .blocks = BlockFamily::kF4,
                             .memories = {{"flash", 0x08000000, 1024 * 1024, true},
                                          {"sram", 0x20000000, 128 * 1024},
                                          {"ccm", 0x10000000, 64 * 1024, false, true},
                                          {"backup", 0x40024000, 4096}},
                             .build = build};
  return spec;
}

}  // namespace omnihil::mcu
