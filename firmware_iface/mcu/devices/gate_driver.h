// What gate drivers on SPI have alike: 16-bit frames, an enable pin, a fault pin, watched switches and supply.
//
//   class Drv8323 final : public GateDriver { … };    // its registers, and what they make of a fault
//
// Law: a switch carries the motor's current; its drain-to-source voltage is that times rds_on, and above the level of
// the registers, at the begin of a step of the plant, it is an overcurrent. The supply is the bus. Pins: in `enable`
// (tied high where the board names none), out `fault` (low while there is one). Cannot represent: which of the six
// switches it was (phase A's upper is named), currents within a step, deglitch times, temperatures, the gates' own faults.
#pragma once
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <string_view>
#include <utility>

#include "firmware_iface/mcu/stm32/device.h"

namespace omnihil::mcu {

class GateDriver : public Device, public SpiDevice {
 public:
  explicit GateDriver(DeviceWorld world) : world_(std::move(world)) {}
  void reset() final { sleep_or_wake(); }
  SpiDevice* spi() final { return this; }
  std::span<const std::string_view> inputs() const final {
    static constexpr std::string_view kPins[] = {"enable"};
    return kPins;
  }
  std::span<const std::string_view> outputs() const final {
    static constexpr std::string_view kPins[] = {"fault"};
    return kPins;
  }
  void input(std::string_view, bool level) final {
    if (level == enabled_) return;
    enabled_ = level;
    sleep_or_wake();
  }
  void woken() final {
    awake_ = awake_ || enabled_;
    if (std::exchange(off_until_woken_, false)) retried();
    world_changed();
    settle();
  }
  void world_changed() final {
    if (!awake_) return;
    const double bus_V = world_.bus_voltage_V ? world_.bus_voltage_V(world_.now_ns()) : kPlenty_V;
    const double current_A = world_.motor_current_A ? world_.motor_current_A(world_.now_ns()) : 0.0;
    const bool starved = bus_V < undervoltage_V();
    const bool over = std::abs(current_A) * world_.setting("rds_on_ohm", 0.002) > overcurrent_V();
    const bool was = starved_;
    starved_ = starved;
    if (starved) undervoltage();
    if (over && drives_bridge()) overcurrent();
    if (starved || over || was) settle();
  }
  bool gates_bridge() const final { return true; }
  bool drives_bridge() const final { return awake_ && !starved_ && !off_until_woken_ && !held_off(); }

  void select(bool selected) final {
    if (!selected && bytes_ == 2) take(frame_);
    bytes_ = 0;
    frame_ = 0;
  }
  std::uint8_t exchange(std::uint8_t from_master) final {
    frame_ = static_cast<std::uint16_t>(frame_ << 8 | from_master);
    if (!awake_) return 0xFF;  // its output is off
    if (bytes_++ == 0) {
      answer_ = answer(static_cast<unsigned>(from_master >> 3));
      return static_cast<std::uint8_t>(answer_ >> 8);
    }
    return static_cast<std::uint8_t>(answer_);
  }

 protected:
  static constexpr double kPlenty_V = 24.0;
  // The answer's 16 bits, of a frame whose read bit and address are known.
  virtual std::uint16_t answer(unsigned header) = 0;
  virtual void take(std::uint16_t frame) = 0;
  virtual void to_defaults() = 0;
  virtual double overcurrent_V() const = 0;  // infinite: not watched
  virtual double undervoltage_V() const = 0;
  virtual void overcurrent() = 0;
  virtual void undervoltage() = 0;
  virtual void retried() {}
  virtual bool faulty() const = 0;    // what the fault pin says
  virtual bool held_off() const = 0;  // by a latched fault or by a register
  void settle() {
    output("fault", !faulty());
    if (std::exchange(drove_, drives_bridge()) != drives_bridge()) bridge_changed();
  }
  void off_for(std::int64_t ns) {
    off_until_woken_ = true;
    world_.wake_at(world_.now_ns() + ns);
  }

 private:
  // Registers are lost asleep. Ready 1 ms after the enable pin has risen (DRV8323 data sheet, t_WAKE; DRV8301: 5 to 10 ms
  // for the charge pump, SPI at once: taken as the same).
  void sleep_or_wake() {
    to_defaults();
    awake_ = starved_ = off_until_woken_ = false;
    world_.wake_at(enabled_ ? world_.now_ns() + 1'000'000 : kNoWake);
    settle();
  }

  DeviceWorld world_;
  bool enabled_ = true, awake_ = false, starved_ = false, off_until_woken_ = false, drove_ = false;
  unsigned bytes_ = 0;
  std::uint16_t frame_ = 0, answer_ = 0;
};

}  // namespace omnihil::mcu
