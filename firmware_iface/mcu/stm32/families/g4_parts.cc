#include "firmware_iface/mcu/stm32/families/g4_parts.h"

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "firmware_iface/mcu/stm32/chip_parts.h"
#include "firmware_iface/mcu/stm32/families/timer_rows.h"
#include "firmware_iface/mcu/stm32/fdcan_g4.h"
#include "firmware_iface/mcu/stm32/math/cordic.h"

namespace omnihil::mcu {
namespace {
// RM0440 table 91: request numbers of the DMAMUX.
std::vector<std::pair<unsigned, std::string>> requests() {
  std::vector<std::pair<unsigned, std::string>> all;
  const auto run = [&all](unsigned from, std::initializer_list<const char*> names) {
    for (const char* name : names) all.emplace_back(from++, name);
  };
  run(5, {"ADC1", "DAC1_CH1", "DAC1_CH2", "TIM6_UP", "TIM7_UP", "SPI1_RX", "SPI1_TX", "SPI2_RX", "SPI2_TX",
          "SPI3_RX", "SPI3_TX"});
  run(16, {"I2C1_RX", "I2C1_TX", "I2C2_RX", "I2C2_TX", "I2C3_RX", "I2C3_TX", "I2C4_RX", "I2C4_TX"});
  run(24, {"USART1_RX", "USART1_TX", "USART2_RX", "USART2_TX", "USART3_RX", "USART3_TX", "UART4_RX",
           "UART4_TX", "UART5_RX", "UART5_TX"});
  run(34, {"LPUART1_RX", "LPUART1_TX"});
  run(36, {"ADC2", "ADC3", "ADC4", "ADC5"});
  run(42, {"TIM1_CH1", "TIM1_CH2", "TIM1_CH3", "TIM1_CH4", "TIM1_UP", "TIM1_TRIG", "TIM1_COM"});
  run(49, {"TIM8_CH1", "TIM8_CH2", "TIM8_CH3", "TIM8_CH4", "TIM8_UP", "TIM8_TRIG", "TIM8_COM"});
  run(56, {"TIM2_CH1", "TIM2_CH2", "TIM2_CH3", "TIM2_CH4", "TIM2_UP"});
  run(61, {"TIM3_CH1", "TIM3_CH2", "TIM3_CH3", "TIM3_CH4", "TIM3_UP", "TIM3_TRIG"});
  run(67, {"TIM4_CH1", "TIM4_CH2", "TIM4_CH3", "TIM4_CH4", "TIM4_UP"});
  run(72, {"TIM5_CH1", "TIM5_CH2", "TIM5_CH3", "TIM5_CH4", "TIM5_UP", "TIM5_TRIG"});
  run(78,
      {"TIM15_CH1", "TIM15_UP", "TIM15_TRIG", "TIM15_COM", "TIM16_CH1", "TIM16_UP", "TIM17_CH1", "TIM17_UP"});
  run(86, {"TIM20_CH1", "TIM20_CH2", "TIM20_CH3", "TIM20_CH4", "TIM20_UP"});
  run(112, {"CORDIC_RD", "CORDIC_WR"});
  return all;
}

void add_timers(Chip& chip, const G4Parts& parts) {
  // ITR0..10 are the same for all timers that have them
  const std::vector<std::string> itr = {"TIM1_TRGO", "TIM2_TRGO",  "TIM3_TRGO", "TIM4_TRGO", "TIM5_TRGO",
                                        "TIM8_TRGO", "TIM15_TRGO", "TIM16_CC1", "TIM17_CC1", "TIM20_TRGO"};
  std::vector<TimerRow> rows = timers_1_to_8({.tim1 = 0x40012C00, .tim8 = 0x40013400});
  TimerSpec twentieth = rows[1].spec;  // another TIM8
  twentieth.number = 20;
  twentieth.irq_update = 78, twentieth.irq_compare = 80, twentieth.irq_break = 77, twentieth.irq_trigger = 79;
  rows.insert(rows.begin() + 2, {0x40015000, std::move(twentieth)});
  const std::vector<TimerRow> last = timers_15_to_17(24, itr);
  rows.insert(rows.end(), last.begin(), last.end());
  for (auto& [base, spec] : rows) {
    if ((spec.number == 5 || spec.number == 20) && !parts.large) continue;
    spec.new_layout = true;
    if (!spec.internal_triggers.empty()) spec.internal_triggers = itr;
    add_timer(chip, base, std::move(spec));
  }
}

void add_adcs(Chip& chip, const G4Parts& parts) {
  ChipContext& context = chip.context();
  struct Row {
    int number;
    std::uint32_t base;
    int irq;
  };
  std::vector<AdcV2*> first, second;
  for (const Row& row : {Row{1, 0x50000000, 18}, Row{2, 0x50000100, 18}, Row{3, 0x50000400, 47},
                         Row{4, 0x50000500, 61}, Row{5, 0x50000600, 62}}) {
    if (row.number > 2 && !parts.large) continue;
    const AdcTriggers triggers = row.number <= 2 ? adc_triggers_f3() : adc_triggers_f3_second();
    auto adc = std::make_unique<AdcV2>("ADC" + std::to_string(row.number), AdcFamily::kG4, row.irq, triggers,
                                       context);
    adc->set_voltage(18, 1.212);  // VREFINT
    if (row.number == 1) adc->set_voltage(16, 0.76);
    (row.number <= 2 ? first : second).push_back(&chip.add(row.base, 0x100, std::move(adc)));
  }
  chip.add(0x50000300, 0x100, std::make_unique<AdcV2Common>("ADC12", first, context));
  if (!second.empty()) chip.add(0x50000700, 0x100, std::make_unique<AdcV2Common>("ADC345", second, context));
}

}  // namespace

void build_g4(Chip& chip, const G4Parts& parts) {
  ChipContext& context = chip.context();
  chip.add(0x40021000, 0x400, make_rcc(RccFamily::kG4, context));
  chip.add(0x40007000, 0x400, make_pwr(PwrFamily::kG4, context));
  chip.add(0x40022000, 0x400, std::make_unique<Flash>(FlashFamily::kG4, parts.flash_bytes, 2048, 4, context));
  add_ports(chip, "ABCDEFG", 0x48000000);
  add_exti(chip, 0x40010400, 0x40010000, usual_exti_vectors());
  auto mux = std::make_unique<DmaMux>("DMAMUX", requests(), context);
  std::vector<int> first{11, 12, 13, 14, 15, 16, 17, 96}, second{56, 57, 58, 59, 60, 97, 98, 99};
  first.resize(parts.dma_channels);
  second.resize(parts.dma_channels);
  auto dma1 = std::make_unique<DmaV1>("DMA1", std::move(first), context);
  auto dma2 = std::make_unique<DmaV1>("DMA2", std::move(second), context);
  dma1->use_mux(*mux, 0);
  dma2->use_mux(*mux, parts.dma_channels);
  chip.add(0x40020800, 0x400, std::move(mux));
  chip.add(0x40020000, 0x400, std::move(dma1));
  chip.add(0x40020400, 0x400, std::move(dma2));
  add_timers(chip, parts);
  add_adcs(chip, parts);
  const Bus one = Bus::kApb1, two = Bus::kApb2;
  add_usart(chip, 0x40013800, {.number = 1, .name = "USART1", .v2 = true, .bus = two, .irq = 37, .fifo = 8});
  add_usart(chip, 0x40004400, {.number = 2, .name = "USART2", .v2 = true, .bus = one, .irq = 38, .fifo = 8});
  add_usart(chip, 0x40004800, {.number = 3, .name = "USART3", .v2 = true, .bus = one, .irq = 39, .fifo = 8});
  add_usart(chip, 0x40004C00, {.number = 4, .name = "UART4", .v2 = true, .bus = one, .irq = 52, .fifo = 8});
  if (parts.large)
    add_usart(chip, 0x40005000, {.number = 5, .name = "UART5", .v2 = true, .bus = one, .irq = 53, .fifo = 8});
  add_usart(
      chip, 0x40008000,
      {.number = 0, .name = "LPUART1", .v2 = true, .bus = one, .irq = 91, .low_power = true, .fifo = 8});
  add_spi(chip, 0x40013000, {.name = "SPI1", .v2 = true, .bus = two, .irq = 35});
  add_spi(chip, 0x40003800, {.name = "SPI2", .v2 = true, .bus = one, .irq = 36});
  add_spi(chip, 0x40003C00, {.name = "SPI3", .v2 = true, .bus = one, .irq = 51});
  if (parts.large) add_spi(chip, 0x40013C00, {.name = "SPI4", .v2 = true, .bus = two, .irq = 84});
  add_i2c(chip, 0x40005400, {.name = "I2C1", .v2 = true, .irq_event = 31, .irq_error = 32});
  add_i2c(chip, 0x40005800, {.name = "I2C2", .v2 = true, .irq_event = 33, .irq_error = 34});
  add_i2c(chip, 0x40007800, {.name = "I2C3", .v2 = true, .irq_event = 92, .irq_error = 93});
  if (parts.large) add_i2c(chip, 0x40008400, {.name = "I2C4", .v2 = true, .irq_event = 82, .irq_error = 83});
  FdcanRam& ram = chip.add(0x4000A400, FdcanRam::kBytes, std::make_unique<FdcanRam>());
  chip.add(0x40006400, 0x400, std::make_unique<FdcanG4>(1, std::pair{21, 22}, ram, context));
  if (parts.large) chip.add(0x40006800, 0x400, std::make_unique<FdcanG4>(2, std::pair{86, 87}, ram, context));
  if (parts.large) chip.add(0x40006C00, 0x400, std::make_unique<FdcanG4>(3, std::pair{88, 89}, ram, context));
  add_watchdogs(chip, 11, 3);
  add_stored(chip, 0x40002800, 0x400, "RTC", {{0x0C, 0x7F}});
  add_stored(chip, 0x40002000, 0x400, "CRS");
  add_stored(chip, 0x40005C00, 0x400, "USB");
  add_stored(chip, 0x40006000, 0x400, "USB packet memory");
  add_stored(chip, 0x40007C00, 0x400, "LPTIM1");
  add_stored(chip, 0x40010030, 0x1D0, "VREFBUF", {{0, 8}});
  add_stored(chip, 0x40010200, 0x100, "COMP");
  add_stored(chip, 0x40010300, 0x100, "OPAMP");
  if (parts.large) add_stored(chip, 0x40016800, 0x1000, "HRTIM");
  chip.add(0x40020C00, 0x400, std::make_unique<Cordic>(context, 100));
  add_stored(chip, 0x40021400, 0x400, "FMAC");
  chip.add(0x40023000, 0x400, std::make_unique<Crc>(CrcFamily::kV2, chip.context().system));
  add_stored(chip, 0x50000800, 0x400, "DAC1");
  add_stored(chip, 0x50060800, 0x400, "RNG", {{0x04, 1}});
  add_identity(chip, {0x1FFF7590, 0x1FFF75E0, 0xE0042000, parts.device_id, parts.flash_bytes / 1024});
}

}  // namespace omnihil::mcu
