// Standard gravity, by definition (ISO 80000-3).
#pragma once

namespace omnihil {

inline constexpr double kGravity_m_s2 = 9.80665;

}  // namespace omnihil
