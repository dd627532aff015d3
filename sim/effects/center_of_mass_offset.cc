// A centre of mass that is not where the model has it.
#include <cmath>

#include "sim/law/effect_entry.h"

namespace omnihil {
namespace {

struct CenterOfMassOffset {
  enum Param { kX, kY };
  static constexpr EffectParam kParams[] = {
      {.name = "x_m",
       .unit = "m",
       .typical = 0.01,
       .lower = -0.05,
       .upper = 0.05,
       .prior_scale = 0.01,
       .what = "forward, on top of the model's",
       .how = "four scales under the wheels; or wheel currents while braking and accelerating along x"},
      {.name = "y_m",
       .unit = "m",
       .typical = -0.005,
       .lower = -0.05,
       .upper = 0.05,
       .prior_scale = 0.01,
       .what = "to the left, on top of the model's",
       .how = "as x_m, along y"},
  };
  static constexpr EffectInfo kInfo{
      .id = "center_of_mass_offset",
      .title = "Offset of the centre of mass",
      .equation = "c = c_model + (x, y); I about the geometric centre = I_model + m (c^2 - c_model^2)",
      .source = "Huygens and Steiner (parallel axes); statics of a body on four equal springs",
      .cannot = "a centre of mass that moves while driving, a change of its height",
      .place = Place::kBody,
      .twins = {"motor_mismatch"},
      .reveals =
          "hard acceleration along +x, -x, +y, -y: the robot yaws, and the yaw's sign follows the "
          "acceleration's; currents differ between wheels",
      .visible = "three times the gyro's noise (0.01 rad/s) after a tenth of a second at 3 m/s2",
      .min_visible =
          [](const SensorSet& s) {
            // alpha = m a c / I: 2.4 kg, 3 m/s2, 0.012 kg m2; gyro noise 0.01 rad/s
            return 3.0 * 0.01 / (2.4 * 3.0 / 0.012 * 0.1) / std::sqrt(0.1 * s.rate_Hz);
          },
      .rigs = kOnRobot,
      .params = kParams,
  };

  template <typename T>
  static void apply(const T* p, T*, BodyPort<T>& port) {
    const T x = port.center_of_mass_x_m + p[kX], y = port.center_of_mass_y_m + p[kY];
    // I += m (c^2 - c_model^2)
    port.yaw_inertia_kg_m2 +=
        port.mass_kg * (x * x + y * y - port.center_of_mass_x_m * port.center_of_mass_x_m -
                        port.center_of_mass_y_m * port.center_of_mass_y_m);
    port.center_of_mass_x_m = x;
    port.center_of_mass_y_m = y;
  }
};

}  // namespace

OMNIHIL_EFFECT(center_of_mass_offset, CenterOfMassOffset)

}  // namespace omnihil
