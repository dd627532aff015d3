#include "firmware_iface/mcu/stm32/gpio.h"

namespace omnihil::mcu {
namespace {
enum : std::uint16_t {
  kModer = 0x00,
  kPupdr = 0x0C,
  kIdr = 0x10,
  kOdr = 0x14,
  kBsrr = 0x18,
  kAfrl = 0x20,
  kBrr = 0x28
};

constexpr RegisterInfo kPort[] = {
    {kModer, "MODER"},     {0x04, "OTYPER", 0, 0xFFFF}, {0x08, "OSPEEDR"},
    {kPupdr, "PUPDR"},     {kIdr, "IDR", 0, 0},         {kOdr, "ODR", 0, 0xFFFF},
    {kBsrr, "BSRR", 0, 0}, {0x1C, "LCKR", 0, 0x1FFFF},  {kAfrl, "AFRL"},
    {0x24, "AFRH"},        {kBrr, "BRR", 0, 0},         {0x2C, "ASCR"}};
}  // namespace

GpioPort::GpioPort(unsigned port, ChipContext& context)
    : RegisterBlock(std::string("GPIO") + static_cast<char>('A' + port), context.system, kPort), port_(port) {
  next_event_is(kNever);
  GpioPort::reset();
}

void GpioPort::reset() {
  RegisterBlock::reset();
  if (port_ == 0) {  // SWDIO with pull-up, SWCLK with pull-down, JTDI with pull-up
    value(kModer) = 0xA8000000u;
    value(kPupdr) = 0x64000000u;
  } else if (port_ == 1) {
    value(kModer) = 0x00000280u;
    value(kPupdr) = 0x00000100u;
  }
  note_modes();
  changed();
}

unsigned GpioPort::alternate(unsigned pin) const {
  return value(kAfrl + 4 * (pin / 8)) >> (4 * (pin % 8)) & 15u;
}

// Which pins are outputs, and which have a pull-up: of MODER and PUPDR, whenever these are written.
void GpioPort::note_modes() {
  outputs_ = pulled_ = 0;
  for (unsigned pin = 0; pin < 16; ++pin) {
    if (mode(pin) == PinMode::kOutput) outputs_ |= 1u << pin;
    if ((value(kPupdr) >> (2 * pin) & 3u) == 1) pulled_ |= 1u << pin;
  }
}

std::uint32_t GpioPort::levels() const {
  const std::uint32_t idle = (driven_ & driven_high_) | (~driven_ & pulled_);
  return ((outputs_ & value(kOdr)) | (~outputs_ & idle)) & 0xFFFFu;
}

bool GpioPort::level(unsigned pin) const { return (levels() >> pin & 1u) != 0; }

void GpioPort::changed() {
  const std::uint32_t levels_now = levels(), outputs = outputs_ & value(kOdr);
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

std::uint32_t GpioPort::load(std::uint32_t offset) { return offset == kIdr ? levels() : value(offset); }

void GpioPort::store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) {
  std::uint32_t& odr = value(kOdr);
  const std::uint32_t before = odr;
  if (offset == kBsrr) {
    odr = (odr & ~(written >> 16)) | (written & 0xFFFFu);  // set wins over reset
  } else if (offset == kBrr) {
    odr &= ~(written & 0xFFFFu);
  } else {
    keep(offset, written, lanes);
    if (offset == kModer || offset == kPupdr) note_modes();
  }
  if (odr == before && (offset == kBsrr || offset == kBrr)) return;
  changed();
  if (offset != kModer && offset != kAfrl && offset != kAfrl + 4) return;
  for (const auto& listener : on_modes_) listener();
}

}  // namespace omnihil::mcu
