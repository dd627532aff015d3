// The ball: what it is, its state, and how it moves when nothing but the carpet and the air touches it.
//
//   BallParams params;                                     // golf ball, 43 mm, 46 g
//   BallState ball = resting_ball(params, 1.0, 0.5);
//   ball.velocity = {3.0, 0.0, 0.0};                       // kicked flat: slides, then rolls
//   advance_ball(params, carpet, ball, 0.0005);
//
// On the carpet, u = v + w x (-r z) the slip of its lowest point:
//   sliding (u != 0)   dv/dt = -mu_s g u/|u|,  du/dt = -(1 + m r^2 / I) mu_s g u/|u|: u keeps its direction; what
//                      slides first rolls at 1 / (1 + I / (m r^2)) of its speed, 5/7 for a full sphere
//   rolling (u = 0)    dv/dt = -mu_r g (e - p n),  e = v/|v|: rolling resistance; p n the carpet's nap (below)
//   about the vertical dw_z/dt = -(m g r / I) mu_spin sign(w_z)
// In the air: gravity, drag 1/2 rho c_d A |v| v, and lift c_l rho A r w x v (Magnus) where asked for. Drag acts on the
// carpet too. Landing: impulse with restitution e and Coulomb friction mu_s, at most what stops the slip; a bounce that
// would rise less than kLeastBounce_m is none.
// The parts are exact for held coefficients (constant deceleration, parabola); drag is split off, exact by itself.
// Nap: carpets roll further along it than against it, and across it a rolling ball is turned. With p < 1 the carpet's
// force never does work on the ball: (e - p n) . e >= 1 - p > 0.
// Source: Hertz-free rolling as in Cross 2002, Am. J. Phys. 70 (11), "Grip-slip behavior of a bouncing ball", and the
// two-phase ball of the league's teams. Cannot: a ball that sinks into the pile, uneven floors, oblique spin losses.
#pragma once
#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "sim/contact/gravity.h"

namespace omnihil {

using Vector3 = Eigen::Vector3d;

inline constexpr double kLeastBounce_m = 1e-4;  // a tenth of a millimetre: less than the pile's height

struct BallParams {
  double radius_m = 0.0215;        // rules: 43 mm
  double mass_kg = 0.046;          // rules: 46 g
  double inertia_over_m_r2 = 0.4;  // full sphere
  double drag_coefficient =
      0.4;  // guess, +-30 %: between a smooth sphere's 0.5 and a flying golf ball's 0.25
  double lift_coefficient = 0.0;  // Magnus; 0: none
  double air_density_kg_m3 = 1.2;
  double inertia_kg_m2() const { return inertia_over_m_r2 * mass_kg * radius_m * radius_m; }
};

// A rectangle of the field with other friction: a seam, a repaired or a wet place.
struct CarpetPatch {
  double x_from_m = 0, x_to_m = 0, y_from_m = 0, y_to_m = 0;
  double sliding_ratio = 1.0, rolling_ratio = 1.0;  // times the carpet's
};

struct Carpet {
  double sliding_friction = 0.35;     // guess, +-20 %: 3 to 4 m/s2 in the league's ball models
  double rolling_resistance = 0.027;  // guess, +-30 %: 0.26 m/s2 in the league's ball models
  double spinning_friction = 0.003;   // about the vertical, in radii: guess, +-50 %
  double restitution = 0.55;          // landing on it: guess, +-20 %
  double nap_ratio = 0.0;             // p, 0 to below 1
  double nap_rad = 0.0;               // where the nap points, from field x towards y
  std::vector<CarpetPatch> patches;

  struct Here {
    double sliding_friction, rolling_resistance;
  };
  Here at(double x_m, double y_m) const;
};

// What is out of bounds, a line each.
std::vector<std::string> carpet_problems(const Carpet& carpet);

struct BallState {
  Vector3 position{0, 0, 0};  // of its centre, field frame, m
  Vector3 velocity{0, 0, 0};  // m/s
  Vector3 spin{0, 0, 0};      // rad/s
  bool on_floor = true;       // z = radius, no vertical speed
};

BallState resting_ball(const BallParams& params, double x_m, double y_m);
Vector3 floor_slip(const BallParams& params, const BallState& ball);  // of its lowest point, m/s
double ball_energy_J(const BallParams& params,
                     const BallState& ball);  // kinetic, and potential above the floor

// Returns how often it landed within the step.
int advance_ball(const BallParams& params, const Carpet& carpet, BallState& ball, double step_s);

}  // namespace omnihil
