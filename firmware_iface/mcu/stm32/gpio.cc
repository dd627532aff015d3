#include "firmware_iface/mcu/stm32/gpio.h"

namespace omnihil::mcu {
namespace {
using Offset = std::uint16_t;
constexpr Offset kModer = 0x00, kPupdr = 0x0C, kIdr = 0x10, kOdr = 0x14, kBsrr = 0x18, kAfrl = 0x20,
                 kBrr = 0x28;
constexpr RegisterInfo kPort[] = {
    {kModer, "MODER"},     {0x04, "OTYPER", 0, 0xFFFF}, {0x08, "OSPEEDR"},
    {kPupdr, "PUPDR"},     {kIdr, "IDR", 0, 0},         {kOdr, "ODR", 0, 0xFFFF},
    {kBsrr, "BSRR", 0, 0}, {0x1C, "LCKR", 0, 0x1FFFF},  {kAfrl, "AFRL"},
    {0x24, "AFRH"},        {kBrr, "BRR", 0, 0},         {0x2C, "ASCR"}};

// F1: four bits a pin in CRL and CRH, MODE 1:0 and CNF 3:2.
namespace f1 {
constexpr Offset kCrl = 0x00, kCrh = 0x04, kIdr = 0x08, kOdr = 0x0C, kBsrr = 0x10, kBrr = 0x14;
}
constexpr RegisterInfo kPortOfF1[] = {{f1::kCrl, "CRL", 0x44444444}, {f1::kCrh, "CRH", 0x44444444},
                                      {f1::kIdr, "IDR", 0, 0},       {f1::kOdr, "ODR", 0, 0xFFFF},
                                      {f1::kBsrr, "BSRR", 0, 0},     {f1::kBrr, "BRR", 0, 0},
                                      {0x18, "LCKR", 0, 0x1FFFF}};
}  // namespace

GpioPort::GpioPort(unsigned port, ChipContext& context, GpioLayout layout)
    : RegisterBlock(std::string("GPIO") + static_cast<char>('A' + port), context.system,
                    layout == GpioLayout::kF1 ? std::span<const RegisterInfo>(kPortOfF1) : kPort),
      PinBank(static_cast<char>('A' + port), 16),
      port_(port),
      layout_(layout) {
  next_event_is(kNever);
  GpioPort::reset();
}

void GpioPort::reset() {
  RegisterBlock::reset();
  odr_ = 0;
  if (layout_ == GpioLayout::kF1) {
    // floating inputs all, but the debug port has its pins until AFIO takes them from it
  } else if (port_ == 0) {  // SWDIO with pull-up, SWCLK with pull-down, JTDI with pull-up
    value(kModer) = 0xA8000000u;
    value(kPupdr) = 0x64000000u;
  } else if (port_ == 1) {
    value(kModer) = 0x00000280u;
    value(kPupdr) = 0x00000100u;
  }
  note_modes();
  changed();
}

// What each pin is, which are outputs and which have a pull-up: whenever what says so is written.
void GpioPort::note_modes() {
  if (layout_ == GpioLayout::kModes) modes_ = value(kModer);
  outputs_ = pulled_ = 0;
  for (unsigned pin = 0; pin < 16; ++pin) {
    bool up = false;
    if (layout_ == GpioLayout::kModes) {
      up = (value(kPupdr) >> (2 * pin) & 3u) == 1;
    } else {
      const std::uint32_t four = value(f1::kCrl + 4 * (pin / 8)) >> (4 * (pin % 8)) & 15u;
      const PinMode mode = (four & 3u) == 0 ? (four == 0 ? PinMode::kAnalog : PinMode::kInput)
                           : four < 8       ? PinMode::kOutput
                                            : PinMode::kAlternate;
      modes_ = (modes_ & ~(std::uint64_t{3} << (2 * pin))) | std::uint64_t{static_cast<unsigned>(mode)}
                                                                 << (2 * pin);
      up = four == 8 && output(pin);  // an input with a pull, which ODR says the direction of
    }
    if (mode(pin) == PinMode::kOutput) outputs_ |= 1u << pin;
    if (up) pulled_ |= 1u << pin;
  }
}

std::uint32_t GpioPort::load(std::uint32_t offset) {
  const bool old = layout_ == GpioLayout::kF1;
  if (offset == (old ? f1::kIdr : kIdr)) return levels();
  return offset == (old ? f1::kOdr : kOdr) ? odr_ : value(offset);
}

void GpioPort::store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) {
  if (layout_ == GpioLayout::kF1) [[unlikely]]
    return store_f1(offset, written, lanes);
  const std::uint32_t before = odr_;
  if (offset == kBsrr) {
    odr_ = (odr_ & ~(written >> 16)) | (written & 0xFFFFu);  // set wins over reset
  } else if (offset == kBrr) {
    odr_ &= ~(written & 0xFFFFu);
  } else if (offset == kOdr) {
    odr_ = ((odr_ & ~lanes) | (written & lanes)) & 0xFFFFu;
  } else {
    keep(offset, written, lanes);
    if (offset == kModer || offset == kPupdr) note_modes();
  }
  if (odr_ == before && (offset == kBsrr || offset == kBrr)) return;
  changed();
  if (offset != kModer && offset != kAfrl && offset != kAfrl + 4) return;
  modes_changed();
}

[[gnu::noinline]] void GpioPort::store_f1(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) {
  if (offset == f1::kBsrr) {
    odr_ = (odr_ & ~(written >> 16)) | (written & 0xFFFFu);
  } else if (offset == f1::kBrr) {
    odr_ &= ~(written & 0xFFFFu);
  } else if (offset == f1::kOdr) {
    odr_ = ((odr_ & ~lanes) | (written & lanes)) & 0xFFFFu;
  } else {
    keep(offset, written, lanes);
  }
  note_modes();  // pulls follow ODR
  changed();
  if (offset != f1::kCrl && offset != f1::kCrh) return;
  modes_changed();
}

}  // namespace omnihil::mcu
