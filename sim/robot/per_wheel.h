// Numbers of a robot's wheels: room for as many as a robot may have, filled up to how many this one has.
//
//   PerWheel<double> omega_wheel_rad_s{};                                    // of a robot of three: the first three count
//   each_wheel(model.wheels, [&](std::size_t i) { omega_wheel_rad_s[i] = 10.0; });
//
// What firmware and radio know are four wheels (kWheels, firmware_iface/robot_io.h); models, plant, virtual bench and
// identification take two to kMaxWheels.
#pragma once
#include <array>
#include <cstddef>

namespace omnihil {

inline constexpr std::size_t kMinWheels = 2, kMaxWheels = 6;

template <typename T>
using PerWheel = std::array<T, kMaxWheels>;

// f(i) for each of `count` wheels. Four are what most robots have: the compiler knows their number, and unrolls.
template <typename F>
[[gnu::always_inline]] inline void each_wheel(std::size_t count, F&& f) {
  if (count == 4) {
    for (std::size_t i = 0; i < 4; ++i) f(i);
  } else {
    for (std::size_t i = 0; i < count; ++i) f(i);
  }
}

}  // namespace omnihil
