// Movers (world.h) as numbers, for recordings: x, y, yaw, v_x, v_y, omega (field frame, SI), radius, front, height of each.
//
//   std::vector<double> v = mover_values(world.movers());
//   session.set_movers(movers_of(v));                       // v.size() is a multiple of kMoverValues
#pragma once
#include <span>
#include <vector>

#include "sim/field/world.h"

namespace omnihil {

inline constexpr std::size_t kMoverValues = 9;

inline std::vector<double> mover_values(std::span<const Mover> movers) {
  std::vector<double> values;
  for (const Mover& m : movers) {
    const PlanarState& s = m.state;
    const RobotOutline& o = m.outline;
    values.insert(values.end(), {s.x_m, s.y_m, s.yaw_rad, s.v_x_m_s, s.v_y_m_s, s.omega_rad_s, o.radius_m,
                                 o.front_m, o.height_m});
  }
  return values;
}

inline std::vector<Mover> movers_of(std::span<const double> v) {
  std::vector<Mover> movers;
  for (; v.size() >= kMoverValues; v = v.subspan(kMoverValues)) {
    Mover m;
    m.state = {v[0], v[1], v[2], v[3], v[4], v[5]};
    m.outline.radius_m = v[6];
    m.outline.front_m = v[7];
    m.outline.height_m = v[8];
    movers.push_back(m);
  }
  return movers;
}

}  // namespace omnihil
