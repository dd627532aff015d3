#include "firmware_iface/mcu/stm32/adc/adc_status.h"

namespace omnihil::mcu {

void AdcWithStatus::reset() {
  Adc::reset();
  update();
}

void AdcWithStatus::data_was_read() {
  value(kSr) &= ~kEoc;
  update();
}

unsigned AdcWithStatus::length(Group group) const {
  if (group == Group::kInjected) return field(value(kJsqr), 20, 2) + 1;
  return bit(value(kCr1), 8) ? field(value(kSqr1), 20, 4) + 1 : 1;  // SCAN
}

unsigned AdcWithStatus::channel(Group group, unsigned place) const {
  if (group == Group::kInjected)  // the sequence ends at JSQ4
    return field(value(kJsqr), 5 * (3 - field(value(kJsqr), 20, 2) + place), 5);
  return field(value(kSqr3 - 4 * (place / 6)), 5 * (place % 6), 5);
}

double AdcWithStatus::sample_clocks(unsigned channel) const {
  return kind_.sample_clocks[channel < 10 ? field(value(kSmpr2), 3 * channel, 3)
                                          : field(value(kSmpr1), 3 * (channel % 10), 3)];
}

std::uint32_t AdcWithStatus::load(std::uint32_t offset) {
  if (offset == kDr) data_was_read();
  return value(offset);
}

void AdcWithStatus::store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) {
  registers_change();
  if (offset == kSr) {
    value(kSr) &= written | ~lanes;
    return update();
  }
  const std::uint32_t before = value(offset);
  keep(offset, written, lanes);
  if (offset == kCr2) {
    value(kCr2) &= ~kind_.orders;
    if (enabled()) {
      ordered(before, written);
    } else {
      stop(Group::kRegular);
      stop(Group::kInjected);
    }
  }
  if (offset == kCr1 || offset == kCr2) listen();
  update();
}

}  // namespace omnihil::mcu
