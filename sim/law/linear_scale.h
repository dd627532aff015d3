// How numbers of effects that are written for motors (N m, rad/s) are read on a linear axis (N, m/s): as a
// screw that moves 1 mm per rad would have them. A convention, for bounds, prior scales and start values
// alone.
//
//   double upper_N = row.upper * kForceOverTorque_per_m;   // 10 N m allowed, so 10 kN
#pragma once

namespace omnihil {

inline constexpr double kForceOverTorque_per_m = 1000.0;
inline constexpr double kTravelOverAngle_m_per_rad = 1e-3;

}  // namespace omnihil
