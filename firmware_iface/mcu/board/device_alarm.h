// Wakes a device of a board at the instant that it asked for, between two instructions.
//
//   DeviceAlarm alarm("radio", system, [&] { ++rung; });
//   alarm.set(system.to_ns(system.now()) + 40'000);     // the last call counts; kNoWake takes it back
//
// It outlives resets of the chip, as the device does.
#pragma once
#include <functional>
#include <string>

#include "firmware_iface/mcu/peripheral.h"

namespace omnihil::mcu {

class DeviceAlarm final : public Peripheral {
 public:
  DeviceAlarm(const std::string& device, System& system, std::function<void()> ring);
  void set(std::int64_t at_ns);
  void reset() override {}
  std::uint32_t read(std::uint32_t, unsigned) override { return 0; }
  void write(std::uint32_t, unsigned, std::uint32_t) override {}
  void run_events() override;
  void clock_changed() override;

 private:
  System& system_;
  std::function<void()> ring_;
  std::int64_t at_ns_;
  Cycles next_ = kNever;
};

}  // namespace omnihil::mcu
