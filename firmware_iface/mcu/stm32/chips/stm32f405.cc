// STM32F405, F407, F415, F417 (RM0090; DS8626).
#include <memory>

#include "firmware_iface/mcu/stm32/bxcan.h"
#include "firmware_iface/mcu/stm32/chip_parts.h"

namespace omnihil::mcu {
namespace {
void build(Chip& chip) {
  ChipContext& context = chip.context();
  chip.add(0x40023800, 0x400, make_rcc(RccFamily::kF4, context));
  chip.add(0x40007000, 0x400, make_pwr(PwrFamily::kF4, context));
  chip.add(0x40023C00, 0x400, std::make_unique<Flash>(FlashFamily::kF4, 1024 * 1024, 16384, 4, context));
  add_ports(chip, "ABCDEFGHI", 0x40020000);
  add_exti(chip, 0x40013C00, 0x40013800, usual_exti_vectors());
  add_dma_f4(chip);
  add_timers_f4(chip, true);
  add_adcs_f4(chip, adc_triggers_f4());
  const Bus one = Bus::kApb1, two = Bus::kApb2;
  add_usart(chip, 0x40011000, {.number = 1, .name = "USART1", .bus = two, .irq = 37});
  add_usart(chip, 0x40004400, {.number = 2, .name = "USART2", .bus = one, .irq = 38});
  add_usart(chip, 0x40004800, {.number = 3, .name = "USART3", .bus = one, .irq = 39});
  add_usart(chip, 0x40004C00, {.number = 4, .name = "UART4", .bus = one, .irq = 52});
  add_usart(chip, 0x40005000, {.number = 5, .name = "UART5", .bus = one, .irq = 53});
  add_usart(chip, 0x40011400, {.number = 6, .name = "USART6", .bus = two, .irq = 71});
  add_spi(chip, 0x40013000, {.name = "SPI1", .bus = two, .irq = 35});
  add_spi(chip, 0x40003800, {.name = "SPI2", .bus = one, .irq = 36});
  add_spi(chip, 0x40003C00, {.name = "SPI3", .bus = one, .irq = 51});
  add_i2c(chip, 0x40005400, {.name = "I2C1", .irq_event = 31, .irq_error = 32});
  add_i2c(chip, 0x40005800, {.name = "I2C2", .irq_event = 33, .irq_error = 34});
  add_i2c(chip, 0x40005C00, {.name = "I2C3", .irq_event = 72, .irq_error = 73});
  BxCan& can1 = chip.add(0x40006400, 0x400,
                         std::make_unique<BxCan>("CAN1", std::array{19, 20, 21, 22}, 28u, nullptr, context));
  chip.add(0x40006800, 0x400,
           std::make_unique<BxCan>("CAN2", std::array{63, 64, 65, 66}, 0u, &can1, context));
  add_watchdogs(chip, 7, 2);
  add_stored(chip, 0x40002800, 0x400, "RTC", {{0x0C, 0x7F}});
  add_stored(chip, 0x40007400, 0x400, "DAC");
  add_stored(chip, 0x40012C00, 0x400, "SDIO");
  add_stored(chip, 0x40023000, 0x400, "CRC");
  add_stored(chip, 0x40028000, 0x2000, "ETH", {{0x1000, 0, 1}});
  add_stored(chip, 0x50060800, 0x400, "RNG", {{0x04, 1}});
  // GRSTCTL: AHB idle, core reset and FIFO flushes done
  add_stored(chip, 0x50000000, 0x20000, "OTG_FS", {{0x10, 0x80000000, 0x31}});
  add_stored(chip, 0x40040000, 0x20000, "OTG_HS", {{0x10, 0x80000000, 0x31}});
  add_identity(chip, {0x1FFF7A10, 0x1FFF7A22, 0xE0042000, 0x10076413, 1024});
}
}  // namespace

const ChipSpec& chip_stm32f405() {
  static const ChipSpec spec{.name = "stm32f405",
                             .variants = {"stm32f407", "stm32f415", "stm32f417"},
                             .core = kCortexM4F,
                             .memories = {{"flash", 0x08000000, 1024 * 1024, true},
                                          {"sram", 0x20000000, 128 * 1024},
                                          {"ccm", 0x10000000, 64 * 1024},
                                          {"backup", 0x40024000, 4096}},
                             .build = build};
  return spec;
}

}  // namespace omnihil::mcu
