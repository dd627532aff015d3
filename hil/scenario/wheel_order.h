// Which wheel turns at whose commanded speed.
//
//   WheelOrder order = wheel_order({20, 4, 33, 13}, {20, 33, 4, 13});
//   order.verdict;                                     // "wheels 1 and 2 are exchanged"
//
// Law: of the 24 orders p of the wheels the one with the least sum of (speed_w - wanted_p(w))^2. A wheel belongs to
// it if it is no further off than half of the smallest difference of two wanted speeds. Speeds are sizes: signs
// are looked at elsewhere.
#pragma once
#include <array>
#include <string>

#include "firmware_iface/robot_io.h"

namespace omnihil {

struct WheelOrder {
  int out_of_place = 0;  // wheels that turn at another's speed, or at nobody's
  std::string verdict;   // empty: each at its own
};

WheelOrder wheel_order(const std::array<double, kWheels>& speed_rad_s,
                       const std::array<double, kWheels>& wanted_rad_s);

}  // namespace omnihil
