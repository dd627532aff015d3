// RP2040 (RP2040 datasheet, revision B2), with 2 MiB of flash as on a Raspberry Pi Pico. Of its two cores the first.
#include <array>
#include <memory>
#include <utility>
#include <vector>

#include "firmware_iface/mcu/rp2040/adc.h"
#include "firmware_iface/mcu/rp2040/banked_ram.h"
#include "firmware_iface/mcu/rp2040/boot_rom.h"
#include "firmware_iface/mcu/rp2040/buses.h"
#include "firmware_iface/mcu/rp2040/clocks.h"
#include "firmware_iface/mcu/rp2040/dma.h"
#include "firmware_iface/mcu/rp2040/kept_blocks.h"
#include "firmware_iface/mcu/rp2040/pio.h"
#include "firmware_iface/mcu/rp2040/pwm.h"
#include "firmware_iface/mcu/rp2040/resets.h"
#include "firmware_iface/mcu/rp2040/sio.h"
#include "firmware_iface/mcu/rp2040/ssi.h"
#include "firmware_iface/mcu/rp2040/timer.h"
#include "firmware_iface/mcu/rp2040/uart.h"
#include "firmware_iface/mcu/rp2040/watchdog.h"
#include "firmware_iface/mcu/stm32/chip.h"
#include "firmware_iface/mcu/stm32/chip_parts.h"

namespace omnihil::mcu {
namespace {
using namespace rp2040;

template <class Kind>
Kind& add(Chip& chip, std::uint32_t base, std::unique_ptr<Kind> block) {
  return chip.add(base, kBlockBytes, std::move(block));
}

void add_system(Chip& chip, Resets& resets) {
  ChipContext& context = chip.context();
  resets.control(19, add(chip, 0x40000000, make_sysinfo(context)));
  resets.control(18, add(chip, 0x40004000, make_syscfg(context)));
  auto& xosc = add(chip, 0x40024000, std::make_unique<Xosc>(context));
  auto& rosc = add(chip, 0x40060000, std::make_unique<Rosc>(context));
  auto& pll_sys = add(chip, 0x40028000, std::make_unique<Pll>("PLL_SYS", context));
  auto& pll_usb = add(chip, 0x4002C000, std::make_unique<Pll>("PLL_USB", context));
  resets.control(12, pll_sys);
  resets.control(13, pll_usb);
  add(chip, 0x40008000, std::make_unique<Clocks>(xosc, rosc, pll_sys, pll_usb, context));
  add(chip, 0x40010000, std::make_unique<Psm>(context));
  resets.control(1, add(chip, 0x40030000, make_busctrl(context)));
  add(chip, 0x40064000, make_vreg_and_chip_reset(context));
  resets.control(20, add(chip, 0x4006C000, make_tbman(context)));
  auto& watchdog = add(chip, 0x40058000, std::make_unique<Watchdog>(context));
  resets.control(21, add(chip, 0x40054000, std::make_unique<RpTimer>(watchdog, context)));
}

void add_flash(Chip& chip, Resets& resets) {
  ChipContext& context = chip.context();
  auto flash = std::make_shared<FlashChip>(context.system);
  auto& pins = add(chip, 0x40018000, std::make_unique<IoQspi>(flash, context));
  resets.control(6, pins);
  resets.control(9, add(chip, 0x40020000, make_pads_qspi(context)));
  chip.add(0x14000000, 0x100, std::make_unique<XipControl>(context));
  chip.add(0x18000000, 0x100, std::make_unique<Ssi>(flash, pins, context));
  auto rom = std::make_shared<BootRom>(flash);
  chip.when_attached([rom](Machine& machine) { rom->install(machine); });
}

// No chip has anything at their addresses: their registers are PWM's.
Pwm& add_pwm(Chip& chip, Resets& resets, IoBank& io) {
  constexpr std::uint32_t kNowhere = 0x5FFC0000;
  std::vector<PwmSlice*> slices;
  for (unsigned i = 0; i < kSlices; ++i)
    slices.push_back(&chip.add(kNowhere + 16 * i, 4, std::make_unique<PwmSlice>(i, io, chip.context())));
  auto& pwm = add(chip, 0x40050000, std::make_unique<Pwm>(std::move(slices), chip.context()));
  resets.control(14, pwm);
  return pwm;
}

// Requests 0 to 15 are PIO's, four to send and four to receive of each; 24 to 31 PWM's wraps (§2.5.3.1).
void add_dma(Chip& chip, Resets& resets, IoBank& io) {
  ChipContext& context = chip.context();
  Pwm& pwm = add_pwm(chip, resets, io);
  Pio* const pios[] = {&add(chip, 0x50200000, std::make_unique<Pio>(0, io, context)),
                       &add(chip, 0x50300000, std::make_unique<Pio>(1, io, context))};
  resets.control(10, *pios[0]);
  resets.control(11, *pios[1]);
  auto& dma = add(chip, 0x50000000, std::make_unique<Dma>(dma_requests(), context));
  resets.control(2, dma);
  dma.on_wanted([pios = std::array{pios[0], pios[1]}, &pwm](unsigned request, bool wanted) {
    if (request < 16) pios[request / 8]->want(request % 4, request % 8 >= 4, wanted);
    if (request >= 24 && request < 32) pwm.want_wraps(request - 24, wanted);
  });
}

IoBank& add_pins(Chip& chip, Resets& resets) {
  ChipContext& context = chip.context();
  auto& io = add(chip, 0x40014000, std::make_unique<IoBank>(context));
  resets.control(5, io);
  resets.control(8, add(chip, 0x4001C000, std::make_unique<Pads>(io, context)));
  chip.add(0xD0000000, 0x200, std::make_unique<Sio>(io, context));
  return io;
}

void add_buses(Chip& chip, Resets& resets) {
  ChipContext& context = chip.context();
  resets.control(22, add(chip, 0x40034000, std::make_unique<RpUart>(0, 20, context)));
  resets.control(23, add(chip, 0x40038000, std::make_unique<RpUart>(1, 21, context)));
  resets.control(16, add(chip, 0x4003C000, make_spi_pl022(0, 18, context)));
  resets.control(17, add(chip, 0x40040000, make_spi_pl022(1, 19, context)));
  resets.control(3, add(chip, 0x40044000, make_i2c_dw(0, 23, context)));
  resets.control(4, add(chip, 0x40048000, make_i2c_dw(1, 24, context)));
  resets.control(0, add(chip, 0x4004C000, make_adc(context)));
}

void build(Chip& chip) {
  ChipContext& context = chip.context();
  auto owned = std::make_unique<Resets>(context);
  Resets& resets = *owned;
  add_system(chip, resets);
  add_flash(chip, resets);
  add_dma(chip, resets, add_pins(chip, resets));
  add_buses(chip, resets);
  chip.add(0x21000000, 0x40000, std::make_unique<BankedRam>(context));
  add_stored(chip, 0x4005C000, 0x4000, "RTC");
  add_stored(chip, 0x50100000, 0x10000, "USB DPRAM");
  add_stored(chip, 0x50110000, 0x4000, "USB");
  add(chip, 0x4000C000, std::move(owned));  // the last one: it holds the others from reset on
}
}  // namespace

const ChipSpec& chip_rp2040() {
  static const ChipSpec spec{
      .name = "rp2040",
      .variants = {},
      .core = kCortexM0Plus,
      .blocks = BlockFamily::kRp2040,
      .reset_hz = kRing_hz,
      .crystal_hz = 12e6,
      .boots_from_rom = true,
      .memories = {{.name = "flash", .base = kFlashBase, .bytes = kFlashBytes, .flash = true},
                   {.name = "sram", .base = 0x20000000, .bytes = 264 * 1024},
                   {.name = "boot ROM", .base = 0, .bytes = kRomBytes, .rom = true},
                   {.name = "XIP SRAM", .base = 0x15000000, .bytes = 16 * 1024}},
      .aliases = {{"flash", 0x11000000}, {"flash", 0x12000000}, {"flash", 0x13000000}},
      .used_low = {{kRomHeader, kRomHeaderBytes}},
      .build = build};
  return spec;
}

}  // namespace omnihil::mcu
