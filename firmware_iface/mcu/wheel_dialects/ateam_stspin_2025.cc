// SSL A-Team's motor UART of 2025: 2 Mbaud 8E1, one 52-byte struct per burst, one wheel per board, 100 Hz.
//
// Layout (their stspin.h): 0 type, 21h motion; 8 flags, bit 1 telemetry on; 12 control type, 1 velocity; 16
// float speed of the motor in rad/s, little endian; the rest zero. CRC fields are zero and unchecked. After
// 100 ms without a packet the board resets itself.
#include <cstring>

#include "firmware_iface/mcu/board/wheel_dialect.h"

namespace omnihil::mcu {
namespace {
constexpr std::size_t kCommandBytes = 52;

void speak(int, std::span<const double> omega_rotor_rad_s, WheelWords& out) {
  out.serial.assign(kCommandBytes, 0);
  out.serial[0] = 0x21;
  out.serial[8] = 0x02;
  out.serial[12] = 1;
  const auto setpoint_rad_s = static_cast<float>(omega_rotor_rad_s.empty() ? 0.0 : omega_rotor_rad_s[0]);
  std::memcpy(out.serial.data() + 16, &setpoint_rad_s, sizeof setpoint_rad_s);
}
}  // namespace

const WheelDialect& wheel_dialect_ateam_stspin_2025() {
  static const WheelDialect dialect{"ateam-stspin-2025", "SSL A-Team, motor UART of 2025", false, 10'000'000,
                                    speak};
  return dialect;
}

}  // namespace omnihil::mcu
