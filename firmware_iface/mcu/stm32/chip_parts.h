// The parts that chips of one family have alike, for the files of chips/.
//
//   add_ports(chip, "ABCDEFGHI", 0x40020000);
//   add_exti(chip, 0x40013C00, 0x40013800, {{0, 0, 6}, …});
//   add_timer(chip, 0x40010000, {.number = 1, …});
#pragma once
#include <span>
#include <string_view>
#include <vector>

#include "firmware_iface/mcu/stm32/adc/adc_v1.h"
#include "firmware_iface/mcu/stm32/adc/adc_v2.h"
#include "firmware_iface/mcu/stm32/chip.h"
#include "firmware_iface/mcu/stm32/clock/pwr.h"
#include "firmware_iface/mcu/stm32/clock/rcc.h"
#include "firmware_iface/mcu/stm32/dma/dma_v1.h"
#include "firmware_iface/mcu/stm32/dma/dma_v2.h"
#include "firmware_iface/mcu/stm32/exti.h"
#include "firmware_iface/mcu/stm32/gpio.h"
#include "firmware_iface/mcu/stm32/i2c.h"
#include "firmware_iface/mcu/stm32/math/crc.h"
#include "firmware_iface/mcu/stm32/sdmmc.h"
#include "firmware_iface/mcu/stm32/spi.h"
#include "firmware_iface/mcu/stm32/stored_block.h"
#include "firmware_iface/mcu/stm32/timer/timer.h"
#include "firmware_iface/mcu/stm32/usart.h"

namespace omnihil::mcu {

void add_ports(Chip& chip, std::string_view letters, std::uint32_t base,
               GpioLayout layout = GpioLayout::kModes);
// Lines 0..4 alone, 5..9, 10..15 (all but F0).
std::vector<ExtiVector> usual_exti_vectors();
void add_exti(Chip& chip, std::uint32_t exti, std::uint32_t syscfg, std::vector<ExtiVector> vectors,
              SyscfgFamily family = SyscfgFamily::kUsual);
Timer& add_timer(Chip& chip, std::uint32_t base, TimerSpec spec);
void add_usart(Chip& chip, std::uint32_t base, const UsartSpec& spec);
void add_spi(Chip& chip, std::uint32_t base, const SpiSpec& spec);
void add_i2c(Chip& chip, std::uint32_t base, const I2cSpec& spec);
void add_sdmmc(Chip& chip, std::uint32_t base, const SdmmcSpec& spec);
// A DMA controller of fixed wiring: requests of channels, with what CSELR has to say where the chip has it.
struct DmaRow {
  const char* request;
  unsigned channel;
  int code = -1;
};
void add_dma(Chip& chip, std::uint32_t base, const char* name, std::vector<int> irqs,
             std::span<const DmaRow> rows);
void add_stored(Chip& chip, std::uint32_t base, std::uint32_t bytes, const char* name,
                std::vector<StoredBlock::Fixed> fixed = {});
void add_watchdogs(Chip& chip, unsigned prescaler_at, unsigned prescaler_bits);
// Unique id (96 bits), flash size in KiB, device id of DBGMCU.
struct ChipIdentity {
  std::uint32_t unique_id, flash_size, debug, device_id, flash_kib;
};
void add_identity(Chip& chip, const ChipIdentity& identity);

// What F4 and F7 have in common: two DMA controllers with their request tables, three ADCs, timers 1 to 14.
void add_dma_f4(Chip& chip);
void add_timers_f4(Chip& chip, bool timers_6_to_14);
AdcTriggers adc_triggers_f4();
AdcTriggers adc_triggers_f7();
// Clocks, power, flash, ports, EXTI, the above, serial ports 1 to 6, SPI 1 to 3, I2C 1 to 3, both bxCAN and
// what the two F4 chips merely keep.
void add_common_f4(Chip& chip, std::string_view ports, std::uint32_t flash_bytes);
void add_adcs_f4(Chip& chip, const AdcTriggers& triggers);
// ADC12 of F3 and G4; ADC34 of F3.
AdcTriggers adc_triggers_f3();
AdcTriggers adc_triggers_f3_second();

}  // namespace omnihil::mcu
