#include "firmware_iface/mcu/board/device_alarm.h"

#include <algorithm>
#include <utility>

#include "firmware_iface/mcu/stm32/device.h"

namespace omnihil::mcu {

DeviceAlarm::DeviceAlarm(const std::string& device, System& system, std::function<void()> ring)
    : Peripheral("alarm of " + device), system_(system), ring_(std::move(ring)), at_ns_(kNoWake) {
  next_event_is(next_);
}

void DeviceAlarm::set(std::int64_t at_ns) {
  at_ns_ = at_ns;
  const Cycles next = at_ns == kNoWake
                          ? kNever
                          : std::max(system_.from_ns(at_ns), system_.now() + 1);  // never within an access
  if (next == next_) return;
  next_ = next;
  system_.reschedule();
}

void DeviceAlarm::clock_changed() { set(at_ns_); }

void DeviceAlarm::run_events() {
  if (next_ > system_.now()) return;
  next_ = kNever;
  at_ns_ = kNoWake;
  ring_();
}

}  // namespace omnihil::mcu
