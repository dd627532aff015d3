// STM32F767, F765, F769, F777, F779 (RM0410; DS11532).
#include <memory>

#include "firmware_iface/mcu/stm32/bxcan.h"
#include "firmware_iface/mcu/stm32/chip_parts.h"

namespace omnihil::mcu {
namespace {
void build(Chip& chip) {
  ChipContext& context = chip.context();
  chip.add(0x40023800, 0x400, make_rcc(RccFamily::kF7, context));
  chip.add(0x40007000, 0x400, make_pwr(PwrFamily::kF7, context));
  chip.add(0x40023C00, 0x400, std::make_unique<Flash>(FlashFamily::kF7, 2048 * 1024, 32768, 4, context));
  add_ports(chip, "ABCDEFGHIJK", 0x40020000);
  add_exti(chip, 0x40013C00, 0x40013800, usual_exti_vectors(), SyscfgFamily::kF7);
  add_dma_f4(chip);
  add_timers_f4(chip, true);
  add_adcs_f4(chip, adc_triggers_f7());
  const Bus one = Bus::kApb1, two = Bus::kApb2;
  const auto usart = [&chip](std::uint32_t base, int number, const char* name, Bus bus, int irq) {
    add_usart(chip, base, {.number = number, .name = name, .v2 = true, .bus = bus, .irq = irq});
  };
  usart(0x40011000, 1, "USART1", two, 37);
  usart(0x40004400, 2, "USART2", one, 38);
  usart(0x40004800, 3, "USART3", one, 39);
  usart(0x40004C00, 4, "UART4", one, 52);
  usart(0x40005000, 5, "UART5", one, 53);
  usart(0x40011400, 6, "USART6", two, 71);
  usart(0x40007800, 7, "UART7", one, 82);
  usart(0x40007C00, 8, "UART8", one, 83);
  add_spi(chip, 0x40013000, {.name = "SPI1", .v2 = true, .bus = two, .irq = 35});
  add_spi(chip, 0x40003800, {.name = "SPI2", .v2 = true, .bus = one, .irq = 36});
  add_spi(chip, 0x40003C00, {.name = "SPI3", .v2 = true, .bus = one, .irq = 51});
  add_spi(chip, 0x40013400, {.name = "SPI4", .v2 = true, .bus = two, .irq = 84});
  add_spi(chip, 0x40015000, {.name = "SPI5", .v2 = true, .bus = two, .irq = 85});
  add_spi(chip, 0x40015400, {.name = "SPI6", .v2 = true, .bus = two, .irq = 86});
  add_i2c(chip, 0x40005400, {.name = "I2C1", .v2 = true, .irq_event = 31, .irq_error = 32});
  add_i2c(chip, 0x40005800, {.name = "I2C2", .v2 = true, .irq_event = 33, .irq_error = 34});
  add_i2c(chip, 0x40005C00, {.name = "I2C3", .v2 = true, .irq_event = 72, .irq_error = 73});
  add_i2c(chip, 0x40006000, {.name = "I2C4", .v2 = true, .irq_event = 95, .irq_error = 96});
  BxCan& can1 = chip.add(0x40006400, 0x400,
                         std::make_unique<BxCan>("CAN1", std::array{19, 20, 21, 22}, 28u, nullptr, context));
  chip.add(0x40006800, 0x400,
           std::make_unique<BxCan>("CAN2", std::array{63, 64, 65, 66}, 0u, &can1, context));
  chip.add(0x40003400, 0x400,
           std::make_unique<BxCan>("CAN3", std::array{104, 105, 106, 107}, 14u, nullptr, context));
  add_sdmmc(chip, 0x40012C00, {.name = "SDMMC1", .irq = 49});
  add_watchdogs(chip, 7, 2);
  add_stored(chip, 0x40002800, 0x400, "RTC", {{0x0C, 0x7F}});
  add_stored(chip, 0x40007400, 0x400, "DAC");
  chip.add(0x40023000, 0x400, std::make_unique<Crc>(CrcFamily::kV2, chip.context().system));
  add_stored(chip, 0x40028000, 0x2000, "ETH", {{0x1000, 0, 1}});
  add_stored(chip, 0x50060800, 0x400, "RNG", {{0x04, 1}});
  add_stored(chip, 0x50000000, 0x20000, "OTG_FS", {{0x10, 0x80000000, 0x31}});
  add_stored(chip, 0x40040000, 0x20000, "OTG_HS", {{0x10, 0x80000000, 0x31}});
  add_identity(chip, {0x1FF0F420, 0x1FF0F442, 0xE0042000, 0x10016451, 2048});
}
}  // namespace

const ChipSpec& chip_stm32f767() {
  static const ChipSpec spec{.name = "stm32f767",
                             .variants = {"stm32f765", "stm32f769", "stm32f777", "stm32f779"},
                             .core = kCortexM7,
                             .blocks = BlockFamily::kF7,
                             .boot_address = 0x00200000,
                             .memories = {{"flash", 0x08000000, 2048 * 1024, true},
                                          {"itcm", 0x00000000, 16 * 1024},
                                          {"sram", 0x20000000, 512 * 1024},
                                          {"backup", 0x40024000, 4096}},
                             .aliases = {{"flash", 0x00200000}},
                             .build = build};
  return spec;
}

}  // namespace omnihil::mcu
