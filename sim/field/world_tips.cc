// When a robot that is a free body tips over: its centre of mass over the edge of its wheels.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "sim/field/world_impl.h"

namespace omnihil {
namespace {

// The nearest edge of the wheels' polygon to the centre of mass, from above.
double distance_to_edge_m(const RobotModel& model) {
  std::vector<double> angle(model.wheel_angle_rad.begin(),
                            model.wheel_angle_rad.begin() + static_cast<std::ptrdiff_t>(model.wheels));
  for (double& a : angle) a = std::remainder(a, 2.0 * std::numbers::pi);
  std::ranges::sort(angle);
  double least_m = model.wheel_center_radius_m;
  for (std::size_t i = 0; i < angle.size(); ++i) {
    const double from = angle[i];
    const double to = i + 1 < angle.size() ? angle[i + 1] : angle[0] + 2.0 * std::numbers::pi;
    const double middle = 0.5 * (from + to);
    // The edge's outward normal points along `middle`, r cos(half the gap) from the wheels' centre.
    const double out_m = model.wheel_center_radius_m * std::cos(0.5 * (to - from));
    const double com_m =
        model.center_of_mass_x_m * std::cos(middle) + model.center_of_mass_y_m * std::sin(middle);
    least_m = std::min(least_m, out_m - com_m);
  }
  return std::max(0.0, least_m);
}

}  // namespace

double tipping_angle_rad(const RobotModel& model) {
  return model.center_of_mass_height_m > 0.0
             ? std::atan2(distance_to_edge_m(model), model.center_of_mass_height_m)
             : 0.5 * std::numbers::pi;
}

void World::Impl::look_for_tips() {
  if (plant.options().physics != Physics::kSimbodyFree) return;  // others refuse a robot that could
  for (std::size_t n = 0; n < parts.size(); ++n) {
    const double tilt_rad = plant.tilt_rad(static_cast<int>(n));
    if (tipped[n] && tilt_rad > 0.5 * tip_rad[n]) continue;  // the same fall
    const bool tips = tilt_rad > tip_rad[n];
    if (tips) {
      const PlanarState s = plant.planar_state(static_cast<int>(n));
      report(WorldEventKind::kTip, static_cast<int>(n), -1, s.x_m, s.y_m, tilt_rad);
    }
    tipped[n] = tips;
  }
}

}  // namespace omnihil
