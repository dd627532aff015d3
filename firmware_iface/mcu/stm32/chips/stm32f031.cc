// STM32F031, as in STSPIN32F0 (RM0091; DS9773).
#include <memory>

#include "firmware_iface/mcu/stm32/chip_parts.h"
#include "firmware_iface/mcu/stm32/families/timer_rows.h"

namespace omnihil::mcu {
namespace {
void build(Chip& chip) {
  ChipContext& context = chip.context();
  chip.add(0x40021000, 0x400, make_rcc(RccFamily::kF0, context));
  chip.add(0x40007000, 0x400, make_pwr(PwrFamily::kF0F3, context));
  chip.add(0x40022000, 0x400, std::make_unique<Flash>(FlashFamily::kF0F3, 32 * 1024, 1024, 3, context));
  add_ports(chip, "ABCF", 0x48000000);
  add_exti(chip, 0x40010400, 0x40010000, {{0, 1, 5}, {2, 3, 6}, {4, 15, 7}});
  // RM0091 table 29
  constexpr DmaRow kDma[] = {
      {"ADC1", 1},      {"TIM2_CH3", 1}, {"TIM17_CH1", 1}, {"TIM17_UP", 1}, {"SPI1_RX", 2},  {"USART1_TX", 2},
      {"I2C1_TX", 2},   {"TIM1_CH1", 2}, {"TIM2_UP", 2},   {"TIM3_CH3", 2}, {"SPI1_TX", 3},  {"USART1_RX", 3},
      {"I2C1_RX", 3},   {"TIM1_CH2", 3}, {"TIM2_CH2", 3},  {"TIM3_CH4", 3}, {"TIM3_UP", 3},  {"TIM16_CH1", 3},
      {"TIM16_UP", 3},  {"TIM1_CH4", 4}, {"TIM1_TRIG", 4}, {"TIM1_COM", 4}, {"TIM2_CH4", 4}, {"TIM3_CH1", 4},
      {"TIM3_TRIG", 4}, {"TIM1_CH3", 5}, {"TIM1_UP", 5},   {"TIM2_CH1", 5}};
  add_dma(chip, 0x40020000, "DMA1", {9, 10, 10, 11, 11}, kDma);
  add_timers(chip, timers_of_f0());
  const AdcTriggers triggers{{"TIM1_TRGO", "TIM1_CC4", "TIM2_TRGO", "TIM3_TRGO", "TIM15_TRGO"}, {}};
  auto adc = std::make_unique<AdcV2>("ADC1", AdcFamily::kF0, 12, triggers, context);
  adc->set_voltage(16, 1.43);  // temperature at 25 degC
  adc->set_voltage(17, 1.23);  // VREFINT
  AdcV2& kept = chip.add(0x40012400, 0x300, std::move(adc));
  chip.add(0x40012700, 0x100, std::make_unique<AdcV2Common>("ADC common", std::vector{&kept}, context));
  const Bus apb = Bus::kApb1;  // one APB, two address ranges
  add_usart(chip, 0x40013800, {.number = 1, .name = "USART1", .v2 = true, .bus = apb, .irq = 27});
  add_spi(chip, 0x40013000, {.name = "SPI1", .v2 = true, .bus = apb, .irq = 25});
  add_i2c(chip, 0x40005400, {.name = "I2C1", .v2 = true, .from_hsi = true, .irq_event = 23});
  add_watchdogs(chip, 7, 2);
  add_stored(chip, 0x40002800, 0x400, "RTC", {{0x0C, 0x7F}});
  chip.add(0x40023000, 0x400, std::make_unique<Crc>(CrcFamily::kV2FixedPolynomial, chip.context().system));
  add_identity(chip, {0x1FFFF7AC, 0x1FFFF7CC, 0x40015800, 0x10006444, 32});
}
}  // namespace

const ChipSpec& chip_stm32f031() {
  static const ChipSpec spec{
      .name = "stm32f031",
      .variants = {"stspin32f0", "stspin32f0a", "stm32f031c6"},
      .core = kCortexM0,
      .blocks = BlockFamily::kF0,
      .reset_hz = 8e6,
      .memories = {{"flash", 0x08000000, 32 * 1024, true}, {"sram", 0x20000000, 4 * 1024}},
      .build = build};
  return spec;
}

}  // namespace omnihil::mcu
