// From timer channels and pins to what a motor's bridge does: now, and on the mean of an interval.
//
//   MotorWire wire(entry, chip, [&] { return machine.to_ns(machine.now()); });
//   wire.begin(t0_ns);  machine.run_until_ns(t1_ns);
//   BridgeDrive mean = wire.end(t1_ns);  // duty weighted by the time it was held, changes at their instants
//
// One channel and a direction pin: duty with that sign. One channel alone: both halves in turn, 2 d - 1. Two
// channels: the difference of the halves. Three: phases. With gates of the lower switches on pins of their
// own (pwm_low) a leg is what both pins say, a pin that is off being held low by its resistor; without, the
// driver makes the lower switch's signal of the one input. The dead time that the timer cuts off both is left
// to the model's bridge, which has its own. The brake pin, low, closes all lower switches: both ends at the bus's
// minus. A channel that is off (no MOE, not enabled) leaves the motor to
// coast; so does the enable pin when low,
// and a gate driver that has switched off. Cannot represent: pins that are not set to their timer (their mode
// is not looked at), both gates of a leg high at once.
#pragma once
#include <array>
#include <functional>
#include <vector>

#include "firmware_iface/mcu/board/board_spec.h"
#include "firmware_iface/mcu/board/leg_means.h"
#include "firmware_iface/mcu/stm32/chip.h"
#include "firmware_iface/mcu/stm32/device.h"
#include "firmware_iface/mcu/stm32/timer/pwm_outputs.h"
#include "firmware_iface/robot_io.h"

namespace omnihil::mcu {

struct BridgeDrive {
  bool driven = false;      // else: coast
  double duty_ratio = 0.0;  // -1 .. 1 of the bus voltage
};

// What carries a phase's current at an instant, dead time left out; diodes: the lower one what goes into the motor, the
// upper one what comes out of it.
enum class CurrentPath : std::uint8_t { kDiodes, kUpper, kLower };

class MotorWire {
 public:
  MotorWire(const MotorEntry& entry, Chip& chip, std::function<std::int64_t()> now_ns);
  MotorWire(const MotorWire&) = delete;

  const MotorEntry& entry() const { return entry_; }
  bool phases() const { return phases_; }
  void begin(std::int64_t at_ns);
  BridgeDrive end(std::int64_t at_ns);
  BridgeDrive now() const {
    bool pwm;
    return work_out(pwm);
  }
  // The bridge's gate driver; until it lets the switches go, the motor coasts.
  void gate_by(Device& driver);
  // The legs of a three-phase bridge, as omnihil_motor_drive has them; from begin() to this instant on the mean, and then.
  void legs(std::uint32_t (&leg)[kLegs], double (&duty_ratio)[kLegs]) const;
  BridgeLegs end_legs(std::int64_t at_ns) { return means_.end(at_ns); }
  const BridgeLegs& held_legs() const { return means_.held(); }
  CurrentPath path(std::size_t phase) const;  // now

 private:
  void changed(std::int64_t at_ns);
  void legs_changed(std::int64_t at_ns);
  BridgeLegs look_at_legs();
  bool legs_stay() const;
  std::uint32_t leg_pins_version() const;
  BridgeDrive work_out(bool& pwm) const;  // pwm: of pins that are PWM alone
  void hold();
  bool still() const;
  void pass(std::int64_t at_ns);
  TimerPin pin(PwmOutputs& timer, const ChannelName& channel) const;
  bool level(PwmOutputs& timer, const ChannelName& channel) const {
    return timer.level(channel.channel, channel.complement) != entry_.inverted;
  }
  TimerPin pin(std::size_t i) const { return pin(*timers_[i], entry_.pwm[i]); }
  bool enabled() const {
    return (!enable_ || enable_->output(entry_.enable->pin)) && (!driver_ || driver_->drives_bridge());
  }
  bool braked() const { return brake_ != nullptr && !brake_->output(entry_.brake->pin); }
  bool directed() const { return direction_ != nullptr && direction_->output(entry_.direction->pin); }
  std::uint32_t pins_version() const {
    return timers_.size() < 2 ? timers_[0]->pins_version()
                              : timers_[0]->pins_version() + timers_[1]->pins_version();
  }

  MotorEntry entry_;
  std::function<std::int64_t()> now_ns_;
  std::vector<PwmOutputs*> timers_, low_timers_;
  PinBank *direction_ = nullptr, *enable_ = nullptr, *brake_ = nullptr;
  const Device* driver_ = nullptr;
  bool phases_ = false;
  BridgeDrive held_;
  bool held_pwm_ = false, held_directed_ = false;  // held_ is of PWM pins alone; of this direction ...
  std::uint32_t held_version_ = 0;                 // ... and of this version of them
  std::int64_t since_ns_ = 0;
  double driven_ns_ = 0.0, duty_ns_ = 0.0;
  // Of phases; what held_legs() are depends on this version of pins that stay, and on these switches.
  LegMeans means_;
  std::vector<PwmOutputs*> leg_timers_;
  bool legs_known_ = false, legs_enabled_ = false, legs_braked_ = false;
  std::uint32_t legs_version_ = 0;
};

}  // namespace omnihil::mcu
