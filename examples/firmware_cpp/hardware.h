// The hardware layer of this firmware: what its drivers read and write. On the board these are registers; on
// the bench they are this struct, and bench.cc copies between it and the bench. Nothing else of the firmware
// changes.
#pragma once
#include <array>
#include <cstdint>

namespace example {

constexpr int kWheelCount = 4;
constexpr int kPwmTop = 4200;  // auto-reload of the PWM timer: 20 kHz at 84 MHz

struct Hardware {
  std::array<std::uint16_t, kWheelCount> encoder_timer{};  // 16-bit timers in encoder mode: they wrap
  std::array<std::int16_t, kWheelCount> pwm_compare{};     // -kPwmTop .. kPwmTop
  std::uint16_t battery_mV = 0;
  bool bridges_on = false;
};

}  // namespace example
