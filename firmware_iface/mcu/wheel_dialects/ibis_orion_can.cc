// ibis Orion's wheel bus: classic CAN, 1 Mbit/s, two motors per board.
//
// 0x100 + 2 board + motor: float rev/s of the motor, float unused, little endian; forgotten after 100 ms.
#include <cstring>

#include "firmware_iface/mcu/board/wheel_dialect.h"

namespace omnihil::mcu {
namespace {
constexpr double kTwoPi = 6.283185307179586;

void speak(int board, std::span<const double> omega_rotor_rad_s, WheelWords& out) {
  for (std::size_t m = 0; m < omega_rotor_rad_s.size(); ++m) {
    CanFrame frame;
    frame.id = 0x100u + 2u * static_cast<unsigned>(board) + static_cast<unsigned>(m);
    frame.bytes = 8;
    const auto speed_rev_s = static_cast<float>(omega_rotor_rad_s[m] / kTwoPi);
    std::memcpy(frame.data.data(), &speed_rev_s, sizeof speed_rev_s);
    out.can.push_back(frame);
  }
}
}  // namespace

const WheelDialect& wheel_dialect_ibis_orion_can() {
  static const WheelDialect dialect{"ibis-orion-can", "ibis Orion, CAN to its BLDC boards", true, 2'000'000,
                                    speak};
  return dialect;
}

}  // namespace omnihil::mcu
