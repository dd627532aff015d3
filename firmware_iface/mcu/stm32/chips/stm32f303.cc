// STM32F303xB, xC (RM0316; DS9118).
#include <memory>

#include "firmware_iface/mcu/stm32/bxcan.h"
#include "firmware_iface/mcu/stm32/chip_parts.h"
#include "firmware_iface/mcu/stm32/families/timer_rows.h"

namespace omnihil::mcu {
namespace {
void add_dmas(Chip& chip) {
  // RM0316 tables 78, 79, without the remappings of SYSCFG
  constexpr DmaRow kFirst[] = {
      {"ADC1", 1},      {"TIM2_CH3", 1},  {"TIM4_CH1", 1},  {"TIM17_CH1", 1}, {"TIM17_UP", 1},
      {"USART3_TX", 2}, {"SPI1_RX", 2},   {"TIM1_CH1", 2},  {"TIM2_UP", 2},   {"TIM3_CH3", 2},
      {"USART3_RX", 3}, {"SPI1_TX", 3},   {"TIM1_CH2", 3},  {"TIM3_CH4", 3},  {"TIM3_UP", 3},
      {"TIM16_CH1", 3}, {"TIM16_UP", 3},  {"USART1_TX", 4}, {"SPI2_RX", 4},   {"I2C2_TX", 4},
      {"TIM1_CH4", 4},  {"TIM1_TRIG", 4}, {"TIM1_COM", 4},  {"TIM4_CH2", 4},  {"USART1_RX", 5},
      {"SPI2_TX", 5},   {"I2C2_RX", 5},   {"TIM1_UP", 5},   {"TIM2_CH1", 5},  {"TIM4_CH3", 5},
      {"TIM15_CH1", 5}, {"TIM15_UP", 5},  {"USART2_RX", 6}, {"I2C1_TX", 6},   {"TIM1_CH3", 6},
      {"TIM3_CH1", 6},  {"TIM3_TRIG", 6}, {"USART2_TX", 7}, {"I2C1_RX", 7},   {"TIM2_CH2", 7},
      {"TIM2_CH4", 7},  {"TIM4_UP", 7}};
  constexpr DmaRow kSecond[] = {{"ADC2", 1},     {"SPI3_RX", 1},  {"TIM8_CH3", 1}, {"TIM8_UP", 1},
                                {"ADC4", 2},     {"SPI3_TX", 2},  {"TIM8_CH4", 2}, {"TIM8_TRIG", 2},
                                {"TIM8_COM", 2}, {"UART4_RX", 3}, {"TIM6_UP", 3},  {"TIM8_CH1", 3},
                                {"TIM7_UP", 4},  {"ADC3", 5},     {"UART4_TX", 5}, {"TIM8_CH2", 5}};
  add_dma(chip, 0x40020000, "DMA1", {11, 12, 13, 14, 15, 16, 17}, kFirst);
  add_dma(chip, 0x40020400, "DMA2", {56, 57, 58, 59, 60}, kSecond);
}

void add_timers(Chip& chip) {
  for (TimerRow& row : timers_1_to_8({.tim1 = 0x40012C00, .tim8 = 0x40013400, .itr = "TIM15_TRGO"})) {
    if (row.spec.number == 5) continue;
    row.spec.fast_clock = row.spec.advanced;
    if (row.spec.number == 8) row.spec.internal_triggers[3] = "TIM3_TRGO";
    add_timer(chip, row.base, std::move(row.spec));
  }
  add_timers(chip, timers_15_to_17(24, {"TIM2_TRGO", "TIM3_TRGO", "TIM16_CC1", "TIM17_CC1"}));
}

void add_adcs(Chip& chip) {
  ChipContext& context = chip.context();
  for (unsigned pair = 0; pair < 2; ++pair) {
    const std::uint32_t base = 0x50000000 + 0x400 * pair;
    const AdcTriggers triggers = pair == 0 ? adc_triggers_f3() : adc_triggers_f3_second();
    std::vector<AdcV2*> two;
    for (unsigned n = 0; n < 2; ++n) {
      const int irq = pair == 0 ? 18 : n == 0 ? 47 : 61;
      auto adc = std::make_unique<AdcV2>("ADC" + std::to_string(2 * pair + n + 1), AdcFamily::kF3, irq,
                                         triggers, context);
      adc->set_voltage(18, 1.23);                           // VREFINT
      if (pair == 0 && n == 0) adc->set_voltage(16, 1.43);  // temperature at 25 degC
      two.push_back(&chip.add(base + 0x100 * n, 0x100, std::move(adc)));
    }
    chip.add(base + 0x300, 0x100, std::make_unique<AdcV2Common>(pair == 0 ? "ADC12" : "ADC34", two, context));
  }
}

void build(Chip& chip) {
  ChipContext& context = chip.context();
  chip.add(0x40021000, 0x400, make_rcc(RccFamily::kF3, context));
  chip.add(0x40007000, 0x400, make_pwr(PwrFamily::kF0F3, context));
  chip.add(0x40022000, 0x400, std::make_unique<Flash>(FlashFamily::kF0F3, 256 * 1024, 2048, 4, context));
  add_ports(chip, "ABCDEF", 0x48000000);
  add_exti(chip, 0x40010400, 0x40010000, usual_exti_vectors());
  add_dmas(chip);
  add_timers(chip);
  add_adcs(chip);
  const Bus one = Bus::kApb1, two = Bus::kApb2;
  add_usart(chip, 0x40013800, {.number = 1, .name = "USART1", .v2 = true, .bus = two, .irq = 37});
  add_usart(chip, 0x40004400, {.number = 2, .name = "USART2", .v2 = true, .bus = one, .irq = 38});
  add_usart(chip, 0x40004800, {.number = 3, .name = "USART3", .v2 = true, .bus = one, .irq = 39});
  add_usart(chip, 0x40004C00, {.number = 4, .name = "UART4", .v2 = true, .bus = one, .irq = 52});
  add_usart(chip, 0x40005000, {.number = 5, .name = "UART5", .v2 = true, .bus = one, .irq = 53});
  add_spi(chip, 0x40013000, {.name = "SPI1", .v2 = true, .bus = two, .irq = 35});
  add_spi(chip, 0x40003800, {.name = "SPI2", .v2 = true, .bus = one, .irq = 36});
  add_spi(chip, 0x40003C00, {.name = "SPI3", .v2 = true, .bus = one, .irq = 51});
  add_i2c(chip, 0x40005400, {.name = "I2C1", .v2 = true, .from_hsi = true, .irq_event = 31, .irq_error = 32});
  add_i2c(chip, 0x40005800, {.name = "I2C2", .v2 = true, .from_hsi = true, .irq_event = 33, .irq_error = 34});
  chip.add(0x40006400, 0x400,
           std::make_unique<BxCan>("CAN1", std::array{19, 20, 21, 22}, 14u, nullptr, context));
  add_watchdogs(chip, 7, 2);
  add_stored(chip, 0x40002800, 0x400, "RTC", {{0x0C, 0x7F}});
  add_stored(chip, 0x40005C00, 0x400, "USB");
  add_stored(chip, 0x40006000, 0x400, "USB packet memory");
  add_stored(chip, 0x40007400, 0x400, "DAC");
  add_stored(chip, 0x40010030, 0x3D0, "COMP and OPAMP");
  chip.add(0x40023000, 0x400, std::make_unique<Crc>(CrcFamily::kV2, chip.context().system));
  add_stored(chip, 0x40024000, 0x400, "TSC");
  add_identity(chip, {0x1FFFF7AC, 0x1FFFF7CC, 0xE0042000, 0x10036422, 256});
}
}  // namespace

const ChipSpec& chip_stm32f303() {
  static const ChipSpec spec{.name = "stm32f303",
                             .variants = {"stm32f303rb", "stm32f303rc", "stm32f303cb", "stm32f303cc"},
                             .core = kCortexM4F,
                             .blocks = BlockFamily::kF3,
                             .reset_hz = 8e6,
                             .memories = {{"flash", 0x08000000, 256 * 1024, true},
                                          {"sram", 0x20000000, 40 * 1024},
                                          {"ccm", 0x10000000, 8 * 1024, false, true}},
                             .build = build};
  return spec;
}

}  // namespace omnihil::mcu
