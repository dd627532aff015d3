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
      port_(port),
      layout_(layout),
      odr_(layout == GpioLayout::kF1 ? f1::kOdr : kOdr) {
  next_event_is(kNever);
  GpioPort::reset();
}

void GpioPort::reset() {
  RegisterBlock::reset();
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

PinMode GpioPort::mode(unsigned pin) const {
  if (layout_ == GpioLayout::kModes) return static_cast<PinMode>(value(kModer) >> (2 * pin) & 3u);
  const std::uint32_t pair = value(f1::kCrl + 4 * (pin / 8)) >> (4 * (pin % 8)) & 15u;
  if ((pair & 3u) == 0) return pair == 0 ? PinMode::kAnalog : PinMode::kInput;
  return pair < 8 ? PinMode::kOutput : PinMode::kAlternate;
}

// F1: an input with a pull (CNF 2), which ODR says the direction of.
bool GpioPort::pulled_up(unsigned pin) const {
  if (layout_ == GpioLayout::kModes) return (value(kPupdr) >> (2 * pin) & 3u) == 1;
  const std::uint32_t pair = value(f1::kCrl + 4 * (pin / 8)) >> (4 * (pin % 8)) & 15u;
  return pair == 8 && output(pin);
}

// Which pins are outputs, and which have a pull-up: whenever what says so is written.
void GpioPort::note_modes() {
  outputs_ = pulled_ = 0;
  for (unsigned pin = 0; pin < 16; ++pin) {
    if (mode(pin) == PinMode::kOutput) outputs_ |= 1u << pin;
    if (pulled_up(pin)) pulled_ |= 1u << pin;
  }
}

std::uint32_t GpioPort::levels() const {
  const std::uint32_t idle = (driven_ & driven_high_) | (~driven_ & pulled_);
  return ((outputs_ & value(odr_)) | (~outputs_ & idle)) & 0xFFFFu;
}

bool GpioPort::level(unsigned pin) const { return (levels() >> pin & 1u) != 0; }

void GpioPort::changed() {
  const std::uint32_t levels_now = levels(), outputs = outputs_ & value(odr_);
  const std::uint32_t moved = levels_now ^ seen_levels_, given = outputs ^ seen_outputs_;
  seen_levels_ = levels_now;
  seen_outputs_ = outputs;
  if (moved != 0 && watcher_) watcher_(levels_now);
  for (unsigned pin = 0; pin < 16 && on_level_ && moved != 0; ++pin) {
    if ((moved >> pin & 1u) != 0) on_level_(port_, pin, (levels_now >> pin & 1u) != 0);
  }
  if (given == 0) return;
  for (const auto& [pin, listener] : listeners_) {
    if ((given >> pin & 1u) != 0) listener((outputs >> pin & 1u) != 0);
  }
}

void GpioPort::drive(unsigned pin, bool level) {
  driven_ |= 1u << pin;
  driven_high_ = (driven_high_ & ~(1u << pin)) | (level ? 1u << pin : 0u);
  changed();
}

void GpioPort::release(unsigned pin) {
  driven_ &= ~(1u << pin);
  changed();
}

void GpioPort::on_output(unsigned pin, std::function<void(bool)> listener) {
  listeners_.emplace_back(pin, std::move(listener));
}

std::uint32_t GpioPort::load(std::uint32_t offset) {
  return offset == (layout_ == GpioLayout::kF1 ? f1::kIdr : kIdr) ? levels() : value(offset);
}

void GpioPort::store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) {
  const bool old = layout_ == GpioLayout::kF1;
  std::uint32_t& odr = value(odr_);
  const std::uint32_t before = odr;
  const bool sets = offset == (old ? f1::kBsrr : kBsrr), clears = offset == (old ? f1::kBrr : kBrr);
  if (sets) {
    odr = (odr & ~(written >> 16)) | (written & 0xFFFFu);  // set wins over reset
  } else if (clears) {
    odr &= ~(written & 0xFFFFu);
  } else {
    keep(offset, written, lanes);
  }
  if (odr == before && (sets || clears)) return;
  const bool modes = old ? offset <= f1::kCrh : offset == kModer;
  if (old || modes || offset == kPupdr) note_modes();  // F1: a pull's direction is ODR's
  changed();
  if (!modes && (old || (offset != kAfrl && offset != kAfrl + 4))) return;
  for (const auto& listener : on_modes_) listener();
}

}  // namespace omnihil::mcu
