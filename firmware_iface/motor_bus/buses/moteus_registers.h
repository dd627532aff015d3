// Registers and modes of a moteus, said once for the simulated device and for the host that asks one.
//
//   const CommandRegister* known = find_command_register(0x021);     // null: no register of a command
//   command.*known->value = access.value.scaled(known->scale);
//
// Source: mjbots moteus docs/protocol/registers.md.
#pragma once
#include <cstdint>
#include <limits>

#include "firmware_iface/motor_bus/multiplex.h"

namespace omnihil::moteus {

inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

enum Mode : std::int64_t {
  kStopped = 0,
  kFault = 1,
  kVoltageDq = 8,
  kCurrent = 9,
  kPosition = 10,
  kTimeout = 11,
  kZeroVelocity = 12,
  kBrake = 15,
};

// Where a host begins to read and write.
inline constexpr std::uint32_t kModeRegister = 0x000, kMeasuredRegisters = 0x001, kBusRegister = 0x00D,
                               kFaultRegister = 0x00F, kVoltageRegister = 0x01B, kPositionRegister = 0x020;
inline constexpr std::uint8_t kMeasuredCount = 4;  // position, velocity, torque, Q current

inline constexpr RegisterScale kPositionScale{0.01, 1e-4, 1e-5}, kVelocityScale{0.1, 0.00025, 1e-5},
    kTorqueScale{0.5, 0.01, 0.001}, kCurrentScale{1.0, 0.1, 0.001}, kVoltageScale{0.5, 0.1, 0.001},
    kTemperatureScale{1.0, 0.1, 0.001}, kTimeScale{0.01, 0.001, 1e-6}, kAccelScale{0.05, 0.001, 1e-5},
    kPowerScale{10.0, 0.05, 1e-4}, kRatioScale{1.0 / 127.0, 1.0 / 32767.0, 1.0 / 2147483647.0};

// What the registers of one command hold; a written mode begins with these.
struct Command {
  Mode mode = kStopped;
  double position = 0, velocity = 0, torque_ff = 0, kp_scale = 1, kd_scale = 1, max_torque = kNaN;
  double timeout_s = 0, velocity_limit = kNaN, accel_limit = kNaN;
  double q_voltage = 0, q_current = 0;
};

// A command register: where its value is kept, and how it is scaled.
struct CommandRegister {
  std::uint32_t reg;
  double Command::*value;
  RegisterScale scale;
};
inline constexpr CommandRegister kCommandRegisters[] = {
    {0x01B, &Command::q_voltage, kVoltageScale}, {0x01C, &Command::q_current, kCurrentScale},
    {0x020, &Command::position, kPositionScale}, {0x021, &Command::velocity, kVelocityScale},
    {0x022, &Command::torque_ff, kTorqueScale},  {0x023, &Command::kp_scale, kRatioScale},
    {0x024, &Command::kd_scale, kRatioScale},    {0x025, &Command::max_torque, kTorqueScale},
    {0x027, &Command::timeout_s, kTimeScale},    {0x028, &Command::velocity_limit, kVelocityScale},
    {0x029, &Command::accel_limit, kAccelScale},
};

inline const CommandRegister* find_command_register(std::uint32_t reg) {
  for (const CommandRegister& each : kCommandRegisters) {
    if (each.reg == reg) return &each;
  }
  return nullptr;
}

}  // namespace omnihil::moteus
