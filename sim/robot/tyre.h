// Tyre curve of one direction of an omni wheel: grip over slip, given by its extremum and its asymptote.
//
//   double force_N = -grip(model.tyre_longitudinal, slip) * load_N;    // floor on wheel
//
// Law: cubic Hermite pieces, C1 and odd. With x = slip / extremum_slip
//        |x| <= 1:      grip = extremum_value (3/2 x - 1/2 x^3)              slope 0 at the extremum
//        to asymptote:  grip = extremum_value + (asymptote_value - extremum_value) y^2 (3 - 2 y),
//                       y = (slip - extremum_slip) / (asymptote_slip - extremum_slip)
//        beyond:        grip = asymptote_value
// Source: Bakhshandeh and Sharbafi 2012, fig. 8, Table I and eq. (4), F_max = F_ext * S. Eq. (4) is read here
// with S = wheel load and F_ext = extremum_value, a friction coefficient: F_max = extremum_value * load.
// Table I's own numbers cannot be meant literally: stiffness 1e6 times an extremum of 2 is 2e6 N on a robot
// that weighs 20 N, and full grip at a slip of 0.0001 is 0.1 mm/s of sliding at 1 m/s, which no explicit step
// above a microsecond follows. They scale an impulse-based game engine's solver. Taken from the table is the
// *shape* (four numbers per direction); the values chosen are friction coefficients (docs/robot-model.md).
// Cannot represent: coupling of the two directions (no friction ellipse: the rollers take the lateral force
// in their bearings), roller-by-roller bumps, stiction (speed floor: see slip.h), temperature, dust.
#pragma once

namespace omnihil {

// grip(slip) rises to extremum_value at extremum_slip, falls to asymptote_value at asymptote_slip and
// stays there; odd in slip. Values are friction coefficients (force over wheel load).
struct TyreCurve {
  double extremum_slip = 0.0;
  double extremum_value = 0.0;
  double asymptote_slip = 0.0;
  double asymptote_value = 0.0;
};

// Curve: TyreCurve, or a struct with the same members of type T when they are fitted. x: slip / extremum_slip, for who
// divides several at once.
template <typename T, typename Curve>
T grip_at(const Curve& curve, const T& slip, const T& x) {
  const T size = slip < T(0) ? T(-slip) : slip;
  if (size <= curve.extremum_slip) return curve.extremum_value * x * (1.5 - 0.5 * x * x);
  T value = T(curve.asymptote_value);
  if (size < curve.asymptote_slip) {
    const T y = (size - curve.extremum_slip) / (curve.asymptote_slip - curve.extremum_slip);
    value = curve.extremum_value + (curve.asymptote_value - curve.extremum_value) * y * y * (3.0 - 2.0 * y);
  }
  return slip < T(0) ? T(-value) : value;
}
template <typename T, typename Curve>
T grip(const Curve& curve, const T& slip) {
  return grip_at(curve, slip, T(slip / curve.extremum_slip));
}

// Steepest rise of grip over slip: at zero slip. Decides how long an explicit step may be.
inline double steepest_grip(const TyreCurve& curve) {
  return 1.5 * curve.extremum_value / curve.extremum_slip;
}

// Rubber ring on carpet, along the drive direction (guess, +-30 %): holds 0.75 of the load at 10 % slip.
inline constexpr TyreCurve kDefaultTyreLongitudinal{0.10, 0.75, 0.40, 0.60};
// Rollers in their bearings, across it (guess, +-50 %): 2 % of the load as soon as they turn.
inline constexpr TyreCurve kDefaultTyreLateral{1.0, 0.02, 2.0, 0.01};
// Guess that keeps 1 ms explicit steps stable with the curve above (docs/robot-model.md has the bound).
inline constexpr double kDefaultSlipSpeedFloor_m_s = 0.5;

}  // namespace omnihil
