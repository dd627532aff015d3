// How a robot's main board talks to the boards that drive its wheels: what it says to one of them, each period.
//
//   const WheelDialect* dialect = find_wheel_dialect("ateam-stspin-2025");
//   WheelWords words;
//   dialect->speak(0, motor_speeds_rad_s, words);      // bytes for its serial port, frames for its CAN
//
// Adding one is adding a file to firmware_iface/mcu/wheel_dialects/ that defines
// `const WheelDialect& wheel_dialect_STEM()`. Cannot represent: what such boards answer (it is drained and
// dropped), arbitration on a bus that boards share.
#pragma once
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "firmware_iface/mcu/stm32/can.h"

namespace omnihil::mcu {

struct WheelWords {
  std::vector<std::uint8_t> serial;  // one burst
  std::vector<CanFrame> can;
};

struct WheelDialect {
  std::string_view name;
  std::string_view what;       // one line for people
  bool on_can = false;         // else on a serial port
  std::int64_t period_ns = 0;  // of the main board
  void (*speak)(int board, std::span<const double> omega_rotor_rad_s, WheelWords& out) = nullptr;
};

std::span<const WheelDialect* const> all_wheel_dialects();
const WheelDialect* find_wheel_dialect(std::string_view name);

}  // namespace omnihil::mcu
