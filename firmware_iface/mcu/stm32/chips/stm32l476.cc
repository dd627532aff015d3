// STM32L476, L471, L475, L486 (RM0351; DS10198).
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "firmware_iface/mcu/stm32/bxcan.h"
#include "firmware_iface/mcu/stm32/chip_parts.h"
#include "firmware_iface/mcu/stm32/families/timer_rows.h"

namespace omnihil::mcu {
namespace {
constexpr std::uint32_t kFlashBytes = 1024 * 1024;

void add_dmas(Chip& chip) {
  // RM0351 tables 44, 45
  constexpr DmaRow kFirst[] = {
      {"ADC1", 1, 0},      {"TIM2_CH3", 1, 4},   {"TIM17_CH1", 1, 5}, {"TIM17_UP", 1, 5},
      {"TIM4_CH1", 1, 6},  {"ADC2", 2, 0},       {"SPI1_RX", 2, 1},   {"USART3_TX", 2, 2},
      {"I2C3_TX", 2, 3},   {"TIM2_UP", 2, 4},    {"TIM3_CH3", 2, 5},  {"TIM1_CH1", 2, 7},
      {"ADC3", 3, 0},      {"SPI1_TX", 3, 1},    {"USART3_RX", 3, 2}, {"I2C3_RX", 3, 3},
      {"TIM16_CH1", 3, 4}, {"TIM16_UP", 3, 4},   {"TIM3_CH4", 3, 5},  {"TIM3_UP", 3, 5},
      {"TIM6_UP", 3, 6},   {"TIM1_CH2", 3, 7},   {"SPI2_RX", 4, 1},   {"USART1_TX", 4, 2},
      {"I2C2_TX", 4, 3},   {"TIM7_UP", 4, 5},    {"TIM4_CH2", 4, 6},  {"TIM1_CH4", 4, 7},
      {"TIM1_TRIG", 4, 7}, {"TIM1_COM", 4, 7},   {"SPI2_TX", 5, 1},   {"USART1_RX", 5, 2},
      {"I2C2_RX", 5, 3},   {"TIM2_CH1", 5, 4},   {"TIM4_CH3", 5, 6},  {"TIM15_CH1", 5, 7},
      {"TIM15_UP", 5, 7},  {"TIM15_TRIG", 5, 7}, {"TIM15_COM", 5, 7}, {"USART2_RX", 6, 2},
      {"I2C1_TX", 6, 3},   {"TIM16_CH1", 6, 4},  {"TIM16_UP", 6, 4},  {"TIM3_CH1", 6, 5},
      {"TIM3_TRIG", 6, 5}, {"TIM1_UP", 6, 7},    {"USART2_TX", 7, 2}, {"I2C1_RX", 7, 3},
      {"TIM2_CH2", 7, 4},  {"TIM2_CH4", 7, 4},   {"TIM17_CH1", 7, 5}, {"TIM17_UP", 7, 5},
      {"TIM4_UP", 7, 6},   {"TIM1_CH3", 7, 7}};
  constexpr DmaRow kSecond[] = {
      {"UART5_TX", 1, 2}, {"SPI3_RX", 1, 3},  {"TIM5_CH4", 1, 5},  {"TIM5_TRIG", 1, 5},
      {"TIM8_CH3", 1, 7}, {"TIM8_UP", 1, 7},  {"UART5_RX", 2, 2},  {"SPI3_TX", 2, 3},
      {"TIM5_CH3", 2, 5}, {"TIM5_UP", 2, 5},  {"TIM8_CH4", 2, 7},  {"TIM8_TRIG", 2, 7},
      {"TIM8_COM", 2, 7}, {"ADC1", 3, 0},     {"UART4_TX", 3, 2},  {"SPI1_RX", 3, 4},
      {"ADC2", 4, 0},     {"TIM6_UP", 4, 3},  {"SPI1_TX", 4, 4},   {"TIM5_CH2", 4, 5},
      {"SDMMC1", 4, 7},   {"ADC3", 5, 0},     {"UART4_RX", 5, 2},  {"TIM7_UP", 5, 3},
      {"TIM5_CH1", 5, 5}, {"SDMMC1", 5, 7},   {"USART1_TX", 6, 2}, {"LPUART1_TX", 6, 4},
      {"I2C1_RX", 6, 5},  {"TIM8_CH1", 6, 7}, {"USART1_RX", 7, 2}, {"LPUART1_RX", 7, 4},
      {"I2C1_TX", 7, 5},  {"TIM8_CH2", 7, 7}};
  add_dma(chip, 0x40020000, "DMA1", {11, 12, 13, 14, 15, 16, 17}, kFirst);
  add_dma(chip, 0x40020400, "DMA2", {56, 57, 58, 59, 60, 68, 69}, kSecond);
}

void add_adcs(Chip& chip) {
  std::vector<AdcV2*> all;
  for (unsigned n = 0; n < 3; ++n) {
    auto adc = std::make_unique<AdcV2>("ADC" + std::to_string(n + 1), AdcFamily::kL4, n < 2 ? 18 : 47,
                                       adc_triggers_f3(), chip.context());
    if (n == 0) adc->set_voltage(0, 1.212);  // VREFINT
    if (n == 0) adc->set_voltage(17, 0.76);  // temperature at 30 degC
    all.push_back(&chip.add(0x50040000 + 0x100 * n, 0x100, std::move(adc)));
  }
  chip.add(0x50040300, 0x100, std::make_unique<AdcV2Common>("ADC123", all, chip.context()));
}

void add_buses(Chip& chip) {
  const Bus one = Bus::kApb1, two = Bus::kApb2;
  add_usart(chip, 0x40013800, {.number = 1, .name = "USART1", .v2 = true, .bus = two, .irq = 37});
  add_usart(chip, 0x40004400, {.number = 2, .name = "USART2", .v2 = true, .bus = one, .irq = 38});
  add_usart(chip, 0x40004800, {.number = 3, .name = "USART3", .v2 = true, .bus = one, .irq = 39});
  add_usart(chip, 0x40004C00, {.number = 4, .name = "UART4", .v2 = true, .bus = one, .irq = 52});
  add_usart(chip, 0x40005000, {.number = 5, .name = "UART5", .v2 = true, .bus = one, .irq = 53});
  add_usart(chip, 0x40008000,
            {.number = 0, .name = "LPUART1", .v2 = true, .bus = one, .irq = 70, .low_power = true});
  add_spi(chip, 0x40013000, {.name = "SPI1", .v2 = true, .bus = two, .irq = 35});
  add_spi(chip, 0x40003800, {.name = "SPI2", .v2 = true, .bus = one, .irq = 36});
  add_spi(chip, 0x40003C00, {.name = "SPI3", .v2 = true, .bus = one, .irq = 51});
  add_i2c(chip, 0x40005400, {.name = "I2C1", .v2 = true, .irq_event = 31, .irq_error = 32});
  add_i2c(chip, 0x40005800, {.name = "I2C2", .v2 = true, .irq_event = 33, .irq_error = 34});
  add_i2c(chip, 0x40005C00, {.name = "I2C3", .v2 = true, .irq_event = 72, .irq_error = 73});
  chip.add(0x40006400, 0x400,
           std::make_unique<BxCan>("CAN1", std::array{19, 20, 21, 22}, 14u, nullptr, chip.context()));
  add_sdmmc(chip, 0x40012800, {.name = "SDMMC1", .irq = 49});
}

void build(Chip& chip) {
  ChipContext& context = chip.context();
  chip.add(0x40021000, 0x400, make_rcc(RccFamily::kL4, context));
  chip.add(0x40007000, 0x400, make_pwr(PwrFamily::kL4, context));
  chip.add(0x40022000, 0x400, std::make_unique<Flash>(FlashFamily::kL4, kFlashBytes, 2048, 4, context));
  add_ports(chip, "ABCDEFGH", 0x48000000);
  add_exti(chip, 0x40010400, 0x40010000, usual_exti_vectors(), SyscfgFamily::kL4);
  add_dmas(chip);
  add_timers(chip, timers_1_to_8({.tim1 = 0x40012C00, .tim8 = 0x40013400, .itr = "TIM15_TRGO"}));
  add_timers(chip, timers_15_to_17(24, {"TIM1_TRGO", "TIM3_TRGO", "TIM16_CC1", "TIM17_CC1"}));
  add_adcs(chip);
  add_buses(chip);
  add_watchdogs(chip, 7, 2);
  chip.add(0x40023000, 0x400, std::make_unique<Crc>(CrcFamily::kV2, context.system));
  add_stored(chip, 0x40002800, 0x400, "RTC", {{0x0C, 0x7F}});
  add_stored(chip, 0x40002400, 0x400, "LCD");
  add_stored(chip, 0x40007400, 0x400, "DAC1");
  add_stored(chip, 0x40007800, 0x400, "OPAMP");
  add_stored(chip, 0x40010030, 0x1D0, "VREFBUF", {{0, 8}});
  add_stored(chip, 0x40010200, 0x200, "COMP");
  add_stored(chip, 0x50000000, 0x20000, "OTG_FS", {{0x10, 0x80000000, 0x31}});
  add_stored(chip, 0x50060800, 0x400, "RNG", {{0x04, 1}});
  add_identity(chip, {0x1FFF7590, 0x1FFF75E0, 0xE0042000, 0x10076415, kFlashBytes / 1024});
}
}  // namespace

const ChipSpec& chip_stm32l476() {
  static const ChipSpec spec{.name = "stm32l476",
                             .variants = {"stm32l471", "stm32l475", "stm32l486"},
                             .core = kCortexM4F,
                             .blocks = BlockFamily::kL4,
                             .reset_hz = 4e6,
                             .memories = {{"flash", 0x08000000, kFlashBytes, true},
                                          {"sram", 0x20000000, 96 * 1024},
                                          {"sram2", 0x10000000, 32 * 1024}},
                             .build = build};
  return spec;
}

}  // namespace omnihil::mcu
