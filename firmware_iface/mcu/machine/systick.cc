#include "firmware_iface/mcu/machine/systick.h"

namespace omnihil::mcu {
namespace {

enum Offset : std::uint32_t { kControl = 0, kLoad = 4, kValue = 8, kCalibration = 12 };
constexpr std::uint32_t kEnable = 1, kInterrupt = 2, kCountFlag = 1u << 16;

}  // namespace

std::uint32_t SysTick::value(Cycles now) const {
  if (!(control_ & kEnable)) return stopped_;
  const Cycles ticks = (now - zero_at_) / divider();
  return ticks == 0 || ticks > reload_ ? 0 : static_cast<std::uint32_t>(reload_ + 1 - ticks);
}

bool SysTick::advance(Cycles now) {
  if (!(control_ & kEnable) || load_ == 0 || now < zero_at_ + period()) return false;
  zero_at_ += period();
  reload_ = load_;
  zero_at_ += (now - zero_at_) / period() * period();
  reached_ = true;
  return control_ & kInterrupt;
}

Cycles SysTick::stable_until(std::uint32_t offset, Cycles now) const {
  const bool runs = (control_ & kEnable) != 0;
  if (offset == kValue) return runs ? 0 : kNever;
  if (offset != kControl) return kNever;
  if (reached_) return 0;  // reading takes COUNTFLAG away
  if (!runs || load_ == 0) return kNever;
  const Cycles zero = zero_at_ + period();
  return now < zero ? zero : 0;
}

std::uint32_t SysTick::read(std::uint32_t offset, Cycles now) {
  advance(now);
  switch (offset) {
    case kControl: {
      const std::uint32_t result = control_ | (reached_ ? kCountFlag : 0);
      reached_ = false;
      return result;
    }
    case kLoad:
      return load_;
    case kValue:
      return value(now);
    default:
      return 0xC0000000u;  // no reference clock, no calibration value
  }
}

void SysTick::write(std::uint32_t offset, std::uint32_t value_written, Cycles now) {
  advance(now);
  switch (offset) {
    case kControl: {
      const std::uint32_t left = value(now);
      control_ = value_written & 7;
      stopped_ = left;
      if (left == 0) reload_ = load_;
      zero_at_ = left == 0 ? now : now - (Cycles{reload_} + 1 - left) * divider();
      return;
    }
    case kLoad:
      load_ = value_written & 0xFFFFFF;
      if (value(now) == 0) reload_ = load_;
      return;
    case kValue:
      reached_ = false;
      stopped_ = 0;
      zero_at_ = now;
      reload_ = load_;
      return;
    default:
      return;
  }
}

}  // namespace omnihil::mcu
