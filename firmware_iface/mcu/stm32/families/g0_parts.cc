#include "firmware_iface/mcu/stm32/families/g0_parts.h"

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "firmware_iface/mcu/stm32/chip_parts.h"
#include "firmware_iface/mcu/stm32/families/timer_rows.h"
#include "firmware_iface/mcu/stm32/fdcan_g4.h"

namespace omnihil::mcu {
namespace {
constexpr Bus kApb = Bus::kApb1;  // one APB, two address ranges

// RM0444 table 55: request numbers of the DMAMUX.
std::vector<std::pair<unsigned, std::string>> requests() {
  std::vector<std::pair<unsigned, std::string>> all;
  unsigned number = 5;
  for (const char* name :
       {"ADC1",      "AES_IN",    "AES_OUT",    "DAC1_CH1",   "DAC1_CH2",   "I2C1_RX",   "I2C1_TX",
        "I2C2_RX",   "I2C2_TX",   "LPUART1_RX", "LPUART1_TX", "SPI1_RX",    "SPI1_TX",   "SPI2_RX",
        "SPI2_TX",   "TIM1_CH1",  "TIM1_CH2",   "TIM1_CH3",   "TIM1_CH4",   "TIM1_COM",  "TIM1_UP",
        "TIM2_CH1",  "TIM2_CH2",  "TIM2_CH3",   "TIM2_CH4",   "TIM2_TRIG",  "TIM2_UP",   "TIM3_CH1",
        "TIM3_CH2",  "TIM3_CH3",  "TIM3_CH4",   "TIM3_TRIG",  "TIM3_UP",    "TIM6_UP",   "TIM7_UP",
        "TIM15_CH1", "TIM15_CH2", "TIM15_COM",  "TIM15_UP",   "TIM16_CH1",  "TIM16_COM", "TIM16_UP",
        "TIM17_CH1", "TIM17_COM", "TIM17_UP",   "USART1_RX",  "USART1_TX",  "USART2_RX", "USART2_TX",
        "USART3_RX", "USART3_TX", "USART4_RX",  "USART4_TX",  "UCPD1_RX",   "UCPD1_TX",  "UCPD2_RX",
        "UCPD2_TX",  "I2C3_RX",   "I2C3_TX",    "LPUART2_RX", "LPUART2_TX", "SPI3_RX",   "SPI3_TX",
        "TIM4_CH1",  "TIM4_CH2",  "TIM4_CH3",   "TIM4_CH4",   "TIM4_TRIG",  "TIM4_UP",   "USART5_RX",
        "USART5_TX", "USART6_RX", "USART6_TX"})
    all.emplace_back(number++, name);
  return all;
}

void add_dmas(Chip& chip, const G0Parts& parts) {
  ChipContext& context = chip.context();
  auto mux = std::make_unique<DmaMux>("DMAMUX", requests(), context);
  std::vector<int> first{9, 10, 10, 11, 11, 11, 11};
  if (parts.size == G0Size::k03) first.resize(5);
  const auto channels = static_cast<unsigned>(first.size());
  const DmaMux& chooser = chip.add(0x40020800, 0x400, std::move(mux));
  chip.add(0x40020000, 0x400, std::make_unique<DmaV1>("DMA1", std::move(first), context)).use_mux(chooser, 0);
  if (parts.size != G0Size::k0B) return;
  chip.add(0x40020400, 0x400, std::make_unique<DmaV1>("DMA2", std::vector{11, 11, 11, 11, 11}, context))
      .use_mux(chooser, channels);
}

// Internal triggers of TIM4 are not known here: none.
std::vector<TimerRow> timers(const G0Parts& parts) {
  std::vector<TimerRow> rows = timers_of_f0();
  if (parts.size >= G0Size::k05) {
    rows.push_back({0x40001000, {.number = 6, .channels = 0, .irq_update = 17}});
    rows.push_back({0x40001400, {.number = 7, .channels = 0, .irq_update = 18}});
    rows.push_back({0x40014000,
                    {.number = 15,
                     .channels = 2,
                     .advanced = true,
                     .irq_update = 20,
                     .internal_triggers = {"TIM2_TRGO", "TIM3_TRGO", "TIM16_CC1", "TIM17_CC1"}}});
  }
  if (parts.size == G0Size::k0B) rows.push_back({0x40000800, {.number = 4, .irq_update = 16}});
  if (parts.value_line) std::erase_if(rows, [](const TimerRow& row) { return row.spec.number == 2; });
  for (TimerRow& row : rows) row.spec.selects_inputs = true;
  return rows;
}

void add_adc(Chip& chip, const G0Parts& parts) {
  ChipContext& context = chip.context();
  const AdcTriggers triggers{{"TIM1_TRGO2", "TIM1_CC4", parts.value_line ? "" : "TIM2_TRGO", "TIM3_TRGO",
                              "TIM15_TRGO", "TIM6_TRGO", "TIM4_TRGO", "EXTI11"},
                             {}};
  auto adc = std::make_unique<AdcV2>("ADC1", AdcFamily::kG0, 12, triggers, context);
  adc->set_voltage(12, 0.76);   // temperature at 30 degC
  adc->set_voltage(13, 1.212);  // VREFINT
  AdcV2& kept = chip.add(0x40012400, 0x300, std::move(adc));
  chip.add(0x40012700, 0x100, std::make_unique<AdcV2Common>("ADC common", std::vector{&kept}, context));
}

void add_serials(Chip& chip, const G0Parts& parts) {
  const bool more = parts.size >= G0Size::k07, large = parts.size == G0Size::k0B;
  const auto usart = [&chip](std::uint32_t base, int number, int irq, bool full) {
    add_usart(chip, base,
              {.number = number,
               .name = "USART" + std::to_string(number),
               .v2 = true,
               .bus = kApb,
               .irq = irq,
               .fifo = full ? 8u : 0u});
  };
  const auto low_power = [&chip](std::uint32_t base, const char* name, int irq) {
    add_usart(chip, base,
              {.number = 0, .name = name, .v2 = true, .bus = kApb, .irq = irq, .low_power = true, .fifo = 8});
  };
  usart(0x40013800, 1, 27, true);
  usart(0x40004400, 2, 28, more);
  if (!parts.value_line) low_power(0x40008000, "LPUART1", 29);
  if (more) usart(0x40004800, 3, 29, large);
  if (more) usart(0x40004C00, 4, 29, false);
  if (large) usart(0x40005000, 5, 29, false);
  if (large) usart(0x40013C00, 6, 29, false);
  if (large && !parts.value_line) low_power(0x40008400, "LPUART2", 28);
}

void add_buses(Chip& chip, const G0Parts& parts) {
  add_serials(chip, parts);
  add_spi(chip, 0x40013000, {.name = "SPI1", .v2 = true, .bus = kApb, .irq = 25});
  add_spi(chip, 0x40003800, {.name = "SPI2", .v2 = true, .bus = kApb, .irq = 26});
  add_i2c(chip, 0x40005400, {.name = "I2C1", .v2 = true, .irq_event = 23});
  add_i2c(chip, 0x40005800, {.name = "I2C2", .v2 = true, .irq_event = 24});
  if (parts.size != G0Size::k0B) return;
  add_spi(chip, 0x40003C00, {.name = "SPI3", .v2 = true, .bus = kApb, .irq = 26});
  add_i2c(chip, 0x40008800, {.name = "I2C3", .v2 = true, .irq_event = 24});
  if (parts.value_line) return;
  FdcanRam& ram = chip.add(0x4000B400, 2 * 0x350, std::make_unique<FdcanRam>(2 * 0x350));
  chip.add(0x40006400, 0x400, std::make_unique<FdcanG4>(1, std::pair{21, 22}, ram, chip.context()));
  chip.add(0x40006800, 0x400, std::make_unique<FdcanG4>(2, std::pair{21, 22}, ram, chip.context()));
}

// Of the whole line alone.
void add_kept_analog(Chip& chip, const G0Parts& parts) {
  add_stored(chip, 0x40007C00, 0x400, "LPTIM1");
  add_stored(chip, 0x40009400, 0x400, "LPTIM2");
  add_stored(chip, 0x40010030, 0x50, "VREFBUF", {{0, 8}});
  if (parts.size >= G0Size::k05) {
    add_stored(chip, 0x40007400, 0x400, "DAC1");
    add_stored(chip, 0x40010200, 0x200, "COMP");
  }
  if (parts.size >= G0Size::k07) {
    add_stored(chip, 0x40007800, 0x400, "CEC");
    add_stored(chip, 0x4000A000, 0x400, "UCPD1");
    add_stored(chip, 0x4000A400, 0x400, "UCPD2");
  }
}

void add_kept(Chip& chip, const G0Parts& parts) {
  add_stored(chip, 0x40002800, 0x400, "RTC", {{0x0C, 0x7F}});
  add_stored(chip, 0x4000B000, 0x400, "TAMP");
  if (!parts.value_line) add_kept_analog(chip, parts);
  if (parts.size != G0Size::k0B) return;
  add_stored(chip, 0x40005C00, 0x400, "USB");
  add_stored(chip, 0x40009800, 0x800, "USB packet memory");
  if (!parts.value_line) add_stored(chip, 0x40006C00, 0x400, "CRS");
}
}  // namespace

void build_g0(Chip& chip, const G0Parts& parts) {
  ChipContext& context = chip.context();
  chip.add(0x40021000, 0x400, make_rcc(RccFamily::kG0, context));
  chip.add(0x40007000, 0x400, make_pwr(PwrFamily::kG0, context));
  chip.add(0x40022000, 0x400, std::make_unique<Flash>(FlashFamily::kG0, parts.flash_bytes, 2048, 3, context));
  add_ports(chip, parts.size == G0Size::k0B ? "ABCDEF" : "ABCDF", 0x50000000);
  add_exti(chip, 0x40021800, 0x40010000, {{0, 1, 5}, {2, 3, 6}, {4, 15, 7}}, SyscfgFamily::kG0);
  add_dmas(chip, parts);
  add_timers(chip, timers(parts));
  add_adc(chip, parts);
  add_buses(chip, parts);
  add_watchdogs(chip, 11, 3);
  chip.add(0x40023000, 0x400, std::make_unique<Crc>(CrcFamily::kV2, context.system));
  add_kept(chip, parts);
  add_identity(chip, {0x1FFF7590, 0x1FFF75E0, 0x40015800, parts.device_id, parts.flash_bytes / 1024});
}

}  // namespace omnihil::mcu
