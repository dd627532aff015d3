// A robot's body as contacts see it: geometric centre, field frame.
#pragma once

namespace omnihil {

struct PlanarState {
  double x_m = 0, y_m = 0, yaw_rad = 0;
  double v_x_m_s = 0, v_y_m_s = 0, omega_rad_s = 0;
};

}  // namespace omnihil
