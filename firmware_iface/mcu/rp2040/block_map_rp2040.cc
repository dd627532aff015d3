// RP2040 datasheet §2.2: where its blocks are.
#include "firmware_iface/mcu/stm32/families/block_maps.h"

namespace omnihil::mcu {

std::span<const BlockPlace> block_map_rp2040() {
  static constexpr BlockPlace kMap[] = {
      {"XIP_CTRL", 0x14000000, 0x4000},   {"SSI", 0x18000000, 0x4000},
      {"SYSINFO", 0x40000000, 0x4000},    {"SYSCFG", 0x40004000, 0x4000},
      {"CLOCKS", 0x40008000, 0x4000},     {"RESETS", 0x4000C000, 0x4000},
      {"PSM", 0x40010000, 0x4000},        {"IO_BANK0", 0x40014000, 0x4000},
      {"IO_QSPI", 0x40018000, 0x4000},    {"PADS_BANK0", 0x4001C000, 0x4000},
      {"PADS_QSPI", 0x40020000, 0x4000},  {"XOSC", 0x40024000, 0x4000},
      {"PLL_SYS", 0x40028000, 0x4000},    {"PLL_USB", 0x4002C000, 0x4000},
      {"BUSCTRL", 0x40030000, 0x4000},    {"UART0", 0x40034000, 0x4000},
      {"UART1", 0x40038000, 0x4000},      {"SPI0", 0x4003C000, 0x4000},
      {"SPI1", 0x40040000, 0x4000},       {"I2C0", 0x40044000, 0x4000},
      {"I2C1", 0x40048000, 0x4000},       {"ADC", 0x4004C000, 0x4000},
      {"PWM", 0x40050000, 0x4000},        {"TIMER", 0x40054000, 0x4000},
      {"WATCHDOG", 0x40058000, 0x4000},   {"RTC", 0x4005C000, 0x4000},
      {"ROSC", 0x40060000, 0x4000},       {"VREG_AND_CHIP_RESET", 0x40064000, 0x4000},
      {"TBMAN", 0x4006C000, 0x4000},      {"DMA", 0x50000000, 0x4000},
      {"USB DPRAM", 0x50100000, 0x10000}, {"USB", 0x50110000, 0x4000},
      {"PIO0", 0x50200000, 0x4000},       {"PIO1", 0x50300000, 0x4000},
      {"XIP_AUX", 0x50400000, 0x4000},    {"SIO", 0xD0000000, 0x1000},
  };
  return kMap;
}

}  // namespace omnihil::mcu
