#include "firmware_iface/mcu/stm32/chip_parts.h"

#include <memory>
#include <string>
#include <utility>

#include "firmware_iface/mcu/stm32/bxcan.h"
#include "firmware_iface/mcu/stm32/families/timer_rows.h"
#include "firmware_iface/mcu/stm32/watchdog.h"

namespace omnihil::mcu {

void add_ports(Chip& chip, std::string_view letters, std::uint32_t base, GpioLayout layout) {
  for (const char letter : letters) {
    const auto n = static_cast<unsigned>(letter - 'A');
    chip.add(base + 0x400 * n, 0x400, std::make_unique<GpioPort>(n, chip.context(), layout));
  }
}

std::vector<ExtiVector> usual_exti_vectors() {
  return {{0, 0, 6}, {1, 1, 7}, {2, 2, 8}, {3, 3, 9}, {4, 4, 10}, {5, 9, 23}, {10, 15, 40}};
}

void add_exti(Chip& chip, std::uint32_t exti, std::uint32_t syscfg, std::vector<ExtiVector> vectors,
              SyscfgFamily family) {
  const bool large = family == SyscfgFamily::kH7;
  Syscfg& selection =
      chip.add(syscfg, large ? 0x400 : 0x30, std::make_unique<Syscfg>(chip.context(), family));
  Exti& lines = chip.add(exti, 0x400,
                         std::make_unique<Exti>(selection, std::move(vectors),
                                                large                         ? kExtiH7
                                                : family == SyscfgFamily::kG0 ? kExtiG0
                                                                              : kExtiUsual,
                                                chip.context()));
  for (const Chip::Mapped& block : chip.blocks()) {
    if (auto* port = dynamic_cast<GpioPort*>(block.peripheral)) {
      port->on_level([&lines](unsigned at, unsigned pin, bool level) { lines.pin_changed(at, pin, level); });
    }
  }
}

Timer& add_timer(Chip& chip, std::uint32_t base, TimerSpec spec) {
  return chip.add(base, 0x400, std::make_unique<Timer>(std::move(spec), chip.context()));
}

void add_usart(Chip& chip, std::uint32_t base, const UsartSpec& spec) {
  chip.add(base, 0x400, std::make_unique<Usart>(spec, chip.context()));
}

void add_spi(Chip& chip, std::uint32_t base, const SpiSpec& spec) {
  chip.add(base, 0x400, make_spi(spec, chip.context()));
}

void add_i2c(Chip& chip, std::uint32_t base, const I2cSpec& spec) {
  chip.add(base, 0x400, make_i2c(spec, chip.context()));
}

void add_sdmmc(Chip& chip, std::uint32_t base, const SdmmcSpec& spec) {
  chip.add(base, 0x400, std::make_unique<Sdmmc>(spec, chip.context()));
}

void add_stored(Chip& chip, std::uint32_t base, std::uint32_t bytes, const char* name,
                std::vector<StoredBlock::Fixed> fixed) {
  chip.add(base, bytes, std::make_unique<StoredBlock>(name, std::move(fixed), bytes, chip.context()));
}

void add_watchdogs(Chip& chip, unsigned prescaler_at, unsigned prescaler_bits) {
  chip.add(0x40003000, 0x400, make_iwdg(chip.context()));
  chip.add(0x40002C00, 0x400, make_wwdg(0, prescaler_at, prescaler_bits, chip.context()));
}

void add_identity(Chip& chip, const ChipIdentity& id) {
  const std::uint32_t page = id.unique_id & ~0xFFFu;
  const std::uint32_t bytes = 0x1000;
  auto block = std::make_unique<Signature>("system memory", chip.context(), bytes);
  // A made-up lot and wafer; robots that number themselves by it are told apart by the board file.
  constexpr std::uint32_t kUniqueId[] = {0x0033001Fu, 0x30345105u, 0x36373734u};
  for (unsigned i = 0; i < 3; ++i) block->put(id.unique_id - page + 4 * i, kUniqueId[i], 4);
  block->put(id.flash_size - page, id.flash_kib, 2);
  chip.add(page, bytes, std::move(block));
  add_stored(chip, id.debug, 0x60, "DBGMCU", {{0, id.device_id}});
}

void add_dma(Chip& chip, std::uint32_t base, const char* name, std::vector<int> irqs,
             std::span<const DmaRow> rows) {
  auto dma = std::make_unique<DmaV1>(name, std::move(irqs), chip.context());
  for (const DmaRow& row : rows) dma->connect(row.request, row.channel, row.code);
  chip.add(base, 0x400, std::move(dma));
}

void add_dma_f4(Chip& chip) {
  struct Row {
    const char* request;
    unsigned stream, channel;
  };
  // RM0090 table 42, RM0410 table 26
  constexpr Row kFirst[] = {
      {"SPI3_RX", 0, 0},   {"I2C1_RX", 0, 1},  {"TIM4_CH1", 0, 2},  {"UART5_RX", 0, 4},  {"UART8_TX", 0, 5},
      {"TIM5_CH3", 0, 6},  {"TIM5_UP", 0, 6},  {"TIM2_UP", 1, 3},   {"TIM2_CH3", 1, 3},  {"USART3_RX", 1, 4},
      {"UART7_TX", 1, 5},  {"TIM5_CH4", 1, 6}, {"TIM5_TRIG", 1, 6}, {"TIM6_UP", 1, 7},   {"SPI3_RX", 2, 0},
      {"TIM7_UP", 2, 1},   {"I2C3_RX", 2, 3},  {"UART4_RX", 2, 4},  {"TIM3_CH4", 2, 5},  {"TIM3_UP", 2, 5},
      {"TIM5_CH1", 2, 6},  {"I2C2_RX", 2, 7},  {"SPI2_RX", 3, 0},   {"TIM4_CH2", 3, 2},  {"USART3_TX", 3, 4},
      {"UART7_RX", 3, 5},  {"TIM5_CH4", 3, 6}, {"I2C2_RX", 3, 7},   {"SPI2_TX", 4, 0},   {"TIM7_UP", 4, 1},
      {"I2C3_TX", 4, 3},   {"UART4_TX", 4, 4}, {"TIM3_CH1", 4, 5},  {"TIM3_TRIG", 4, 5}, {"TIM5_CH2", 4, 6},
      {"USART3_TX", 4, 7}, {"SPI3_TX", 5, 0},  {"I2C1_RX", 5, 1},   {"TIM2_CH1", 5, 3},  {"USART2_RX", 5, 4},
      {"TIM3_CH2", 5, 5},  {"I2C1_TX", 6, 1},  {"TIM4_UP", 6, 2},   {"TIM2_CH2", 6, 3},  {"TIM2_CH4", 6, 3},
      {"USART2_TX", 6, 4}, {"UART8_RX", 6, 5}, {"TIM5_UP", 6, 6},   {"SPI3_TX", 7, 0},   {"I2C1_TX", 7, 1},
      {"TIM4_CH3", 7, 2},  {"TIM2_UP", 7, 3},  {"TIM2_CH4", 7, 3},  {"UART5_TX", 7, 4},  {"TIM3_CH3", 7, 5},
      {"I2C2_TX", 7, 7}};
  constexpr Row kSecond[] = {
      {"ADC1", 0, 0},      {"ADC3", 0, 2},      {"SPI1_RX", 0, 3},   {"SPI4_RX", 0, 4},   {"TIM1_TRIG", 0, 6},
      {"ADC3", 1, 2},      {"SPI4_TX", 1, 4},   {"USART6_RX", 1, 5}, {"TIM1_CH1", 1, 6},  {"TIM8_UP", 1, 7},
      {"TIM8_CH1", 2, 0},  {"TIM8_CH2", 2, 0},  {"TIM8_CH3", 2, 0},  {"ADC2", 2, 1},      {"SPI1_RX", 2, 3},
      {"USART1_RX", 2, 4}, {"USART6_RX", 2, 5}, {"TIM1_CH2", 2, 6},  {"TIM8_CH1", 2, 7},  {"ADC2", 3, 1},
      {"SPI1_TX", 3, 3},   {"SPI4_RX", 3, 5},   {"TIM1_CH1", 3, 6},  {"TIM8_CH2", 3, 7},  {"ADC1", 4, 0},
      {"SPI4_TX", 4, 5},   {"TIM1_CH4", 4, 6},  {"TIM1_TRIG", 4, 6}, {"TIM1_COM", 4, 6},  {"TIM8_CH3", 4, 7},
      {"SPI1_TX", 5, 3},   {"USART1_RX", 5, 4}, {"TIM1_UP", 5, 6},   {"TIM1_CH1", 6, 0},  {"TIM1_CH2", 6, 0},
      {"TIM1_CH3", 6, 0},  {"USART6_TX", 6, 5}, {"TIM1_CH3", 6, 6},  {"USART1_TX", 7, 4}, {"USART6_TX", 7, 5},
      {"TIM8_CH4", 7, 7},  {"TIM8_TRIG", 7, 7}, {"TIM8_COM", 7, 7},  {"SDIO", 3, 4},      {"SDIO", 6, 4},
      {"SDMMC1", 3, 4},    {"SDMMC1", 6, 4}};
  auto first = std::make_unique<DmaV2>(1, std::vector<int>{11, 12, 13, 14, 15, 16, 17, 47}, chip.context());
  for (const Row& row : kFirst) first->connect(row.request, row.stream, row.channel);
  auto second = std::make_unique<DmaV2>(2, std::vector<int>{56, 57, 58, 59, 60, 68, 69, 70}, chip.context());
  for (const Row& row : kSecond) second->connect(row.request, row.stream, row.channel);
  chip.add(0x40026000, 0x400, std::move(first));
  chip.add(0x40026400, 0x400, std::move(second));
}

void add_timers_f4(Chip& chip, bool small) {
  const Bus two = Bus::kApb2;
  add_timers(chip, timers_1_to_8({.tim1 = 0x40010000, .tim8 = 0x40010400}));
  add_timer(chip, 0x40014000,
            {.number = 9,
             .bus = two,
             .channels = 2,
             .irq_update = 24,
             .internal_triggers = {"TIM2_TRGO", "TIM3_TRGO", "TIM10_CC1", "TIM11_CC1"}});
  add_timer(chip, 0x40014400, {.number = 10, .bus = two, .channels = 1, .irq_update = 25});
  add_timer(chip, 0x40014800, {.number = 11, .bus = two, .channels = 1, .irq_update = 26});
  if (small) add_timers(chip, timers_12_to_14());
}

AdcTriggers adc_triggers_f4() {
  return {{"TIM1_CC1", "TIM1_CC2", "TIM1_CC3", "TIM2_CC2", "TIM2_CC3", "TIM2_CC4", "TIM2_TRGO", "TIM3_CC1",
           "TIM3_TRGO", "TIM4_CC4", "TIM5_CC1", "TIM5_CC2", "TIM5_CC3", "TIM8_CC1", "TIM8_TRGO", "EXTI11"},
          {"TIM1_CC4", "TIM1_TRGO", "TIM2_CC1", "TIM2_TRGO", "TIM3_CC2", "TIM3_CC4", "TIM4_CC1", "TIM4_CC2",
           "TIM4_CC3", "TIM4_TRGO", "TIM5_CC4", "TIM5_TRGO", "TIM8_CC2", "TIM8_CC3", "TIM8_CC4", "EXTI15"}};
}

AdcTriggers adc_triggers_f7() {
  return {{"TIM1_CC1", "TIM1_CC2", "TIM1_CC3", "TIM2_CC2", "TIM5_TRGO", "TIM4_CC4", "TIM3_CC4", "TIM8_TRGO",
           "", "TIM1_TRGO", "", "TIM2_TRGO", "TIM4_TRGO", "TIM6_TRGO", "", "EXTI11"},
          {"TIM1_TRGO", "TIM1_CC4", "TIM2_TRGO", "TIM2_CC1", "TIM3_CC4", "TIM4_TRGO", "", "TIM8_CC4", "",
           "TIM8_TRGO", "", "TIM3_CC3", "TIM5_TRGO", "TIM3_CC1", "TIM6_TRGO", ""}};
}

// "": TRGO2, which is not modelled
AdcTriggers adc_triggers_f3() {
  return {{"TIM1_CC1", "TIM1_CC2", "TIM1_CC3", "TIM2_CC2", "TIM3_TRGO", "TIM4_CC4", "EXTI11", "TIM8_TRGO", "",
           "TIM1_TRGO", "", "TIM2_TRGO", "TIM4_TRGO", "TIM6_TRGO", "TIM15_TRGO", "TIM3_CC4"},
          {"TIM1_TRGO", "TIM1_CC4", "TIM2_TRGO", "TIM2_CC1", "TIM3_CC4", "TIM4_TRGO", "EXTI15", "TIM8_CC4",
           "", "TIM8_TRGO", "", "TIM3_CC3", "TIM3_TRGO", "TIM3_CC1", "TIM6_TRGO", "TIM15_TRGO"}};
}

AdcTriggers adc_triggers_f3_second() {
  return {{"TIM3_CC1", "TIM2_CC3", "TIM1_CC3", "TIM8_CC1", "TIM8_TRGO", "EXTI2", "TIM4_CC1", "TIM2_TRGO", "",
           "TIM1_TRGO", "", "TIM3_TRGO", "TIM4_TRGO", "TIM7_TRGO", "TIM15_TRGO", "TIM2_CC1"},
          {"TIM1_TRGO", "TIM1_CC4", "TIM4_CC3", "TIM8_CC2", "TIM8_CC4", "TIM4_CC3", "TIM4_CC4", "TIM4_TRGO",
           "", "TIM8_TRGO", "", "TIM1_CC3", "TIM3_TRGO", "TIM2_TRGO", "TIM7_TRGO", "TIM15_TRGO"}};
}

void add_adcs_f4(Chip& chip, const AdcTriggers& triggers) {
  AdcV1Common& common = chip.add(0x40012300, 0x100, std::make_unique<AdcV1Common>(chip.context()));
  for (int n = 1; n <= 3; ++n) {
    auto adc = std::make_unique<AdcV1>(n, 18, common, triggers, chip.context());
    if (n == 1) {
      adc->set_voltage(16, 0.76);  // temperature sensor at 25 degC
      adc->set_voltage(17, 1.21);  // VREFINT
    }
    chip.add(0x40012000u + 0x100u * static_cast<unsigned>(n - 1), 0x100, std::move(adc));
  }
}

void add_common_f4(Chip& chip, std::string_view ports, std::uint32_t flash_bytes) {
  ChipContext& context = chip.context();
  chip.add(0x40023800, 0x400, make_rcc(RccFamily::kF4, context));
  chip.add(0x40007000, 0x400, make_pwr(PwrFamily::kF4, context));
  chip.add(0x40023C00, 0x400, std::make_unique<Flash>(FlashFamily::kF4, flash_bytes, 16384, 4, context));
  add_ports(chip, ports, 0x40020000);
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
  add_sdmmc(chip, 0x40012C00, {.name = "SDIO", .irq = 49});
  chip.add(0x40023000, 0x400, std::make_unique<Crc>(CrcFamily::kV1, chip.context().system));
  // GRSTCTL: AHB idle, core reset and FIFO flushes done
  add_stored(chip, 0x50000000, 0x20000, "OTG_FS", {{0x10, 0x80000000, 0x31}});
  add_stored(chip, 0x40040000, 0x20000, "OTG_HS", {{0x10, 0x80000000, 0x31}});
}

}  // namespace omnihil::mcu
