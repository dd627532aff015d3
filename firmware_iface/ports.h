// The two ports of the loop. Real or simulated on either side: the loop cannot tell.
//
//   WheelBus  what the firmware's bridges and encoders hang on: a simulated robot, or a real one
//   Firmware  what turns radio and sensors into bridge commands: host build, MCU image, board on the desk
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "firmware_iface/phase_period.h"
#include "firmware_iface/robot_io.h"

namespace omnihil {

class WheelBus {
 public:
  virtual ~WheelBus() = default;
  virtual void write(const RobotDrive& drive) = 0;  // held until the next write
  virtual RobotSensors read() = 0;                  // sampled at the instant of the call
};

// The shafts themselves, which no sensor shows as they are: for firmware whose sensors are emulated with it.
struct RobotShafts {
  double theta_rotor_rad[kWheels]{};
  double omega_rotor_rad_s[kWheels]{};
};

// What firmware that reports nothing itself reports: the shafts' own speeds at the wheels, the battery.
inline RobotFeedback feedback_of(const RobotShafts& exact, const RobotSensors& sensors, double gear_ratio) {
  RobotFeedback feedback{};
  feedback.now_us = sensors.now_us;
  feedback.battery_V = sensors.bus_voltage_V;
  for (std::size_t w = 0; w < kWheels; ++w)
    feedback.omega_wheel_rad_s[w] = exact.omega_rotor_rad_s[w] / gear_ratio;
  return feedback;
}

class FirmwareMemory;
class FirmwareChip;

class Firmware {
 public:
  virtual ~Firmware() = default;
  virtual std::string_view name() const = 0;
  // Id of the radio format whose frames `radio_receive` decodes itself; empty: it takes commands only.
  virtual std::string_view radio_format() const = 0;
  virtual std::int64_t control_period_ns() const = 0;
  virtual void command(const RobotCommand& command, std::int64_t now_ns) = 0;
  virtual void radio_receive(std::span<const std::uint8_t> frame, std::int64_t now_ns) = 0;
  // Copies the next waiting frame into `out`; returns its length, 0 when none waits.
  virtual std::size_t radio_transmit(std::span<std::uint8_t> out) = 0;
  virtual bool set_gains(const RobotGains& gains) = 0;
  virtual RobotGains gains() const = 0;
  // Right before each tick(), the same instant.
  virtual void shafts(const RobotShafts&) {}
  virtual RobotDrive tick(const RobotSensors& sensors) = 0;
  // A tick in parts, for whoever runs those of several robots side by side: begin_tick(), then run_part() of each once, in
  // any order or at once, then end_tick(), which gives what tick() would have given. Its motor_tick() may then run beside
  // other robots', too. 0: it has no parts.
  virtual std::size_t tick_parts() const { return 0; }
  virtual void begin_tick(const RobotSensors&) {}
  virtual void run_part(std::size_t) {}
  virtual RobotDrive end_tick() { return {}; }
  // What was said in parts and motor ticks is kept, and told to whoever listens here, robot by robot.
  virtual void tell() {}
  virtual RobotFeedback feedback() const = 0;
  // Whether it sets the legs of three-phase bridges itself: motor_tick() is then called once per PWM period,
  // and what it gives acts from the next period on.
  virtual bool drives_phases() const { return false; }
  virtual MotorDrive motor_tick(const MotorSensors&) { return {}; }
  // Why it no longer answers (crash, hang, lock-up), in words; empty: it does. Its wheels coast from then on.
  virtual std::string_view failure() const { return {}; }
  // Control periods that were due and did not run, where this side can count them (an emulated image).
  virtual std::uint64_t missed_control_periods() const { return 0; }
  // Its memory, for whoever looks at it between two calls (firmware_memory.h); null: it shows none.
  virtual FirmwareMemory* memory() { return nullptr; }
  // The chip that it runs on, for whoever breaks it (firmware_chip.h); null: there is none that can be broken.
  virtual FirmwareChip* chip() { return nullptr; }
  // What it has to say for itself after a run (counts of its wire, of its chip), a line each.
  virtual std::vector<std::string> report() const { return {}; }
  // Of one that drives phases: whether it runs within PWM periods. phase_period() is then called for each, in place of
  // motor_tick().
  virtual bool runs_in_phase_periods() const { return false; }
  virtual PhaseLegs phase_period(const PhasePeriod&) { return {}; }
};

}  // namespace omnihil
