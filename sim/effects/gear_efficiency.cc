// Efficiency of a gear: a share of the power is lost, whichever way it flows.
#include <cmath>

#include "sim/law/effect_entry.h"

namespace omnihil {
namespace {

struct GearEfficiency {
  enum Param { kLoss };
  static constexpr EffectParam kParams[] = {
      {.name = "loss_fraction",
       .unit = "1",
       .typical = 0.06,  // one spur stage 0.03 to 0.10 (estimate)
       .lower = 0,
       .upper = 0.9,
       .prior_scale = 0.1,
       .what = "share of the power that goes in and does not come out; 1 less the efficiency",
       .how = "accelerate and brake with the same current: half the difference of the two accelerations over "
              "their mean"},
  };
  static constexpr EffectInfo kInfo{
      .id = "gear_efficiency",
      .title = "Gear efficiency",
      .equation = "tau_out = eta^sgn(P) N tau_motor, eta = 1 - loss, P = tau_motor omega",
      .source =
          "Pelchen, Schweiger, Otter, Modeling and Simulating the Efficiency of Gearboxes and of Planetary "
          "Gearboxes, 2nd International Modelica Conference, 2002",
      .cannot =
          "lose anything of a load that the motor does not oppose (load_dependent_friction does); leave out "
          "the torque that accelerates the rotor before the gear; depend on speed",
      .place = Place::kTorque,
      .twins = {"load_dependent_friction"},
      .reveals = "pairs of accelerating and braking at the same current: acceleration per ampere differs",
      .visible = "a share of the acceleration, from the speed's step in an encoder over a tenth of a second",
      .min_visible =
          [](const SensorSet& s) {
            // Slope of the speed over 0.1 s at 1000 rad/s2, angle to one count at n = 0.1 rate samples:
            // sigma_a = sqrt(720 / n) q / T^2 (parabola through n angles), of two slopes, to three sigma
            const double n = 0.1 * s.rate_Hz,
                         count_rad = 6.283185307179586 / s.counts_per_turn / std::sqrt(12.0);
            return 3.0 * std::sqrt(2.0) * std::sqrt(720.0 / n) * count_rad / (0.1 * 0.1) / 1000.0;
          },
      .claims = kDissipative | kOdd,
      .numerics = kReadsMotorTorque,
      .params = kParams,
      .plot = {.excitation = "steps", .x = "time", .y = "velocity", .from_s = 0.0, .to_s = 2.0},
  };

  template <typename T>
  static void apply(const T* p, T*, TorquePort<T>& port) {
    const T& loss = p[kLoss];
    const T driven = loss / (1.0 - loss);  // 1 / eta - 1
    // Turning with the motor's torque (1 - eta) |tau| is lost, turning against it (1 / eta - 1) |tau|.
    if (value_of(port.tau_motor_Nm) >= 0.0) {
      port.friction_positive_Nm += loss * port.tau_motor_Nm;
      port.friction_negative_Nm += driven * port.tau_motor_Nm;
    } else {
      port.friction_positive_Nm -= driven * port.tau_motor_Nm;
      port.friction_negative_Nm -= loss * port.tau_motor_Nm;
    }
  }
};

}  // namespace

OMNIHIL_EFFECT(gear_efficiency, GearEfficiency)

}  // namespace omnihil
