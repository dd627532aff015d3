#include "firmware_iface/mcu/stm32/families/h7_parts.h"

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "firmware_iface/mcu/stm32/chip_parts.h"
#include "firmware_iface/mcu/stm32/clock/flash_h7.h"
#include "firmware_iface/mcu/stm32/dma/mdma.h"
#include "firmware_iface/mcu/stm32/families/timer_rows.h"
#include "firmware_iface/mcu/stm32/fdcan_h7.h"
#include "firmware_iface/mcu/stm32/math/cordic.h"
#include "firmware_iface/mcu/stm32/watchdog.h"

namespace omnihil::mcu {
namespace {
// RM0433 table 121, RM0468 table 119: request numbers of DMAMUX1.
std::vector<std::pair<unsigned, std::string>> requests() {
  std::vector<std::pair<unsigned, std::string>> all;
  const auto run = [&all](unsigned from, std::initializer_list<const char*> names) {
    for (const char* name : names) all.emplace_back(from++, name);
  };
  run(9, {"ADC1", "ADC2"});
  run(11, {"TIM1_CH1", "TIM1_CH2", "TIM1_CH3", "TIM1_CH4", "TIM1_UP", "TIM1_TRIG", "TIM1_COM"});
  run(18, {"TIM2_CH1", "TIM2_CH2", "TIM2_CH3", "TIM2_CH4", "TIM2_UP"});
  run(23, {"TIM3_CH1", "TIM3_CH2", "TIM3_CH3", "TIM3_CH4", "TIM3_UP", "TIM3_TRIG"});
  run(29, {"TIM4_CH1", "TIM4_CH2", "TIM4_CH3", "TIM4_UP"});
  run(33, {"I2C1_RX", "I2C1_TX", "I2C2_RX", "I2C2_TX", "SPI1_RX", "SPI1_TX", "SPI2_RX", "SPI2_TX"});
  run(41, {"USART1_RX", "USART1_TX", "USART2_RX", "USART2_TX", "USART3_RX", "USART3_TX"});
  run(47, {"TIM8_CH1", "TIM8_CH2", "TIM8_CH3", "TIM8_CH4", "TIM8_UP", "TIM8_TRIG", "TIM8_COM"});
  run(55, {"TIM5_CH1", "TIM5_CH2", "TIM5_CH3", "TIM5_CH4", "TIM5_UP", "TIM5_TRIG"});
  run(61, {"SPI3_RX", "SPI3_TX", "UART4_RX", "UART4_TX", "UART5_RX", "UART5_TX"});
  run(67, {"DAC1_CH1", "DAC1_CH2", "TIM6_UP", "TIM7_UP"});
  run(71, {"USART6_RX", "USART6_TX", "I2C3_RX", "I2C3_TX"});
  run(79, {"UART7_RX", "UART7_TX", "UART8_RX", "UART8_TX", "SPI4_RX", "SPI4_TX", "SPI5_RX", "SPI5_TX"});
  run(105,
      {"TIM15_CH1", "TIM15_UP", "TIM15_TRIG", "TIM15_COM", "TIM16_CH1", "TIM16_UP", "TIM17_CH1", "TIM17_UP"});
  run(115, {"ADC3", "UART9_RX", "UART9_TX", "USART10_RX", "USART10_TX"});
  run(122, {"CORDIC_RD", "CORDIC_WR", "I2C5_RX", "I2C5_TX"});
  run(126, {"TIM23_CH1"});
  return all;
}

void add_dma(Chip& chip) {
  ChipContext& context = chip.context();
  auto mux = std::make_unique<DmaMux>("DMAMUX1", requests(), context);
  auto first = std::make_unique<DmaV2>(1, std::vector<int>{11, 12, 13, 14, 15, 16, 17, 47}, context);
  auto second = std::make_unique<DmaV2>(2, std::vector<int>{56, 57, 58, 59, 60, 68, 69, 70}, context);
  first->use_mux(*mux, 0);
  second->use_mux(*mux, 8);
  chip.add(0x40020800, 0x400, std::move(mux));
  first->announce_ends();
  second->announce_ends();
  chip.add(0x40020000, 0x400, std::move(first));
  chip.add(0x40020400, 0x400, std::move(second));
  std::vector<std::string> ends;  // RM0433 table 99: TSEL 0 to 15
  for (const char* of : {"DMA1_TC", "DMA2_TC"}) {
    for (int stream = 0; stream < 8; ++stream) ends.push_back(of + std::to_string(stream));
  }
  chip.add(0x52000000, 0x1000, std::make_unique<Mdma>(122, ends, context));
  // RM0433 table 124; its channels' second memory address is not followed
  auto low_mux = std::make_unique<DmaMux>("DMAMUX2",
                                          std::vector<std::pair<unsigned, std::string>>{{9, "LPUART1_RX"},
                                                                                        {10, "LPUART1_TX"},
                                                                                        {11, "SPI6_RX"},
                                                                                        {12, "SPI6_TX"},
                                                                                        {13, "I2C4_RX"},
                                                                                        {14, "I2C4_TX"},
                                                                                        {17, "ADC3"}},
                                          context);
  auto basic =
      std::make_unique<DmaV1>("BDMA", std::vector<int>{129, 130, 131, 132, 133, 134, 135, 136}, context);
  basic->use_mux(*low_mux, 0);
  chip.add(0x58025800, 0x400, std::move(low_mux));
  chip.add(0x58025400, 0x400, std::move(basic));
}

void add_timers(Chip& chip, const H7Parts& parts) {
  std::vector<TimerRow> rows = timers_1_to_8({.tim1 = 0x40010000, .tim8 = 0x40010400, .itr = "TIM15_TRGO"});
  const auto append = [&rows](const std::vector<TimerRow>& more) {
    rows.insert(rows.end(), more.begin(), more.end());
  };
  append(timers_12_to_14());
  append(timers_15_to_17(116, {"TIM1_TRGO", "TIM3_TRGO", "TIM16_CC1", "TIM17_CC1"}));
  if (parts.newer) {
    append({{0x4000E000, {.number = 23, .bits32 = true, .irq_update = 161}},
            {0x4000E400, {.number = 24, .bits32 = true, .irq_update = 162}}});
  }
  for (auto& [base, spec] : rows) {
    spec.selects_inputs = true;
    if (spec.number == 5) spec.internal_triggers = {"TIM1_TRGO", "TIM8_TRGO", "TIM3_TRGO", "TIM4_TRGO"};
  }
  add_timers(chip, rows);
}

void add_adcs(Chip& chip, const H7Parts& parts) {
  ChipContext& context = chip.context();
  // RM0433 tables 205, 206: those of F3; HRTIM's and LPTIM's are not modelled
  const AdcTriggers triggers = adc_triggers_f3();
  std::vector<AdcV2*> pair;
  for (unsigned n = 0; n < 2; ++n) {
    pair.push_back(&chip.add(
        0x40022000 + 0x100 * n, 0x100,
        std::make_unique<AdcV2>("ADC" + std::to_string(n + 1), AdcFamily::kH7, 18, triggers, context)));
  }
  chip.add(0x40022300, 0x100, std::make_unique<AdcV2Common>("ADC12", pair, context));
  auto third =
      std::make_unique<AdcV2>("ADC3", parts.newer ? AdcFamily::kG4 : AdcFamily::kH7, 127, triggers, context);
  third->set_voltage(18 - (parts.newer ? 1 : 0), 0.62);   // temperature at 30 degC
  third->set_voltage(19 - (parts.newer ? 1 : 0), 1.216);  // VREFINT
  AdcV2& kept = chip.add(0x58026000, 0x100, std::move(third));
  chip.add(0x58026300, 0x100, std::make_unique<AdcV2Common>("ADC3 common", std::vector{&kept}, context));
}

void add_serial(Chip& chip, const H7Parts& parts) {
  struct Row {
    std::uint32_t base;
    const char* name;
    int number, irq;
    Bus bus;
  };
  constexpr Row kRows[] = {
      {0x40011000, "USART1", 1, 37, Bus::kUsart16},   {0x40004400, "USART2", 2, 38, Bus::kUsartRest},
      {0x40004800, "USART3", 3, 39, Bus::kUsartRest}, {0x40004C00, "UART4", 4, 52, Bus::kUsartRest},
      {0x40005000, "UART5", 5, 53, Bus::kUsartRest},  {0x40011400, "USART6", 6, 71, Bus::kUsart16},
      {0x40007800, "UART7", 7, 82, Bus::kUsartRest},  {0x40007C00, "UART8", 8, 83, Bus::kUsartRest},
      {0x40011800, "UART9", 9, 155, Bus::kUsart16},   {0x40011C00, "USART10", 10, 156, Bus::kUsart16}};
  for (const Row& row : kRows) {
    if (row.number > 8 && !parts.newer) continue;
    add_usart(
        chip, row.base,
        {.number = row.number, .name = row.name, .v2 = true, .bus = row.bus, .irq = row.irq, .fifo = 16});
  }
  add_usart(chip, 0x58000C00,
            {.number = 0,
             .name = "LPUART1",
             .v2 = true,
             .bus = Bus::kLowPowerUart,
             .irq = 142,
             .low_power = true,
             .fifo = 16});
}

void add_buses(Chip& chip, const H7Parts& parts) {
  add_spi(chip, 0x40013000, {.name = "SPI1", .bus = Bus::kSpi123, .irq = 35, .fifo_bytes = 16});
  add_spi(chip, 0x40003800, {.name = "SPI2", .bus = Bus::kSpi123, .irq = 36, .fifo_bytes = 16});
  add_spi(chip, 0x40003C00, {.name = "SPI3", .bus = Bus::kSpi123, .irq = 51, .fifo_bytes = 16});
  add_spi(chip, 0x40013400, {.name = "SPI4", .bus = Bus::kSpi45, .irq = 84, .fifo_bytes = 8});
  add_spi(chip, 0x40015000, {.name = "SPI5", .bus = Bus::kSpi45, .irq = 85, .fifo_bytes = 8});
  add_spi(chip, 0x58001400, {.name = "SPI6", .bus = Bus::kSpi6, .irq = 86, .fifo_bytes = 8});
  const auto i2c = [&chip](std::uint32_t base, const char* name, Bus bus, int irq) {
    add_i2c(chip, base, {.name = name, .v2 = true, .bus = bus, .irq_event = irq, .irq_error = irq + 1});
  };
  i2c(0x40005400, "I2C1", Bus::kI2c123, 31);
  i2c(0x40005800, "I2C2", Bus::kI2c123, 33);
  i2c(0x40005C00, "I2C3", Bus::kI2c123, 72);
  i2c(0x58001C00, "I2C4", Bus::kI2c4, 95);
  if (parts.newer) i2c(0x40006400, "I2C5", Bus::kI2c123, 157);
  add_sdmmc(chip, 0x52007000, {.name = "SDMMC1", .v2 = true, .irq = 49});
  add_sdmmc(chip, 0x48022400, {.name = "SDMMC2", .v2 = true, .irq = 124});
  ChipContext& context = chip.context();
  FdcanRam& ram = chip.add(0x4000AC00, 0x2800, std::make_unique<FdcanRam>(0x2800));
  chip.add(0x4000A000, 0x400, std::make_unique<FdcanH7>(1, std::pair{19, 21}, ram, context));
  chip.add(0x4000A400, 0x400, std::make_unique<FdcanH7>(2, std::pair{20, 22}, ram, context));
  if (parts.newer)
    chip.add(0x4000D400, 0x400, std::make_unique<FdcanH7>(3, std::pair{159, 160}, ram, context));
}

void add_kept(Chip& chip, const H7Parts& parts) {
  add_stored(chip, 0x58004000, 0x400, "RTC", {{0x0C, 0x7F}});
  add_stored(chip, 0x40008400, 0x400, "CRS");
  add_stored(chip, 0x40007400, 0x400, "DAC1");
  add_stored(chip, 0x40009000, 0x400, "OPAMP");
  add_stored(chip, 0x58003800, 0x400, "COMP");
  add_stored(chip, 0x58003C00, 0x400, "VREFBUF", {{0, 8}});
  if (!parts.newer) add_stored(chip, 0x40017400, 0x400, "HRTIM");
  add_stored(chip, 0x40028000, 0x1400, "ETH", {{0x1000, 0, 1}});
  add_stored(chip, 0x40040000, 0x20000, "OTG_HS", {{0x10, 0x80000000, 0x31}});
  if (!parts.newer) add_stored(chip, 0x40080000, 0x20000, "OTG_FS", {{0x10, 0x80000000, 0x31}});
  add_stored(chip, 0x48021800, 0x400, "RNG", {{0x04, 1}});
  add_stored(chip, 0x52004000, 0x1000, "FMC");
  add_stored(chip, 0x58026400, 0x400, "HSEM");
}
}  // namespace

void build_h7(Chip& chip, const H7Parts& parts) {
  ChipContext& context = chip.context();
  chip.add(0x58024400, 0x400, make_rcc(RccFamily::kH7, context));
  chip.add(0x58024800, 0x400, make_pwr(PwrFamily::kH7, context));
  chip.add(0x52002000, 0x1000, std::make_unique<FlashH7>(parts.flash_bytes, parts.flash_banks, 4, context));
  add_ports(chip, parts.newer ? "ABCDEFGHJK" : "ABCDEFGHIJK", 0x58020000);
  add_exti(chip, 0x58000000, 0x58000400, usual_exti_vectors(), SyscfgFamily::kH7);
  add_dma(chip);
  add_timers(chip, parts);
  add_adcs(chip, parts);
  add_serial(chip, parts);
  add_buses(chip, parts);
  chip.add(0x58004800, 0x400, make_iwdg(context));
  chip.add(0x50003000, 0x400, make_wwdg(0, 11, 3, context, Bus::kApb3));
  chip.add(0x58024C00, 0x400, std::make_unique<Crc>(CrcFamily::kV2, context.system));
  if (parts.newer) chip.add(0x48024400, 0x400, std::make_unique<Cordic>(context, 154));
  add_kept(chip, parts);
  add_identity(chip, {0x1FF1E800, 0x1FF1E880, 0x5C001000, parts.device_id, parts.flash_bytes / 1024});
}

ChipSpec h7_spec(std::string_view name, std::vector<std::string_view> variants, const H7Parts& parts,
                 void (*build)(Chip& chip)) {
  return {.name = name,
          .variants = std::move(variants),
          .core = kCortexM7,
          .blocks = BlockFamily::kH7,
          .reset_hz = 64e6,
          .memories = {{"flash", 0x08000000, parts.flash_bytes, true},
                       {"itcm", 0x00000000, 64 * 1024, false, true},
                       {"dtcm", 0x20000000, 128 * 1024, false, true},
                       {"sram", 0x24000000, parts.sram_bytes},
                       {"sram of D2", 0x30000000, parts.d2_bytes},
                       {"sram4", 0x38000000, parts.sram4_bytes},
                       {"backup", 0x38800000, 4096}},
          .aliases = {{"sram of D2", 0x10000000}},
          .build = build};
}

}  // namespace omnihil::mcu
