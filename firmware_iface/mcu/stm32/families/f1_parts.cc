#include "firmware_iface/mcu/stm32/families/f1_parts.h"

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "firmware_iface/mcu/stm32/adc/adc_f1.h"
#include "firmware_iface/mcu/stm32/bxcan.h"
#include "firmware_iface/mcu/stm32/chip_parts.h"
#include "firmware_iface/mcu/stm32/families/timer_rows.h"

namespace omnihil::mcu {
namespace {
void add_dmas(Chip& chip, const F1Parts& parts) {
  // RM0008 tables 78, 79
  constexpr DmaRow kFirst[] = {{"ADC1", 1},      {"TIM2_CH3", 1},  {"TIM4_CH1", 1},  {"USART3_TX", 2},
                               {"TIM1_CH1", 2},  {"TIM2_UP", 2},   {"TIM3_CH3", 2},  {"SPI1_RX", 2},
                               {"USART3_RX", 3}, {"TIM1_CH2", 3},  {"TIM3_CH4", 3},  {"TIM3_UP", 3},
                               {"SPI1_TX", 3},   {"USART1_TX", 4}, {"TIM1_CH4", 4},  {"TIM1_TRIG", 4},
                               {"TIM1_COM", 4},  {"TIM4_CH2", 4},  {"SPI2_RX", 4},   {"I2C2_TX", 4},
                               {"USART1_RX", 5}, {"TIM1_UP", 5},   {"SPI2_TX", 5},   {"TIM2_CH1", 5},
                               {"TIM4_CH3", 5},  {"I2C2_RX", 5},   {"TIM1_CH3", 6},  {"USART2_RX", 6},
                               {"TIM3_CH1", 6},  {"TIM3_TRIG", 6}, {"I2C1_TX", 6},   {"TIM2_CH2", 7},
                               {"TIM2_CH4", 7},  {"TIM4_UP", 7},   {"USART2_TX", 7}, {"I2C1_RX", 7}};
  constexpr DmaRow kSecond[] = {
      {"TIM5_CH4", 1},  {"TIM5_TRIG", 1}, {"TIM8_CH3", 1}, {"TIM8_UP", 1}, {"SPI3_RX", 1}, {"TIM8_CH4", 2},
      {"TIM8_TRIG", 2}, {"TIM8_COM", 2},  {"TIM5_CH3", 2}, {"TIM5_UP", 2}, {"SPI3_TX", 2}, {"TIM8_CH1", 3},
      {"UART4_RX", 3},  {"TIM6_UP", 3},   {"TIM5_CH2", 4}, {"SDIO", 4},    {"TIM7_UP", 4}, {"ADC3", 5},
      {"TIM8_CH2", 5},  {"TIM5_CH1", 5},  {"UART4_TX", 5}};
  add_dma(chip, 0x40020000, "DMA1", {11, 12, 13, 14, 15, 16, 17}, kFirst);
  if (parts.high_density) add_dma(chip, 0x40020400, "DMA2", {56, 57, 58, 59, 59}, kSecond);
}

void add_timers(Chip& chip, const F1Parts& parts) {
  for (TimerRow& row : timers_1_to_8({.tim1 = 0x40012C00, .tim8 = 0x40013400})) {
    if (row.spec.number > 4 && !parts.high_density) continue;
    row.spec.bits32 = false;
    add_timer(chip, row.base, std::move(row.spec));
  }
}

void add_adcs(Chip& chip, const F1Parts& parts) {
  ChipContext& context = chip.context();
  // RM0008 tables 68 to 71; EXTI11 and EXTI15 as AFIO has them after a reset
  const AdcTriggers first{
      {"TIM1_CC1", "TIM1_CC2", "TIM1_CC3", "TIM2_CC2", "TIM3_TRGO", "TIM4_CC4", "EXTI11"},
      {"TIM1_TRGO", "TIM1_CC4", "TIM2_TRGO", "TIM2_CC1", "TIM3_CC4", "TIM4_TRGO", "EXTI15"}};
  const AdcTriggers third{
      {"TIM3_CC1", "TIM2_CC3", "TIM1_CC3", "TIM8_CC1", "TIM8_TRGO", "TIM5_CC1", "TIM5_CC3"},
      {"TIM1_TRGO", "TIM1_CC4", "TIM4_CC3", "TIM8_CC2", "TIM8_CC4", "TIM5_TRGO", "TIM5_CC4"}};
  auto adc = std::make_unique<AdcF1>(AdcF1Spec{.number = 1, .irq = 18, .dma = true}, first, nullptr, context);
  adc->set_voltage(16, 1.43);  // temperature sensor at 25 degC (DS5319 5.3.19)
  adc->set_voltage(17, 1.20);  // VREFINT (DS5319 5.3.4)
  AdcF1& master = chip.add(0x40012400, 0x400, std::move(adc));
  chip.add(0x40012800, 0x400,
           std::make_unique<AdcF1>(AdcF1Spec{.number = 2, .irq = 18}, first, &master, context));
  if (!parts.high_density) return;
  chip.add(0x40013C00, 0x400,
           std::make_unique<AdcF1>(AdcF1Spec{.number = 3, .irq = 47, .dma = true}, third, nullptr, context));
}

void add_buses(Chip& chip, const F1Parts& parts) {
  ChipContext& context = chip.context();
  const Bus one = Bus::kApb1, two = Bus::kApb2;
  add_usart(chip, 0x40013800, {.number = 1, .name = "USART1", .bus = two, .irq = 37});
  add_usart(chip, 0x40004400, {.number = 2, .name = "USART2", .bus = one, .irq = 38});
  add_usart(chip, 0x40004800, {.number = 3, .name = "USART3", .bus = one, .irq = 39});
  add_spi(chip, 0x40013000, {.name = "SPI1", .bus = two, .irq = 35});
  add_spi(chip, 0x40003800, {.name = "SPI2", .bus = one, .irq = 36});
  add_i2c(chip, 0x40005400, {.name = "I2C1", .irq_event = 31, .irq_error = 32});
  add_i2c(chip, 0x40005800, {.name = "I2C2", .irq_event = 33, .irq_error = 34});
  chip.add(0x40006400, 0x400,
           std::make_unique<BxCan>("CAN1", std::array{19, 20, 21, 22}, 14u, nullptr, context));
  if (!parts.high_density) return;
  add_usart(chip, 0x40004C00, {.number = 4, .name = "UART4", .bus = one, .irq = 52});
  add_usart(chip, 0x40005000, {.number = 5, .name = "UART5", .bus = one, .irq = 53});
  add_spi(chip, 0x40003C00, {.name = "SPI3", .bus = one, .irq = 51});
}
}  // namespace

void build_f1(Chip& chip, const F1Parts& parts) {
  ChipContext& context = chip.context();
  chip.add(0x40021000, 0x400, make_rcc(RccFamily::kF1, context));
  chip.add(0x40007000, 0x400, make_pwr(PwrFamily::kF0F3, context));
  chip.add(0x40022000, 0x400,
           std::make_unique<Flash>(FlashFamily::kF0F3, parts.flash_bytes, parts.page_bytes, 4, context));
  add_ports(chip, parts.high_density ? "ABCDEFG" : "ABCDE", 0x40010800, GpioLayout::kF1);
  add_exti(chip, 0x40010400, 0x40010000, usual_exti_vectors(), SyscfgFamily::kF1);
  add_dmas(chip, parts);
  add_timers(chip, parts);
  add_adcs(chip, parts);
  add_buses(chip, parts);
  add_watchdogs(chip, 7, 2);
  chip.add(0x40023000, 0x400, std::make_unique<Crc>(CrcFamily::kV1, context.system));
  add_stored(chip, 0x40002800, 0x400, "RTC", {{0x04, 0x28}});  // CRL: RSF, RTOFF
  add_stored(chip, 0x40005C00, 0x400, "USB");
  add_stored(chip, 0x40006000, 0x400, "USB packet memory");
  add_stored(chip, 0x40006C00, 0x400, "BKP");
  if (parts.high_density) add_stored(chip, 0x40007400, 0x400, "DAC");
  if (parts.high_density) add_sdmmc(chip, 0x40018000, {.name = "SDIO", .irq = 49});
  if (parts.high_density) add_stored(chip, 0xA0000000, 0x1000, "FSMC");
  add_identity(chip, {0x1FFFF7E8, 0x1FFFF7E0, 0xE0042000, parts.device_id, parts.flash_bytes / 1024});
}

}  // namespace omnihil::mcu
